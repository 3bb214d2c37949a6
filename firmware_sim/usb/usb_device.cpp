#include "firmware_sim/usb/usb_device.hpp"

#include <algorithm>
#include <string_view>

namespace limn::firmware {
namespace {

constexpr int kStall = UsbFunction::kStall;

// bmRequestType [USB 2.0, table 9-2].
constexpr std::uint8_t kIn = 0x80;
constexpr std::uint8_t kTypeMask = 0x60;
constexpr std::uint8_t kRecipientMask = 0x1F;
constexpr std::uint8_t kStandard = 0x00;
constexpr std::uint8_t kClass = 0x20;
constexpr std::uint8_t kToDevice = 0;
constexpr std::uint8_t kToInterface = 1;
constexpr std::uint8_t kToEndpoint = 2;

// bRequest with its bmRequestType, as le16 would read them: one number for one request.
constexpr unsigned request(std::uint8_t type, std::uint8_t number) {
  return static_cast<unsigned>(type) << 8 | number;
}

// Descriptor types [USB 2.0, table 9-5; HID 1.11, 7.1].
constexpr std::uint8_t kDevice = 1;
constexpr std::uint8_t kConfiguration = 2;
constexpr std::uint8_t kString = 3;
constexpr std::uint8_t kInterface = 4;
constexpr std::uint8_t kEndpoint = 5;
constexpr std::uint8_t kHid = 0x21;
constexpr std::uint8_t kReport = 0x22;

constexpr std::uint8_t kHidClass = 3;
constexpr std::uint8_t kBootSubclass = 1;
constexpr std::uint8_t kInterruptTransfer = 3;
constexpr std::uint16_t kUsEnglish = 0x0409;
constexpr std::uint8_t kTheConfiguration = 1;  // bConfigurationValue

constexpr std::uint16_t kEndpointHalt = 0;
constexpr std::uint16_t kDeviceRemoteWakeup = 1;

constexpr std::chrono::milliseconds kIdleUnit{4};

constexpr std::uint8_t low(std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFF); }
constexpr std::uint8_t high(std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8); }

/// Writes descriptors into what the host left room for; the rest is cut off.
class Writer {
 public:
  explicit Writer(std::span<std::uint8_t> out) noexcept : out_(out) {}

  Writer& byte(std::size_t value) noexcept {
    if (at_ < out_.size()) out_[at_++] = static_cast<std::uint8_t>(value);
    return *this;
  }
  Writer& word(std::size_t value) noexcept { return byte(value & 0xFF).byte(value >> 8 & 0xFF); }
  Writer& bytes(std::span<const std::uint8_t> values) noexcept {
    for (const std::uint8_t value : values) byte(value);
    return *this;
  }
  int written() const noexcept { return static_cast<int>(at_); }

 private:
  std::span<std::uint8_t> out_;
  std::size_t at_ = 0;
};

/// Whether a report descriptor has a Report ID item [HID 1.11, 6.2.2.2, 6.2.2.7].
bool has_report_ids(std::span<const std::uint8_t> descriptor) noexcept {
  constexpr std::uint8_t kReportIdItem = 0x84;  // with size code 0
  constexpr std::uint8_t kLongItem = 0xFE;
  for (std::size_t at = 0; at < descriptor.size();) {
    const std::uint8_t prefix = descriptor[at];
    if (prefix == kLongItem) {
      if (at + 1 == descriptor.size()) return false;
      at += std::size_t{3} + descriptor[at + 1];
      continue;
    }
    if ((prefix & 0xFC) == kReportIdItem) return true;
    const unsigned size = prefix & 3U;
    at += 1 + (size == 3 ? 4U : size);
  }
  return false;
}

void write_hid(const DeviceSpec& spec, const InterfaceSpec& interface, Writer& out) noexcept {
  constexpr std::uint8_t kNoCountry = 0;
  out.byte(9).byte(kHid).word(spec.hid_version).byte(kNoCountry);
  out.byte(1).byte(kReport).word(interface.report_descriptor.size());
}

