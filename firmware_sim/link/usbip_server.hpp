#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "firmware_sim/link/file_descriptor.hpp"
#include "firmware_sim/link/link_error.hpp"
#include "firmware_sim/link/usbip_connection.hpp"
#include "firmware_sim/link/waiter.hpp"
#include "firmware_sim/usb/bus_device.hpp"

namespace limn::firmware {

struct UsbipOptions {
  /// The simulation's time stands still until a program opens the device, so that it misses
  /// nothing; else it runs from the first moment.
  bool wait_for_reader = true;
};

/// What a server has to tell; `text` is one line.
struct UsbipNotice {
  enum class Kind : std::uint8_t {
    kAttached,   ///< a client has the device
    kDetached,   ///< it has it no longer
    kRefused,    ///< a client's connection was closed: why
    kUnplugged,  ///< the device has gone, and with it the client's connection
    kPlugged     ///< it is back, to be attached again
  };
  Kind kind = Kind::kAttached;
  std::string text;
};

/// Exports a simulated device by USB/IP as busid 1-1: to clients over TCP on 127.0.0.1, and nowhere
/// else, and to whoever holds the other end of a socket that adopt() is given.
///
/// A client that breaks the protocol, goes away in mid-transfer or floods loses its connection,
/// with a notice; the server goes on. At most kMostConnections at a time, and those that ask for
/// nothing are closed after kPatience. One thread; Waiter::stop() from any.
class UsbipServer {
 public:
  static constexpr std::size_t kMostConnections = 8;
  static constexpr std::chrono::seconds kPatience{10};

  using Tell = std::function<void(const UsbipNotice&)>;

  /// `device` must outlive the server. `tell` is called from run(), and may call adopt().
  UsbipServer(BusDevice& device, UsbipOptions options = {}, Tell tell = {});

  /// Listens on 127.0.0.1; port 0 is any free one. Gives the port. Error: it is taken, or may not
  /// be used.
  LinkResult<std::uint16_t> listen(std::uint16_t port);

  /// A connected stream socket whose other end has the device from now on, such as one that was
  /// given to attach_to_vhci(). Where somebody has it already, the socket is closed, with a notice.
  void adopt(FileDescriptor socket);

  /// Serves until `end` of the simulation's time.
  LinkResult<LinkEnd> run(std::chrono::microseconds end, Waiter& waiter);

  /// Reports given to clients so far.
  std::uint64_t reports() const noexcept { return reports_; }

 private:
  struct Client {
    Client(UsbipExport& exported, FileDescriptor socket)
        : connection(exported, std::move(socket)) {}
    UsbipConnection connection;
    SimulationClock::Point deadline;  // to have asked for something
    bool attached = false;            // and told so
    std::uint64_t reports = 0;        // counted so far
  };

  void tell(UsbipNotice::Kind kind, std::string text);
  void look_at_cable(std::chrono::microseconds now);
  void accept_clients();
  void serve_clients(std::chrono::microseconds now);
  bool serve(Client& client, std::chrono::microseconds now);
  std::vector<Watched> watched() const;
  std::optional<SimulationClock::Point> deadline(std::chrono::microseconds now,
                                                 std::chrono::microseconds end) const;

  UsbipExport exported_;
  UsbipOptions options_;
  Tell tell_;
  FileDescriptor listener_;
  std::vector<std::unique_ptr<Client>> clients_;
  SimulationClock clock_;
  SimulationClock::Point accept_again_;  // after accept() failed for want of something
  bool plugged_ = true;
  std::uint64_t reports_ = 0;
};

}  // namespace limn::firmware
