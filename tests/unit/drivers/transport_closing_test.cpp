// Transports whose closing takes its time.

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <future>
#include <string>
#include <thread>

#include "drivers/transport/file_handle.hpp"
#include "drivers/transport/live_reader.hpp"
#include "drivers/transport/transport_closer.hpp"

namespace limn::test {
namespace {

/// Only so that a defect fails and does not hang.
constexpr std::chrono::seconds kPatience{20};

/// One end of a socket as a device: each byte is a report, and at the end of them it is gone.
class SocketTransport : public Transport {
 public:
  explicit SocketTransport(FileHandle& far_end) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) != 0) std::abort();
    far_end = FileHandle(ends[0]);
    socket_ = FileHandle(ends[1]);
  }
  const TraceDevice& device() const noexcept override { return device_; }
  int poll_descriptor() const noexcept override { return socket_.get(); }
  State drain(TransportSink& sink) noexcept override {
    std::uint8_t byte = 0;
    const ssize_t size = ::recv(socket_.get(), &byte, 1, MSG_DONTWAIT);
    if (size > 0) sink.report({}, {&byte, 1});
    return size == 0 ? State::kGone : State::kOpen;
  }

 private:
  FileHandle socket_;
  TraceDevice device_;
};

/// Says in whose thread it is being closed, and then waits for `may_close`.
class SlowlyClosed final : public SocketTransport {
 public:
  SlowlyClosed(FileHandle& far_end, std::promise<std::thread::id>& closing,
               std::shared_future<void> may_close)
      : SocketTransport(far_end), closing_(closing), may_close_(std::move(may_close)) {}
  ~SlowlyClosed() override {
    closing_.set_value(std::this_thread::get_id());
    EXPECT_EQ(may_close_.wait_for(kPatience), std::future_status::ready);
  }

 private:
  std::promise<std::thread::id>& closing_;
  std::shared_future<void> may_close_;
};

TEST(LiveReader, ClosingADeviceHoldsUpNoOther) {
  FileHandle slow;
  FileHandle other;
  std::promise<std::thread::id> closing;
  std::promise<void> report_came;
  std::vector<std::unique_ptr<Transport>> devices;
  devices.push_back(
      std::make_unique<SlowlyClosed>(slow, closing, report_came.get_future().share()));
  devices.push_back(std::make_unique<SocketTransport>(other));
  const auto reader = *LiveReader::start(std::move(devices));
  slow = FileHandle();  // it is gone
  closing.get_future().wait();
  ASSERT_EQ(::write(other.get(), "r", 1), 1);
  std::vector<std::string> notes;
  for (;;) {
    const auto event = *reader->next();
    if (const auto* note = std::get_if<TraceNote>(&event)) notes.emplace_back(note->text);
    if (std::holds_alternative<Report>(event)) break;
  }
  EXPECT_EQ(notes, std::vector<std::string>{"gone"}) << "told before it was closed";
  report_came.set_value();
}

TEST(TransportCloser, ClosesItselfWhatFindsRoomAndAllOfIt) {
  std::promise<void> may_close;
  const std::shared_future<void> go = may_close.get_future().share();
  FileHandle end;
  std::promise<std::thread::id> first;
  std::vector<std::promise<std::thread::id>> waiting(kMaxTraceDevices);
  std::promise<std::thread::id> too_many;
  std::thread::id closers;
  {
    TransportCloser closer;
    closer.start();
    closer.close(std::make_unique<SlowlyClosed>(end, first, go));
    closers = first.get_future().get();
    for (auto& one : waiting) closer.close(std::make_unique<SlowlyClosed>(end, one, go));
    std::promise<void> at_once;
    at_once.set_value();
    closer.close(std::make_unique<SlowlyClosed>(end, too_many, at_once.get_future().share()));
    may_close.set_value();
  }
  EXPECT_NE(closers, std::this_thread::get_id());
  for (auto& one : waiting) {
    std::future<std::thread::id> thread = one.get_future();
    ASSERT_EQ(thread.wait_for(std::chrono::seconds(0)), std::future_status::ready);
    EXPECT_EQ(thread.get(), closers);
  }
  EXPECT_EQ(too_many.get_future().get(), std::this_thread::get_id());
}

}  // namespace
}  // namespace limn::test