int device_descriptor(const DeviceSpec& spec, Writer out) noexcept {
  const auto index = [](std::string_view text, std::uint8_t at) {
    return text.empty() ? std::uint8_t{0} : at;
  };
  out.byte(18).byte(kDevice).word(spec.usb_version);
  out.byte(0).byte(0).byte(0);  // the class is told by the interfaces
  out.byte(spec.most_control_bytes).word(spec.vendor).word(spec.product).word(spec.version);
  out.byte(index(spec.manufacturer, spec.manufacturer_index));
  out.byte(index(spec.product_name, spec.product_index));
  out.byte(index(spec.serial_number, spec.serial_index));
  out.byte(1);
  return out.written();
}

int configuration_descriptor(const DeviceSpec& spec, Writer out) noexcept {
  std::size_t total = 9;
  for (const InterfaceSpec& interface : spec.interfaces) {
    total += 9 + 9 + 7 * interface.endpoints.size();
  }
  out.byte(9).byte(kConfiguration).word(total).byte(spec.interfaces.size());
  out.byte(kTheConfiguration).byte(0).byte(spec.attributes).byte(spec.power_ma / 2U);
  for (std::size_t number = 0; number < spec.interfaces.size(); ++number) {
    const InterfaceSpec& interface = spec.interfaces[number];
    out.byte(9).byte(kInterface).byte(number).byte(0).byte(interface.endpoints.size());
    out.byte(kHidClass).byte(interface.subclass).byte(interface.protocol).byte(0);
    write_hid(spec, interface, out);
    for (const EndpointSpec& endpoint : interface.endpoints) {
      out.byte(7).byte(kEndpoint).byte(endpoint.address).byte(kInterruptTransfer);
      out.word(endpoint.most_bytes).byte(endpoint.interval_ms);
    }
  }
  return out.written();
}

}  // namespace

UsbDevice::UsbDevice(UsbFunction& function) noexcept : function_(function) {
  const auto& interfaces = function_.spec().interfaces;
  for (std::size_t number = 0; number < interfaces.size() && number < kMostInterfaces; ++number) {
    numbered_[number] = has_report_ids(interfaces[number].report_descriptor);
    for (const EndpointSpec& endpoint : interfaces[number].endpoints) {
      if (endpoint_count_ == kMostEndpoints) break;
      endpoints_[endpoint_count_++] = {endpoint.address, static_cast<std::uint8_t>(number), false};
    }
  }
}

void UsbDevice::reset() noexcept {
  address_ = 0;
  configuration_ = 0;
  remote_wakeup_ = false;
  forget();
  function_.reset();
}

/// What a configuration begins with: nothing halted, sent or to be repeated.
void UsbDevice::forget() noexcept {
  for (Endpoint& endpoint : endpoints_) endpoint.halted = false;
  for (Kept& kept : kept_) kept.used = false;
  boot_protocol_.fill(false);
  idle_.fill(0);
}

bool UsbDevice::has_interface(std::uint16_t index) const noexcept {
  return index < function_.spec().interfaces.size() && index < kMostInterfaces;
}

UsbDevice::Endpoint* UsbDevice::find_endpoint(std::uint16_t address) noexcept {
  for (std::size_t i = 0; i < endpoint_count_; ++i) {
    if (endpoints_[i].address == address) return &endpoints_[i];
  }
  return nullptr;
}

UsbDevice::Kept* UsbDevice::find_kept(std::uint8_t interface, std::uint8_t id) noexcept {
  for (Kept& kept : kept_) {
    if (kept.used && kept.interface == interface && kept.id == id) return &kept;
  }
  return nullptr;
}

UsbDevice::Kept* UsbDevice::keep(std::uint8_t interface, std::uint8_t id) noexcept {
  if (Kept* known = find_kept(interface, id)) return known;
  for (Kept& kept : kept_) {
    if (kept.used) continue;
    kept.used = true;
    kept.interface = interface;
    kept.id = id;
    kept.idle = idle_[interface];
    kept.bytes = 0;
    return &kept;
  }
  return nullptr;
}

TransferResult UsbDevice::control(const SetupPacket& setup, std::chrono::microseconds,
                                  std::span<std::uint8_t> data) noexcept {
  const auto stage = data.first(std::min<std::size_t>(data.size(), setup.length));
  const bool is_in = (setup.request_type & kIn) != 0;
  const int bytes = is_in ? answer(setup, {}, stage) : answer(setup, stage, {});
  if (bytes < 0) return {TransferStatus::kStall, 0};
  const auto answered = std::min(static_cast<std::size_t>(bytes), stage.size());
  return {TransferStatus::kDone, is_in ? answered : stage.size()};
}

