#include "firmware_sim/link/waiter.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

namespace limn::firmware {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

void set_alarm(const FileDescriptor& timer, SimulationClock::Point deadline) noexcept {
  const std::int64_t time =
      std::chrono::duration_cast<std::chrono::nanoseconds>(deadline.time_since_epoch()).count();
  itimerspec alarm{};
  alarm.it_value = {static_cast<std::time_t>(time / kSecond),  // 32 bits on some processors
                    static_cast<long>(time % kSecond)};
  ::timerfd_settime(timer.get(), TFD_TIMER_ABSTIME, &alarm, nullptr);
}

}  // namespace

LinkResult<Waiter> Waiter::make() {
  FileDescriptor timer(::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK));
  FileDescriptor stop(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!timer || !stop) {
    return link_fail(std::string("no timer: ") + std::strerror(errno), "close some programs");
  }
  return Waiter(std::move(timer), std::move(stop));
}

void Waiter::stop() noexcept {
  const std::uint64_t one = 1;
  // It can only fail where the count is full, and then it has been stopped before.
  [[maybe_unused]] const auto written = ::write(stop_.get(), &one, sizeof one);
}

bool Waiter::stopped() const noexcept {
  pollfd look{stop_.get(), POLLIN, 0};
  return ::poll(&look, 1, 0) == 1;
}

void Waiter::wait(std::span<Watched> files, std::optional<SimulationClock::Point> deadline) {
  std::vector<pollfd> polled;
  polled.reserve(files.size() + 2);
  for (const Watched& one : files) {
    const int events = (one.read ? POLLIN : 0) | (one.write ? POLLOUT : 0);
    polled.push_back({events == 0 ? -1 : one.file, static_cast<short>(events), 0});
  }
  polled.push_back({stop_.get(), POLLIN, 0});
  if (deadline) {
    set_alarm(timer_, *deadline);
    polled.push_back({timer_.get(), POLLIN, 0});
  }
  // Interrupted by a signal: nothing is ready, and the caller comes again.
  const bool any = ::poll(polled.data(), polled.size(), -1) > 0;
  for (std::size_t i = 0; i < files.size(); ++i) files[i].ready = any && polled[i].revents != 0;
}

}  // namespace limn::firmware
