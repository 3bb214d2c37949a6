#include "tests/support/umockdev_text.hpp"

#include <algorithm>

namespace limn::test {

std::string digits_of(std::span<const std::uint8_t> bytes, std::size_t size) {
  std::string digits;
  for (const std::uint8_t byte : bytes) {
    digits += "0123456789ABCDEF"[byte >> 4];
    digits += "0123456789ABCDEF"[byte & 15];
  }
  digits.resize(std::max(digits.size(), 2 * size), '0');
  return digits;
}

std::string digits_of(std::string_view bytes, std::size_t size) {
  return digits_of(std::vector<std::uint8_t>(bytes.begin(), bytes.end()), size);
}

std::string hidraw_ioctls(const HidrawNode& node) {
  const auto number = [](std::size_t value, int size) {  // low byte first
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
    return digits_of(bytes);
  };
  const auto text = [](const std::string& value) {  // the result counts the NUL at its end
    return std::to_string(value.size() + 1) + " " + digits_of(value, 256);
  };
  constexpr std::size_t kUsb = 3;
  constexpr std::size_t kLargestDescriptor = 4096;
  const std::string size = number(node.report_descriptor.size(), 4);
  return "@DEV " + node.path + "\nHIDIOCGRAWINFO 0 " + number(kUsb, 4) + number(node.vendor, 2) +
         number(node.product, 2) + "\nHIDIOCGRDESCSIZE 0 " + size + "\nHIDIOCGRDESC 0 " + size +
         digits_of(node.report_descriptor, kLargestDescriptor) + "\nHIDIOCGRAWNAME " +
         text(node.name) + "\nHIDIOCGRAWPHYS " + text(node.phys) + "\n";
}

}  // namespace limn::test
