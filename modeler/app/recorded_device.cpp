#include "modeler/app/recorded_device.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "firmware_sim/usb/usb_device.hpp"
#include "input/trace/noted_string.hpp"

namespace limn::app {
namespace {

using firmware::UsbDevice;
using std::chrono::microseconds;

constexpr std::size_t kMostName = 126;        // characters that a string descriptor holds
constexpr std::uint16_t kEndpointBytes = 64;  // the largest of full speed
constexpr std::uint8_t kFirstEndpoint = 0x81;

tl::unexpected<Error> no_reports(std::string_view what) {
  return fail(ErrorCode::kUnknown, "", "holds " + std::string(what) + ", not a device's reports",
              "give a hid-recorder or usbhid-dump recording");
}

std::string ascii(std::string text) {
  text.resize(std::min(text.size(), kMostName));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

}  // namespace

/// Takes the events of a recording in, one by one.
class RecordedDevice::Reading {
 public:
  Reading(RecordedDevice& into, double speed) : into_(into), speed_(speed) {}

  Expected<void> operator()(const DeviceDescribed& described) {
    const TraceDevice& device = *described.device;
    if (device.is_kernel_decoded()) return no_reports("what the kernel decoded");
    if (device.vendor == 0 && device.product == 0) {
      return fail(ErrorCode::kMissing, "", "the recording does not say whose device it is",
                  "give its ids with --id VID:PID");
    }
    if (into_.interfaces_.empty()) {
      into_.name_ = ascii(device.name);
      into_.vendor_ = device.vendor;
      into_.product_ = device.product;
      into_.version_ = device.version;
    } else if (device.vendor != into_.vendor_ || device.product != into_.product_) {
      return fail(ErrorCode::kLimit, "", "the recording holds several devices",
                  "keep the lines of the one to be replayed");
    }
    auto& interfaces = into_.interfaces_;
    if (find(device.index) != nullptr) return {};  // described anew: it was plugged in again
    if (device.report_descriptor.empty()) {
      return fail(ErrorCode::kMissing, "", "the recording has no report descriptor",
                  "give it with --descriptor FILE");
    }
    if (interfaces.size() == UsbDevice::kMostInterfaces) {
      return fail(ErrorCode::kLimit, "",
                  "the recording has more than " + std::to_string(UsbDevice::kMostInterfaces) +
                      " interfaces",
                  "keep the lines of those that are needed");
    }
    interfaces.emplace_back();
    interfaces.back().index = device.index;
    interfaces.back().descriptor = device.report_descriptor;
    return {};
  }

  Expected<void> operator()(const Report& report) {
    Interface* const interface = find(report.device);
    if (interface == nullptr) {
      return fail(ErrorCode::kMissing, "", "the recording has no report descriptor",
                  "give it with --descriptor FILE, and ids with --id VID:PID");
    }
    if (report.bytes.size() > UsbDevice::kMostReportBytes) {
      return fail(ErrorCode::kLimit, "",
                  "a report has " + std::to_string(report.bytes.size()) +
                      " bytes, and the simulated device takes " +
                      std::to_string(UsbDevice::kMostReportBytes),
                  "decode the recording instead");
    }
    if (!first_) first_ = report.time;
    auto& reports = interface->reports;
    microseconds time = since_first(report.time);
    if (gone_.erase(report.device) != 0) {
      come_back(time);
      gone_.clear();
    }
    if (!reports.empty()) time = std::max(time, reports.back().time);
    reports.push_back({time, into_.bytes_.size(), report.bytes.size()});
    into_.bytes_.insert(into_.bytes_.end(), report.bytes.begin(), report.bytes.end());
    into_.duration_ = std::max(into_.duration_, time);
    return {};
  }

