#include "input/trace_import/usb_descriptors.hpp"

#include <algorithm>

namespace limn {
namespace {

using Bytes = std::span<const std::uint8_t>;

// bDescriptorType, [USB 2.0 table 9-5] and [HID 1.11 7.1].
constexpr std::uint8_t kDevice = 1;
constexpr std::uint8_t kConfiguration = 2;
constexpr std::uint8_t kString = 3;
constexpr std::uint8_t kInterface = 4;
constexpr std::uint8_t kEndpoint = 5;
constexpr std::uint8_t kHid = 0x21;
constexpr std::uint8_t kReport = 0x22;

constexpr std::uint8_t kHidClass = 3;
constexpr std::uint8_t kHubClass = 9;
constexpr std::size_t kDeviceClassAt = 4;
constexpr std::size_t kDeviceBytes = 18;
constexpr std::size_t kManufacturerAt = 14;  // iManufacturer
constexpr std::size_t kProductAt = 15;       // iProduct

/// Windows asks every device for it, [Microsoft OS 1.0 Descriptors].
constexpr std::uint8_t kMicrosoftString = 0xEE;
constexpr std::uint8_t kFirstVendorString = 100;

std::uint16_t word(Bytes bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
}

/// A string descriptor's UTF-16 as UTF-8, without control characters; '?' for half a character.
std::string text_of(Bytes descriptor) {
  constexpr std::uint32_t kHigh = 0xD800;
  constexpr std::uint32_t kLow = 0xDC00;
  constexpr std::uint32_t kEnd = 0xE000;
  std::string text;
  const std::size_t size = std::min<std::size_t>(descriptor.size(), descriptor[0]);
  for (std::size_t i = 2; i + 1 < size; i += 2) {
    std::uint32_t code = word(descriptor, i);
    if (code >= kHigh && code < kLow && i + 3 < size) {
      const std::uint32_t low = word(descriptor, i + 2);
      if (low >= kLow && low < kEnd) {
        code = 0x10000 + ((code - kHigh) << 10) + (low - kLow);
        i += 2;
      }
    }
    if (code < ' ' || code == 0x7F) code = ' ';
    if (code >= kHigh && code < kEnd) code = '?';
    const auto put = [&text](std::uint32_t byte) { text += static_cast<char>(byte); };
    if (code < 0x80) {
      put(code);
    } else if (code < 0x800) {
      put(0xC0 | code >> 6);
      put(0x80 | (code & 0x3F));
    } else if (code < 0x10000) {
      put(0xE0 | code >> 12);
      put(0x80 | (code >> 6 & 0x3F));
      put(0x80 | (code & 0x3F));
    } else {
      put(0xF0 | code >> 18);
      put(0x80 | (code >> 12 & 0x3F));
      put(0x80 | (code >> 6 & 0x3F));
      put(0x80 | (code & 0x3F));
    }
  }
  return text;
}

}  // namespace

bool UsbDescriptors::answered(std::uint8_t type, std::uint8_t index, Bytes answer) {
  switch (type) {
    case kDevice:
      return take_device(answer);
    case kConfiguration:
      take_configuration(answer);
      return false;
    case kString:
      return take_string(index, answer);
    case kReport:
      return take_report_descriptor(index, answer);
    default:
      return false;
  }
}

bool UsbDescriptors::take_device(Bytes answer) {
  if (answer.size() < kDeviceBytes || answer[1] != kDevice) return false;
  const Bytes descriptor = answer.first(kDeviceBytes);
  if (std::equal(descriptor.begin(), descriptor.end(), device_.begin(), device_.end())) {
    return false;
  }
  if (!device_.empty()) *this = UsbDescriptors();  // another device has the address now
  device_.assign(descriptor.begin(), descriptor.end());
  vendor_ = word(descriptor, 8);
  product_ = word(descriptor, 10);
  version_ = word(descriptor, 12);
  return true;
}

bool UsbDescriptors::take_string(std::uint8_t index, Bytes answer) {
  if (index < kFirstVendorString) {
    const bool known = !device_.empty() && index != 0 &&
                       (index == device_[kManufacturerAt] || index == device_[kProductAt]);
    const bool whole = answer.size() >= 2 && answer[1] == kString && answer.size() >= answer[0];
    if (known && whole) texts_[index] = text_of(answer);
    return false;
  }
  if (index == kMicrosoftString) return false;
  answer = answer.first(std::min(answer.size(), NotedString::kMostBytes));
  const auto noted = std::find_if(strings_.begin(), strings_.end(),
                                  [index](const auto& string) { return string.index == index; });
  if (noted == strings_.end()) {
    if (strings_.size() == kMostStrings) return false;
    strings_.push_back({index, {answer.begin(), answer.end()}});
    return true;
  }
  const bool same =
      std::equal(answer.begin(), answer.end(), noted->bytes.begin(), noted->bytes.end());
  if (same || answer.size() < noted->bytes.size()) return false;
  noted->bytes.assign(answer.begin(), answer.end());
  return true;
}

void UsbDescriptors::take_configuration(Bytes answer) {
  if (answer.size() <= configuration_bytes_) return;
  configuration_bytes_ = answer.size();
  std::uint8_t interface = 0;
  while (answer.size() >= 2 && answer[0] >= 2 && answer[0] <= answer.size()) {
    const Bytes one = answer.first(answer[0]);
    answer = answer.subspan(one.size());
    if (one[1] == kInterface && one.size() >= 9) {
      interface = one[2];
      interfaces_[interface].interface_class = one[5];
    } else if (one[1] == kHid && one.size() >= 9 && one[6] == kReport) {
      interfaces_[interface].descriptor_bytes = word(one, 7);
    } else if (one[1] == kEndpoint && one.size() >= 7 && (one[2] & 0x80) != 0) {
      interface_of_endpoint_[one[2] & 0xF] = interface;
    }
  }
}

bool UsbDescriptors::take_report_descriptor(std::uint8_t interface, Bytes answer) {
  if (answer.empty() || answer.size() > kMaxDescriptorBytes) return false;
  const auto known = interfaces_.find(interface);
  const bool whole = known == interfaces_.end() || answer.size() >= known->second.descriptor_bytes;
  std::vector<std::uint8_t>& stored = report_descriptors_[interface];
  const bool same = std::equal(answer.begin(), answer.end(), stored.begin(), stored.end());
  if (!whole || same || answer.size() < stored.size()) {
    if (stored.empty()) report_descriptors_.erase(interface);
    return false;
  }
  stored.assign(answer.begin(), answer.end());
  return true;
}

std::string UsbDescriptors::name() const {
  if (device_.empty()) return {};
  std::string name;
  for (const std::size_t at : {kManufacturerAt, kProductAt}) {
    const auto text = texts_.find(device_[at]);
    if (text == texts_.end()) continue;
    if (!name.empty()) name += ' ';
    name += text->second;
  }
  return name;
}

std::optional<std::uint8_t> UsbDescriptors::interface_of(std::uint8_t endpoint) const noexcept {
  return interface_of_endpoint_[endpoint & 0xF];
}

bool UsbDescriptors::may_be_hid(std::uint8_t interface) const noexcept {
  if (!device_.empty() && device_[kDeviceClassAt] == kHubClass) return false;
  const auto known = interfaces_.find(interface);
  return known == interfaces_.end() || known->second.interface_class == kHidClass;
}

std::optional<UsbDescriptorRequests::Answer> UsbDescriptorRequests::take(const UsbPacket& packet) {
  constexpr std::uint8_t kGetDescriptor = 6;
  constexpr std::uint8_t kOfDevice = 0x80;  // bmRequestType: standard, towards the host
  constexpr std::uint8_t kOfInterface = 0x81;
  const Key key{packet.bus, packet.device, packet.request};
  if (!packet.completed) {
    if (packet.setup.empty()) return std::nullopt;
    open_.erase(key);
    const Bytes setup = packet.setup;
    const bool wanted = (setup[0] == kOfDevice || setup[0] == kOfInterface) &&
                        setup[1] == kGetDescriptor && packet.device != 0;
    if (!wanted) return std::nullopt;
    if (open_.size() == kMostOpen) open_.clear();  // their ends were not captured
    const std::uint8_t type = setup[3];
    open_[key] = {type, type == kReport ? setup[4] : setup[2]};
    return std::nullopt;
  }
  const auto request = open_.find(key);
  if (request == open_.end()) return std::nullopt;
  const Request asked = request->second;
  open_.erase(request);
  return Answer{packet.bus, packet.device, asked.type, asked.index,
                packet.failed ? Bytes() : packet.data};
}

}  // namespace limn
