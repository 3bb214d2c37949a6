#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace limn::test {

/// One control transfer of a USB capture.
struct UsbControl {
  unsigned device = 0;                ///< its address
  std::array<std::uint8_t, 8> setup;  ///< bmRequestType, bRequest, wValue, wIndex, wLength
  std::vector<std::uint8_t> data;     ///< what was sent, or what came back
};

/// The control transfers of a capture, in order. Reads what the captures that our tests use are
/// made of: pcap with usbmon's headers (link types 189, 220) and pcapng with USBPcap's (249), both
/// low byte first. Fails the running test where it cannot; stops at the first damage.
std::vector<UsbControl> read_usb_controls(const std::filesystem::path& capture);

/// The input reports of the device at that address, as they came.
std::vector<std::vector<std::uint8_t>> read_usb_reports(const std::filesystem::path& capture,
                                                        unsigned device);

}  // namespace limn::test
