#include "drivers/transport/transport_closer.hpp"

#include <utility>

namespace limn {

TransportCloser::~TransportCloser() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void TransportCloser::start() {
  thread_ = std::thread([this] { run(); });
}

void TransportCloser::close(std::unique_ptr<Transport> gone) noexcept {
  {
    const std::lock_guard lock(mutex_);
    if (count_ == waiting_.size()) return;  // `gone` outlives the lock
    waiting_[count_++] = std::move(gone);
  }
  changed_.notify_one();
}

void TransportCloser::run() noexcept {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return count_ > 0 || ending_; });
    if (count_ == 0) return;
    std::unique_ptr<Transport> gone = std::move(waiting_[--count_]);
    lock.unlock();
    gone.reset();
    lock.lock();
  }
}

}  // namespace limn
