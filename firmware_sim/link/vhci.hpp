#pragma once

#include <cstdint>
#include <string>

#include "firmware_sim/link/link_error.hpp"
#include "firmware_sim/link/usbip_protocol.hpp"

namespace limn::firmware {

/// Where Linux's virtual host controller (vhci-hcd) takes sockets.
inline constexpr const char* kVhciFolder = "/sys/devices/platform/vhci_hcd.0";

/// Gives one end of a connected stream socket, whose other end UsbipServer::adopt() has, to Linux:
/// the device is then plugged in on `port` of its virtual controller. The caller closes its
/// `socket` afterwards; Linux holds its own. Errors: vhci-hcd is not loaded, not permitted, the
/// port is in use; each with what to load or run.
LinkResult<void> attach_to_vhci(int socket, std::uint32_t port = 0,
                                const std::string& folder = kVhciFolder);

/// Unplugs what is on `port`. Errors: as above.
LinkResult<void> detach_from_vhci(std::uint32_t port = 0, const std::string& folder = kVhciFolder);

}  // namespace limn::firmware