/// Bytes of the answer, or kStall.
int UsbDevice::answer(const SetupPacket& setup, std::span<const std::uint8_t> out,
                      std::span<std::uint8_t> in) noexcept {
  constexpr std::uint8_t kDeviceIn = kIn | kStandard | kToDevice;
  constexpr std::uint8_t kDeviceOut = kStandard | kToDevice;
  constexpr std::uint8_t kInterfaceIn = kIn | kStandard | kToInterface;
  constexpr std::uint8_t kInterfaceOut = kStandard | kToInterface;
  constexpr std::uint8_t kEndpointIn = kIn | kStandard | kToEndpoint;
  constexpr std::uint8_t kEndpointOut = kStandard | kToEndpoint;
  const bool to_interface = (setup.request_type & kRecipientMask) == kToInterface;
  if ((setup.request_type & kTypeMask) == kClass && to_interface) {
    return class_request(setup, out, in);
  }
  switch (request(setup.request_type, setup.request)) {
    case request(kDeviceIn, 0):  // GET_STATUS
    case request(kInterfaceIn, 0):
    case request(kEndpointIn, 0):
      return status(setup, in);
    case request(kDeviceOut, 1):  // CLEAR_FEATURE
    case request(kInterfaceOut, 1):
    case request(kEndpointOut, 1):
      return feature(setup, false);
    case request(kDeviceOut, 3):  // SET_FEATURE
    case request(kInterfaceOut, 3):
    case request(kEndpointOut, 3):
      return feature(setup, true);
    case request(kDeviceOut, 5):
      return set_address(setup);
    case request(kDeviceIn, 6):
    case request(kInterfaceIn, 6):
      return descriptor(setup, in);
    case request(kDeviceIn, 8):  // GET_CONFIGURATION
      return Writer(in).byte(configuration_).written();
    case request(kDeviceOut, 9):
      return set_configuration(setup);
    case request(kInterfaceIn, 10):  // GET_INTERFACE
      if (!configured() || !has_interface(setup.index)) return kStall;
      return Writer(in).byte(0).written();
    case request(kInterfaceOut, 11):  // SET_INTERFACE
      if (!configured() || !has_interface(setup.index) || setup.value != 0) return kStall;
      for (Endpoint& endpoint : endpoints_) {
        if (endpoint.interface == setup.index) endpoint.halted = false;
      }
      return 0;
    default:
      return function_.vendor_request(setup, out, in);
  }
}

int UsbDevice::descriptor(const SetupPacket& setup, std::span<std::uint8_t> in) noexcept {
  const DeviceSpec& spec = function_.spec();
  const std::uint8_t index = low(setup.value);
  if ((setup.request_type & kRecipientMask) == kToInterface) {
    if (!has_interface(setup.index) || index != 0) return kStall;
    const InterfaceSpec& interface = spec.interfaces[setup.index];
    Writer out(in);
    switch (high(setup.value)) {
      case kHid:
        write_hid(spec, interface, out);
        return out.written();
      case kReport:
        return out.bytes(interface.report_descriptor).written();
      default:
        return kStall;
    }
  }
  switch (high(setup.value)) {
    case kDevice:
      return index == 0 ? device_descriptor(spec, Writer(in)) : kStall;
    case kConfiguration:
      return index == 0 ? configuration_descriptor(spec, Writer(in)) : kStall;
    case kString:
      return string(index, setup.index, in);
    default:
      return kStall;
  }
}

/// String 0 lists the languages; the spec's own are the same in every language [USB 2.0, 9.6.7].
int UsbDevice::string(std::uint8_t index, std::uint16_t language,
                      std::span<std::uint8_t> in) noexcept {
  const DeviceSpec& spec = function_.spec();
  if (index == 0) return Writer(in).byte(4).byte(kString).word(kUsEnglish).written();
  std::string_view text;
  if (index == spec.manufacturer_index) text = spec.manufacturer;
  if (index == spec.product_index) text = spec.product_name;
  if (index == spec.serial_index) text = spec.serial_number;
  if (text.empty()) return function_.string_descriptor(index, language, in);
  constexpr std::size_t kMostCharacters = 126;  // bLength is a byte
  text = text.substr(0, kMostCharacters);
  Writer out(in);
  out.byte(2 + 2 * text.size()).byte(kString);
  for (const char character : text) out.word(static_cast<unsigned char>(character));
  return out.written();
}