  Expected<void> operator()(const TraceNote& note) {
    if (note.text == "gone" && find(note.device) != nullptr) gone_.insert(note.device);
    const auto string = noted_string(note.text);
    if (string && !string->bytes.empty()) into_.strings_[string->index] = string->bytes;
    return {};
  }
  Expected<void> operator()(const EvdevFrame&) { return no_reports("what the kernel decoded"); }
  Expected<void> operator()(const PenSample&) { return no_reports("samples"); }
  Expected<void> operator()(const TraceDamage&) { return {}; }  // --salvage leaves it out
  Expected<void> operator()(const TraceEnd&) {
    if (first_) return {};
    return fail(ErrorCode::kMissing, "", "the recording holds no report", "give one that does");
  }

 private:
  Interface* find(DeviceIndex index) {
    auto& all = into_.interfaces_;
    const auto found = std::find_if(all.begin(), all.end(),
                                    [index](const Interface& one) { return one.index == index; });
    return found == all.end() ? nullptr : &*found;
  }

  /// The device went after the last report so far, and reports again at `time`.
  void come_back(microseconds time) {
    const microseconds last = into_.duration_;
    if (time <= last) return;
    const microseconds gap = time - last;
    const microseconds begin = last + std::min<microseconds>(kLastPoll, gap / 4);
    const microseconds end = std::max<microseconds>(last + gap / 2, time - kSettling);
    into_.absences_.push_back({begin, end});
  }

  /// A device's first report may lie before another's that came first. A century is the most, so
  /// that times that a file makes up do no harm.
  microseconds since_first(Timestamp time) const {
    constexpr double kLongest = 3.2e15;
    const double passed = static_cast<double>((time - *first_).count()) / 1000 / speed_;
    return microseconds(static_cast<std::int64_t>(std::clamp(passed, 0.0, kLongest)));
  }

  RecordedDevice& into_;
  double speed_;
  std::optional<Timestamp> first_;
  std::set<DeviceIndex> gone_;  // those of the device's interfaces that have not come back
};

Expected<std::unique_ptr<RecordedDevice>> RecordedDevice::read(TraceReader& reader, double speed) {
  std::unique_ptr<RecordedDevice> device(new RecordedDevice);
  Reading reading(*device, speed);
  for (;;) {
    const auto event = reader.next();
    if (!event) return tl::unexpected(event.error());
    if (auto taken = std::visit(reading, *event); !taken) {
      if (!std::holds_alternative<TraceEnd>(*event)) taken.error().at = reader.place();
      return tl::unexpected(std::move(taken.error()));
    }
    if (std::holds_alternative<TraceEnd>(*event)) break;
  }
  device->make_spec();
  return device;
}

void RecordedDevice::make_spec() {
  for (std::size_t i = 0; i < interfaces_.size(); ++i) {
    Interface& interface = interfaces_[i];
    interface.endpoint[0] = {static_cast<std::uint8_t>(kFirstEndpoint + i), kEndpointBytes, 1};
    interface_specs_.push_back({interface.descriptor, 0, 0, interface.endpoint});
  }
  spec_.vendor = vendor_;
  spec_.product = product_;
  spec_.version = version_;
  spec_.product_name = name_;
  spec_.interfaces = interface_specs_;
}

bool RecordedDevice::plugged(microseconds now) const noexcept {
  const auto after =
      std::upper_bound(absences_.begin(), absences_.end(), now,
                       [](microseconds time, const Absence& one) { return time < one.begin; });
  return after == absences_.begin() || now >= std::prev(after)->end;
}

std::size_t RecordedDevice::next_report(std::uint8_t index, microseconds now,
                                        std::span<std::uint8_t> report) noexcept {
  Interface& interface = interfaces_[index];
  if (interface.next == interface.reports.size()) return 0;
  const Recorded& recorded = interface.reports[interface.next];
  if (recorded.time > now) return 0;
  ++interface.next;
  const std::size_t size = std::min(recorded.size, report.size());
  std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(recorded.begin), size, report.begin());
  return size;
}

int RecordedDevice::string_descriptor(std::uint8_t index, std::uint16_t,
                                      std::span<std::uint8_t> out) noexcept {
  const auto found = strings_.find(index);
  if (found == strings_.end()) return kStall;
  const std::size_t size = std::min(found->second.size(), out.size());
  std::copy_n(found->second.begin(), size, out.begin());
  return static_cast<int>(size);
}

}  // namespace limn::app
