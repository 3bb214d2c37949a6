#include "drivers/transport/usb_control.hpp"

#include <algorithm>

namespace limn {

Expected<std::vector<std::uint8_t>> UsbControl::read_string(std::uint8_t index,
                                                            std::uint16_t language,
                                                            std::uint16_t length) {
  return read(string_request(index, language), length, UsbDevice::Silence::kIsAnAnswer);
}

Expected<void> UsbControl::set_output(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return {};
  return write(set_output_request(bytes[0], number_), report_data(bytes));
}

Expected<void> UsbControl::set_feature(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return {};
  return write(set_feature_request(bytes[0], number_), report_data(bytes));
}

Expected<std::vector<std::uint8_t>> UsbControl::get_feature(std::uint8_t id, std::size_t length) {
  if (id == 0 && length > 0) --length;  // for the ID, which does not travel
  auto bytes = read(get_feature_request(id, number_),
                    static_cast<std::uint16_t>(std::min<std::size_t>(length, 0xFFFF)),
                    UsbDevice::Silence::kIsAnError);
  if (bytes && id == 0) bytes->insert(bytes->begin(), 0);
  return bytes;
}

}  // namespace limn
