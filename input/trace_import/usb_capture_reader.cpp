#include "input/trace_import/usb_capture_reader.hpp"

#include <utility>

#include "input/trace/text.hpp"

namespace limn {
namespace {

constexpr std::uint16_t kBusUsb = 3;  // Linux BUS_USB
constexpr DeviceIndex kInterfaces = 256;
/// Beyond the interface numbers that devices have: where an endpoint's interface is not known.
constexpr std::uint8_t kByEndpoint = 128;
/// Far more than a machine has devices; a damaged file may name any.
constexpr std::size_t kMaxAddresses = 1024;

Error error_at(const UsbPacket& packet, ErrorCode code, std::string what, std::string remedy) {
  return {code, "packet " + std::to_string(packet.number), std::move(what), std::move(remedy)};
}

Error cut(const UsbPacket& packet, std::string_view noun) {
  const std::size_t size = packet.data.size() + packet.missing;
  return error_at(packet, ErrorCode::kSyntax,
                  "the packet holds " + std::to_string(packet.data.size()) + " of the " +
                      std::string(noun) + "'s " + text::counted(size, "byte"),
                  "capture whole packets (a larger snapshot length), or add --salvage");
}

}  // namespace

UsbCaptureReader::UsbCaptureReader(UsbCapture capture, TraceOptions options)
    : SteppedTraceReader("packet", options.salvage),
      capture_(std::move(capture)),
      devices_(std::move(options.supplied)) {}

Expected<bool> UsbCaptureReader::step() {
  notes_.clear();
  auto packet = capture_.next();
  number_ = capture_.packet_count();
  if (!packet) {
    if (packet.error().code == ErrorCode::kIo) return tl::unexpected(std::move(packet.error()));
    if (auto told = damaged(std::move(packet.error())); !told) return tl::unexpected(told.error());
    return true;
  }
  if (!*packet) {
    finish();
    return false;
  }
  if (auto taken = take(**packet); !taken) return tl::unexpected(taken.error());
  return true;
}

Expected<void> UsbCaptureReader::take(const UsbPacket& packet) {
  constexpr std::uint8_t kIn = 0x80;
  if (packet.transfer == UsbTransfer::kControl) return take_answer(packet);
  const bool report = packet.transfer == UsbTransfer::kInterrupt && packet.completed &&
                      !packet.failed && (packet.endpoint & kIn) != 0;
  if (!report || packet.data.size() + packet.missing == 0) return {};
  return take_report(packet);
}

Expected<void> UsbCaptureReader::take_answer(const UsbPacket& packet) {
  constexpr std::uint8_t kReportType = 0x22;
  const auto answer = requests_.take(packet);
  if (!answer) return {};
  if (packet.missing > 0 && !packet.failed) return damaged(cut(packet, "descriptor"));
  auto found = address(packet);
  if (!found) return damaged(std::move(found.error()));
  Address& from = **found;
  const bool news = from.descriptors.answered(answer->type, answer->index, answer->bytes);
  if (answer->type == kReportType &&
      from.descriptors.report_descriptors().contains(answer->index)) {
    const auto device = traced(from, answer->index);
    if (!device) return damaged(device.error());
  }
  // What decides how reports are decoded stands above them: before the next one, anew.
  if (!news) return {};
  for (const auto& [interface, device] : from.traced) device->announced = false;
  return {};
}

Expected<void> UsbCaptureReader::take_report(const UsbPacket& packet) {
  auto found = address(packet);
  if (!found) return damaged(std::move(found.error()));
  Address& from = **found;
  const auto endpoint = static_cast<std::uint8_t>(packet.endpoint & 0xF);
  const auto told = from.descriptors.interface_of(endpoint);
  const auto interface = told.value_or(static_cast<std::uint8_t>(kByEndpoint + endpoint));
  if (!from.descriptors.may_be_hid(interface)) return {};
  const auto device = traced(from, interface);
  if (!device) return damaged(device.error());
  const DeviceIndex index = (*device)->description.index;
  if (packet.missing > 0) return damaged(cut(packet, "report"), index);
  if (packet.data.size() > kMaxReportBytes) {
    return damaged(error_at(packet, ErrorCode::kLimit,
                            "a report of " + text::counted(packet.data.size(), "byte"),
                            "add --salvage to skip it"),
                   index);
  }
  std::optional<Timestamp>& last = (*device)->last;
  if (last && packet.time < *last) {
    return damaged(
        error_at(packet, ErrorCode::kOutOfRange, "its time is before that of the report before it",
                 "add --salvage to skip it"),
        index, true);
  }
  if (!(*device)->announced) announce(from, interface, **device);
  last = packet.time;
  emit(Report{index, packet.time, packet.data}, number_);
  return {};
}

Expected<UsbCaptureReader::Address*> UsbCaptureReader::address(const UsbPacket& packet) {
  const auto key = std::pair(packet.bus, packet.device);
  const auto found = addresses_.find(key);
  if (found != addresses_.end()) return found->second.get();
  if (addresses_.size() == kMaxAddresses) {
    return tl::unexpected(error_at(packet, ErrorCode::kLimit,
                                   "more than " + std::to_string(kMaxAddresses) + " USB addresses",
                                   "capture one bus, or add --salvage"));
  }
  auto& added = addresses_[key] = std::make_unique<Address>();
  added->bus = packet.bus;
  added->number = packet.device;
  return added.get();
}

Expected<TrackedDevice*> UsbCaptureReader::traced(Address& address, std::uint8_t interface) {
  const auto known = address.traced.find(interface);
  if (known != address.traced.end()) return known->second;
  if (!address.first_index) {
    address.first_index = next_index_;
    next_index_ += kInterfaces;
  }
  TrackedDevice* const device = devices_.find_or_add(*address.first_index + interface);
  if (device == nullptr) {
    return fail(ErrorCode::kLimit, "packet " + std::to_string(number_),
                "more than " + std::to_string(kMaxTraceDevices) + " devices",
                "capture fewer, or add --salvage");
  }
  return address.traced[interface] = device;
}

/// Describes a device anew, and what it answered when it was initialised.
void UsbCaptureReader::announce(const Address& address, std::uint8_t interface,
                                TrackedDevice& device) {
  const UsbDescriptors& descriptors = address.descriptors;
  TraceDevice& description = device.description;
  description.bus = kBusUsb;
  description.vendor = descriptors.vendor();
  description.product = descriptors.product();
  description.version = descriptors.version();
  description.name = descriptors.name();
  description.physical_path = "usb-" + std::to_string(address.bus) + '.' +
                              std::to_string(address.number) + "/input" + std::to_string(interface);
  const auto report = descriptors.report_descriptors().find(interface);
  description.report_descriptor = report == descriptors.report_descriptors().end()
                                      ? std::vector<std::uint8_t>()
                                      : report->second;
  emit(devices_.announce(device), number_);
  // Their texts stay where they are: a reserve for all that one step can emit.
  notes_.reserve(kMaxTraceDevices * UsbDescriptors::kMostStrings);
  for (const NotedString& string : descriptors.strings()) {
    notes_.push_back(note_of(string));
    emit(TraceNote{notes_.back(), description.index}, number_);
  }
}

/// Those that never reported are described, too.
void UsbCaptureReader::finish() {
  for (const auto& [key, address] : addresses_) {
    for (const auto& [interface, device] : address->traced) {
      const bool known = address->descriptors.report_descriptors().contains(interface);
      if (!device->last && known) announce(*address, interface, *device);
    }
  }
}

}  // namespace limn
