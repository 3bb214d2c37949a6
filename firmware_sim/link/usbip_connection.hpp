#pragma once

#include <chrono>
#include <cstdint>

#include "firmware_sim/link/file_descriptor.hpp"
#include "firmware_sim/link/usbip_session.hpp"
#include "firmware_sim/link/waiter.hpp"

namespace limn::firmware {

/// A UsbipSession on a connected stream socket, which never waits: it reads what is there, writes
/// what the socket takes, and leaves the rest for the next time.
class UsbipConnection {
 public:
  enum class State : std::uint8_t { kOpen, kClosed };

  /// The session's precondition. `socket` is made non-blocking.
  UsbipConnection(UsbipExport& exported, FileDescriptor socket);

  UsbipSession& session() noexcept { return session_; }
  const UsbipSession& session() const noexcept { return session_; }

  /// What to wait for before pump() can do something, besides time.
  Watched watched() const noexcept;

  /// Reads, polls the device, writes. kClosed: the client has gone, or all is said. Error: what it
  /// sent is no USB/IP. After either, the connection is to be dropped.
  LinkResult<State> pump(std::chrono::microseconds now);

 private:
  bool read_some(std::span<const std::uint8_t>& bytes);
  bool write_some();

  UsbipSession session_;
  FileDescriptor socket_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace limn::firmware
