#include "firmware_sim/link/usbip_connection.hpp"

#include <sys/socket.h>

#include <cerrno>
#include <utility>

namespace limn::firmware {
namespace {

constexpr std::size_t kReadBytes = 16384;
constexpr int kMostReads = 16;  // of one turn, so that a client that floods lets others in

}  // namespace

UsbipConnection::UsbipConnection(UsbipExport& exported, FileDescriptor socket)
    : session_(exported), socket_(std::move(socket)), buffer_(kReadBytes) {
  make_nonblocking(socket_);
}

Watched UsbipConnection::watched() const noexcept {
  return {socket_.get(), session_.takes_input(), !session_.output().empty(), false};
}

LinkResult<UsbipConnection::State> UsbipConnection::pump(std::chrono::microseconds now) {
  for (int turn = 0; turn < kMostReads && session_.takes_input(); ++turn) {
    std::span<const std::uint8_t> bytes;
    if (!read_some(bytes)) return State::kClosed;
    if (bytes.empty()) break;
    if (auto taken = session_.receive(bytes, now); !taken) {
      write_some();  // the answers to what came before
      return tl::unexpected(std::move(taken.error()));
    }
    if (!write_some()) return State::kClosed;
  }
  session_.advance(now);
  if (!write_some()) return State::kClosed;
  // Packets that were held back while the output was full.
  if (auto taken = session_.receive({}, now); !taken) {
    return tl::unexpected(std::move(taken.error()));
  }
  if (!write_some()) return State::kClosed;
  return session_.done() && session_.output().empty() ? State::kClosed : State::kOpen;
}

bool UsbipConnection::read_some(std::span<const std::uint8_t>& bytes) {
  const ssize_t got = ::recv(socket_.get(), buffer_.data(), buffer_.size(), 0);
  if (got > 0) bytes = std::span(buffer_).first(static_cast<std::size_t>(got));
  return got > 0 || (got < 0 && (errno == EAGAIN || errno == EINTR));
}

bool UsbipConnection::write_some() {
  while (!session_.output().empty()) {
    const auto output = session_.output();
    const ssize_t put = ::send(socket_.get(), output.data(), output.size(), MSG_NOSIGNAL);
    if (put < 0) return errno == EAGAIN || errno == EINTR;
    session_.sent(static_cast<std::size_t>(put));
  }
  return true;
}

}  // namespace limn::firmware
