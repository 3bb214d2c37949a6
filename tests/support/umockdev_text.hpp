#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn::test {

/// `bytes`, and zeros up to `size` of them, as hexadecimal digits.
std::string digits_of(std::span<const std::uint8_t> bytes, std::size_t size = 0);
std::string digits_of(std::string_view bytes, std::size_t size = 0);

/// A hidraw node of a USB device.
struct HidrawNode {
  std::string path = "/dev/hidraw0";
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::vector<std::uint8_t> report_descriptor;
  std::string name;
  std::string phys = "usb-1/input0";
};

/// What the node answers to ioctls, in umockdev's format.
std::string hidraw_ioctls(const HidrawNode& node);

}  // namespace limn::test
