// Any bytes from a USB/IP client, in any pieces, at any times, over a socket to a counting device.
//
//   u8        bit 0: the client has the device already, as vhci; bit 1: it reads no answers
//   pieces:   u8 milliseconds that pass before it, u16 length, bytes

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <vector>

#include "firmware_sim/link/usbip_connection.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/require.hpp"
#include "tests/unit/firmware_sim/counting_device.hpp"

namespace {

using namespace limn;
using namespace limn::firmware;
using State = UsbipConnection::State;

/// A full output, and the answer that made it so.
constexpr std::size_t kMostBytes =
    UsbipSession::kMostOutput + UsbipSession::kMostTransferBytes + usbip::kUrbBytes;

/// Reads what has come; whole packets are not to be expected, for a client may end a session.
void discard_answers(int socket) {
  std::array<std::uint8_t, 65536> bytes;
  while (::recv(socket, bytes.data(), bytes.size(), MSG_DONTWAIT) > 0) {
  }
}

/// False: the connection is at its end.
bool pump(UsbipConnection& connection, std::chrono::microseconds now) {
  const auto state = connection.pump(now);
  if (!state) {
    fuzz::require(!state.error().what.empty() && !state.error().remedy.empty(),
                  "an error says what is wrong and to do");
    for (const char c : state.error().what + state.error().remedy) {
      fuzz::require(c >= ' ' && c <= '~', "an error is one printable line");
    }
    return false;
  }
  fuzz::require(connection.session().output().size() <= kMostBytes, "bounded output");
  return *state == State::kOpen;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return 0;
  fuzz::Input input(data, size);
  const std::uint8_t flags = input.byte();
  const bool reads = (flags & 2) == 0;
  CountingDevice device;
  device.function.count = {1000, 1000};
  device.function.period = std::chrono::milliseconds(1);
  UsbipExport exported{device};
  {
    UsbipConnection connection(exported, FileDescriptor(ends[1]));
    if ((flags & 1) != 0) connection.session().import({});
    std::chrono::microseconds now{};
    bool open = true;
    constexpr int kMostPieces = 64;
    for (int i = 0; i < kMostPieces && open && !input.empty(); ++i) {
      now += std::chrono::milliseconds(input.byte());
      const auto piece = input.take(input.word());
      std::size_t sent = 0;
      do {
        const ssize_t put =
            ::send(ends[0], piece.data() + sent, piece.size() - sent, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (put > 0) sent += static_cast<std::size_t>(put);
        open = pump(connection, now);
        if (reads) discard_answers(ends[0]);
        if (put <= 0 && !reads) break;  // both ends wait for each other, as they should
      } while (open && sent < piece.size());
    }
    discard_answers(ends[0]);
    ::close(ends[0]);
    while (open) open = pump(connection, now);  // it sees the far end close
  }
  fuzz::require(exported.user == nullptr, "a device is free once its client has gone");
  return 0;
}