int UsbDevice::set_address(const SetupPacket& setup) noexcept {
  constexpr std::uint16_t kMostAddress = 127;
  if (setup.value > kMostAddress || setup.index != 0 || setup.length != 0 || configured()) {
    return kStall;
  }
  address_ = low(setup.value);
  return 0;
}

int UsbDevice::set_configuration(const SetupPacket& setup) noexcept {
  if (setup.value > kTheConfiguration || setup.index != 0 || setup.length != 0) return kStall;
  configuration_ = low(setup.value);
  forget();
  return 0;
}

int UsbDevice::status(const SetupPacket& setup, std::span<std::uint8_t> in) noexcept {
  constexpr std::uint8_t kEndpointNumberAndDirection = 0x8F;
  if (setup.value != 0) return kStall;
  std::size_t bits = 0;
  switch (setup.request_type & kRecipientMask) {
    case kToDevice:
      if (setup.index != 0) return kStall;
      bits = ((function_.spec().attributes & kSelfPowered) == kSelfPowered ? 1U : 0U) |
             (remote_wakeup_ ? 2U : 0U);
      break;
    case kToInterface:
      if (!configured() || !has_interface(setup.index)) return kStall;
      break;
    default:
      if ((setup.index & ~kEndpointNumberAndDirection) != 0) return kStall;
      if ((setup.index & 0x0F) == 0) break;  // endpoint 0 never halts
      const Endpoint* endpoint = find_endpoint(setup.index);
      if (!configured() || endpoint == nullptr) return kStall;
      bits = endpoint->halted ? 1U : 0U;
  }
  return Writer(in).word(bits).written();
}

int UsbDevice::feature(const SetupPacket& setup, bool on) noexcept {
  if (setup.length != 0) return kStall;
  switch (setup.request_type & kRecipientMask) {
    case kToDevice:
      if (setup.value != kDeviceRemoteWakeup || setup.index != 0 ||
          (function_.spec().attributes & kRemoteWakeup) != kRemoteWakeup) {
        return kStall;
      }
      remote_wakeup_ = on;
      return 0;
    case kToEndpoint: {
      if (setup.value != kEndpointHalt) return kStall;
      if ((setup.index & 0x7F) == 0) return on ? kStall : 0;  // endpoint 0 never halts
      Endpoint* endpoint = find_endpoint(setup.index);
      if (!configured() || endpoint == nullptr) return kStall;
      endpoint->halted = on;
      return 0;
    }
    default:
      return kStall;  // USB 2.0 knows no feature of interfaces
  }
}

int UsbDevice::class_request(const SetupPacket& setup, std::span<const std::uint8_t> out,
                             std::span<std::uint8_t> in) noexcept {
  constexpr std::uint8_t kGet = kIn | kClass | kToInterface;
  constexpr std::uint8_t kSet = kClass | kToInterface;
  if (!configured() || !has_interface(setup.index)) return kStall;
  const auto interface = static_cast<std::uint8_t>(setup.index);
  const bool boots = function_.spec().interfaces[interface].subclass == kBootSubclass;
  switch (request(setup.request_type, setup.request)) {
    case request(kGet, 1):
      return get_report(setup, in);
    case request(kGet, 2): {  // GET_IDLE
      if (high(setup.value) != 0) return kStall;
      const Kept* kept = find_kept(interface, low(setup.value));
      return Writer(in).byte(kept != nullptr ? kept->idle : idle_[interface]).written();
    }
    case request(kGet, 3):  // GET_PROTOCOL
      if (!boots || setup.value != 0) return kStall;
      return Writer(in).byte(boot_protocol_[interface] ? 0 : 1).written();
    case request(kSet, 9): {  // SET_REPORT
      const std::uint8_t kind = high(setup.value);
      if (kind < 1 || kind > 3) return kStall;
      const bool taken =
          function_.set_report(interface, static_cast<ReportKind>(kind), low(setup.value), out);
      return taken ? 0 : kStall;
    }
    case request(kSet, 10):
      return set_idle(setup);
    case request(kSet, 11):  // SET_PROTOCOL
      if (!boots || setup.value > 1 || setup.length != 0) return kStall;
      boot_protocol_[interface] = setup.value == 0;
      return 0;
    default:
      return function_.vendor_request(setup, out, in);
  }
}

