#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <thread>

#include "drivers/transport/transport.hpp"

namespace limn {

/// Destroys transports in a thread of its own: one whose device is dead may take seconds, in which
/// the queues of others would overflow.
class TransportCloser {
 public:
  TransportCloser() = default;
  TransportCloser(const TransportCloser&) = delete;
  TransportCloser& operator=(const TransportCloser&) = delete;
  /// Waits until all are closed.
  ~TransportCloser();

  /// Throws std::system_error where the system refuses the thread.
  void start();

  /// Takes one over, without allocation. Where as many wait as there are devices at most, it is
  /// destroyed here.
  void close(std::unique_ptr<Transport> gone) noexcept;

 private:
  void run() noexcept;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::array<std::unique_ptr<Transport>, kMaxTraceDevices> waiting_;
  std::size_t count_ = 0;  // of those that wait
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace limn
