#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "firmware_sim/link/link_error.hpp"
#include "firmware_sim/link/usbip_protocol.hpp"
#include "firmware_sim/usb/bus_device.hpp"

namespace limn::firmware {

class UsbipSession;

/// The device as several clients see it: any may list it, one at a time has it.
struct UsbipExport {
  BusDevice& device;
  const UsbipSession* user = nullptr;
};

/// One client's side of USB/IP as a computation: bytes in, bytes out, no sockets and no clock.
///
/// A connection begins with one operation (list, or import); after an import it carries URBs until
/// it is closed. A control transfer is answered at once, or never where the device times out (the
/// client unlinks it). Interrupt transfers wait, each endpoint's in order: it is polled at most
/// once an interval, as a bus would, but polls that were missed while no URB waited are made up
/// for, up to kMostCredit, as the controller's latency is not the device's.
///
/// Whatever the bytes, memory is bounded: a transfer by kMostTransferBytes, waiting URBs by
/// kMostWaiting and kMostWaitingBytes; no more is taken in while kMostOutput bytes are not taken
/// out. What breaks the protocol is an error, after which the session is spent. One thread.
class UsbipSession {
 public:
  static constexpr std::size_t kMostTransferBytes = 65536;
  static constexpr std::size_t kMostWaiting = 1024;
  static constexpr std::size_t kMostWaitingBytes = 256 * 1024;
  static constexpr std::size_t kMostOutput = 256 * 1024;
  static constexpr int kMostCredit = 64;

  /// `exported` must outlive this.
  explicit UsbipSession(UsbipExport& exported);
  ~UsbipSession();
  UsbipSession(const UsbipSession&) = delete;
  UsbipSession& operator=(const UsbipSession&) = delete;

  /// The client has the device from now on, which is reset: by its request, or because vhci was
  /// given its end of the socket by hand. Precondition: nobody has it.
  void import(std::chrono::microseconds now);

  /// Bytes from the client, any number of them. Error: they are no USB/IP; `what` says where.
  LinkResult<void> receive(std::span<const std::uint8_t> bytes, std::chrono::microseconds now);

  /// Polls for the URBs that wait.
  void advance(std::chrono::microseconds now);

  /// When advance() can do something next; nothing: not before bytes come.
  std::optional<std::chrono::microseconds> next_poll() const noexcept;

  /// Bytes for the client; sent() takes the first `count` away.
  std::span<const std::uint8_t> output() const noexcept;
  void sent(std::size_t count);

  /// Whether more bytes should be read from the client now.
  bool takes_input() const noexcept { return pending_output() < kMostOutput && !done_; }

  bool imported() const noexcept { return exported_.user == this; }
  /// All is said: to be closed once the output has gone.
  bool done() const noexcept { return done_; }
  /// An interrupt-in transfer waits: a program has opened the device.
  bool listening() const noexcept;
  /// Reports given to the client.
  std::uint64_t reports() const noexcept { return reports_; }

 private:
  struct Waiting {
    std::uint32_t sequence = 0;
    std::uint8_t endpoint = 0;  // with bit 7 for IN; 0: a control transfer that timed out
    std::size_t length = 0;
    std::vector<std::uint8_t> data;  // to the device
  };

  std::size_t pending_output() const noexcept { return output_.size() - output_begin_; }
  LinkResult<std::size_t> take_packet(std::span<const std::uint8_t> bytes,
                                      std::chrono::microseconds now);
  LinkResult<std::size_t> take_operation(std::span<const std::uint8_t> bytes,
                                         std::chrono::microseconds now);
  LinkResult<std::size_t> take_urb(std::span<const std::uint8_t> bytes,
                                   std::chrono::microseconds now);
  LinkResult<void> submit(const usbip::UrbHeader& urb, std::span<const std::uint8_t> data,
                          std::chrono::microseconds now);
  LinkResult<void> control(const usbip::UrbHeader& urb, std::span<const std::uint8_t> data,
                           std::chrono::microseconds now);
  LinkResult<void> wait(Waiting waiting);
  void unlink(const usbip::UrbHeader& urb);
  bool poll(const Waiting& waiting, std::chrono::microseconds now);
  void end_silence(std::chrono::microseconds now) noexcept;

  UsbipExport& exported_;
  std::vector<std::uint8_t> input_;
  std::vector<std::uint8_t> output_;
  std::size_t output_begin_ = 0;  // those before it have gone
  std::deque<Waiting> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::array<std::chrono::microseconds, 32> next_polls_{};  // by place()
  std::vector<std::uint8_t> transfer_;
  bool done_ = false;
  std::uint64_t reports_ = 0;
};

}  // namespace limn::firmware