int UsbDevice::get_report(const SetupPacket& setup, std::span<std::uint8_t> in) noexcept {
  const std::uint8_t kind = high(setup.value);
  if (kind < 1 || kind > 3) return kStall;
  const auto interface = static_cast<std::uint8_t>(setup.index);
  const int given =
      function_.get_report(interface, static_cast<ReportKind>(kind), low(setup.value), in);
  if (given >= 0 || static_cast<ReportKind>(kind) != ReportKind::kInput) return given;
  const Kept* kept = find_kept(interface, low(setup.value));
  if (kept == nullptr || kept->bytes == 0) return kStall;
  return Writer(in).bytes(std::span(kept->report).first(kept->bytes)).written();
}

/// Report ID 0 sets all of the interface [HID 1.11, 7.2.4].
int UsbDevice::set_idle(const SetupPacket& setup) noexcept {
  if (setup.length != 0) return kStall;
  const auto interface = static_cast<std::uint8_t>(setup.index);
  const std::uint8_t idle = high(setup.value);
  if (low(setup.value) != 0) {
    Kept* kept = keep(interface, low(setup.value));
    if (kept == nullptr) return kStall;
    kept->idle = idle;
    return 0;
  }
  idle_[interface] = idle;
  for (Kept& kept : kept_) {
    if (kept.used && kept.interface == interface) kept.idle = idle;
  }
  return 0;
}

std::chrono::microseconds UsbDevice::silent_until(std::chrono::microseconds now) noexcept {
  const bool repeats = std::any_of(kept_.begin(), kept_.end(), [](const Kept& kept) {
    return kept.used && kept.bytes > 0 && kept.idle != 0;
  });
  return configured() && !repeats ? function_.silent_until(now) : now;
}

TransferResult UsbDevice::interrupt_in(std::uint8_t endpoint, std::chrono::microseconds now,
                                       std::span<std::uint8_t> data) noexcept {
  const Endpoint* from = find_endpoint(endpoint);
  if (!configured() || from == nullptr || from->halted || (endpoint & kIn) == 0) {
    return {TransferStatus::kStall, 0};
  }
  const std::size_t given =
      std::min(function_.next_report(from->interface, now, data), data.size());
  if (given > 0) {
    const std::uint8_t id = numbered_[from->interface] ? data[0] : std::uint8_t{0};
    Kept* kept = keep(from->interface, id);
    if (kept != nullptr && given <= kMostReportBytes) {
      kept->bytes = given;
      kept->sent = now;
      std::copy_n(data.begin(), given, kept->report.begin());
    }
    return {TransferStatus::kDone, given};
  }
  for (Kept& kept : kept_) {
    if (!kept.used || kept.interface != from->interface || kept.bytes == 0) continue;
    if (kept.idle == 0 || now - kept.sent < kept.idle * kIdleUnit) continue;
    kept.sent = now;
    const int repeated = Writer(data).bytes(std::span(kept.report).first(kept.bytes)).written();
    return {TransferStatus::kDone, static_cast<std::size_t>(repeated)};
  }
  return {TransferStatus::kNak, 0};
}

TransferResult UsbDevice::interrupt_out(std::uint8_t endpoint, std::chrono::microseconds,
                                        std::span<const std::uint8_t> data) noexcept {
  const Endpoint* to = find_endpoint(endpoint);
  if (!configured() || to == nullptr || to->halted || (endpoint & kIn) != 0) {
    return {TransferStatus::kStall, 0};
  }
  const std::uint8_t id = numbered_[to->interface] && !data.empty() ? data[0] : std::uint8_t{0};
  if (!function_.set_report(to->interface, ReportKind::kOutput, id, data)) {
    return {TransferStatus::kStall, 0};
  }
  return {TransferStatus::kDone, data.size()};
}

}  // namespace limn::firmware
