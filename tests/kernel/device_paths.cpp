#include "tests/kernel/device_paths.hpp"

#include <gtest/gtest.h>
#include <linux/input.h>

#include <algorithm>
#include <iterator>
#include <thread>
#include <utility>
#include <variant>

#include "drivers/devices/pen_initialization.hpp"
#include "drivers/devices/trace_decoder.hpp"
#include "drivers/transport/live_reader.hpp"
#include "drivers/transport/open_device.hpp"
#include "drivers/transport/paced_reader.hpp"
#include "drivers/transport/pen_setup.hpp"
#include "firmware_sim/link/in_memory.hpp"
#include "firmware_sim/link/standard_requests.hpp"
#include "input/trace/evemu_writer.hpp"
#include "input/trace/hid_recorder_writer.hpp"
#include "modeler/app/bus_control.hpp"

namespace limn::test {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatience = 20s;
constexpr auto kLookAgain = 1s;  // looking is work for an emulated processor, waiting is none

/// UHID has a place where USB has an interface: "limn/simulated/1234.0/input1".
int interface_of(const ListedDevice& row) {
  if (row.interface_number >= 0) return row.interface_number;
  const std::string& path = row.device.physical_path;
  const std::size_t digit = path.find_last_not_of("0123456789") + 1;
  return digit < path.size() ? std::stoi(path.substr(digit)) : 0;
}

/// Keeps events as they come.
class Keeper {
 public:
  explicit Keeper(std::vector<ListedDevice> rows) : rows_(std::move(rows)) {}

  void operator()(const DeviceDescribed& described) {
    EXPECT_TRUE(described.device->is_kernel_decoded() ? frames_.describe(*described.device)
                                                      : reports_.describe(*described.device));
  }
  void operator()(const Report& report) {
    const int interface =
        rows_.empty() ? static_cast<int>(report.device) : interface_of(rows_.at(report.device));
    taken_.reports[interface].emplace_back(report.bytes.begin(), report.bytes.end());
    ++taken_.report_count;
    EXPECT_TRUE(reports_.write(report));
  }
  void operator()(const EvdevFrame& frame) {
    ++taken_.frames;
    for (const EvdevEvent& event : frame.events) {
      if (event.type == EV_ABS) taken_.axes[event.code].push_back(event.value);
    }
    EXPECT_TRUE(frames_.write(frame));
  }
  void operator()(const TraceNote& note) {
    taken_.notes.emplace_back(note.text);
    if (taken_.frames == 0) {
      EXPECT_TRUE(reports_.note(note.text, note.device));
    }
  }
  template <class Other>
  void operator()(const Other&) {}

  const Taken& taken() const { return taken_; }
  Taken finish() {
    taken_.trace = sink_.text();
    return std::move(taken_);
  }

 private:
  std::vector<ListedDevice> rows_;
  StringSink sink_;
  HidRecorderWriter reports_{sink_};
  EvemuWriter frames_{sink_};
  Taken taken_;
};

bool hangs_on(const ListedDevice& row, Cable cable) {
  const std::string& folder = row.backend == Backend::kUsb ? row.usb_folder : row.hid_folder;
  return folder.find(cable == Cable::kUhid ? "/uhid/" : "/vhci_hcd") != std::string::npos;
}

bool is_of(const ListedDevice& row, const firmware::DeviceSpec& spec, Cable cable) {
  return row.device.vendor == spec.vendor && row.device.product == spec.product &&
         hangs_on(row, cable);
}

/// Those of a recording's samples that are of this kind.
template <class Sample>
std::vector<Sample> decoded_from(const std::string& trace) {
  std::vector<Sample> samples;
  auto reader = open_trace(memory_bytes(trace), {});
  EXPECT_TRUE(reader) << reader.error().what;
  if (!reader) return samples;
  TraceDecoder decoder(*std::move(reader), {.salvage = true});
  for (;;) {
    const auto sample = decoder.next_any();
    EXPECT_TRUE(sample) << sample.error().what;
    if (!sample || std::holds_alternative<std::monostate>(*sample)) return samples;
    if (const auto* const one = std::get_if<const Sample*>(&*sample)) samples.push_back(**one);
  }
}

}  // namespace

std::vector<PenSample> samples_of(const std::string& trace) {
  return decoded_from<PenSample>(trace);
}

std::vector<MotionSample> motions_of(const std::string& trace) {
  return decoded_from<MotionSample>(trace);
}

std::vector<std::vector<ListedDevice>> wait_for_rows(Backend backend, Cable cable,
                                                     const std::vector<WantedRows>& wanted) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    const auto all = list_devices_of(backend).value_or(std::vector<ListedDevice>());
    std::vector<std::vector<ListedDevice>> rows;
    for (const WantedRows& one : wanted) {
      auto& its = rows.emplace_back();
      std::copy_if(all.begin(), all.end(), std::back_inserter(its), [&](const ListedDevice& row) {
        return is_of(row, one.spec, cable) && row.readable;  // its node comes a moment after it
      });
      std::sort(its.begin(), its.end(), [](const ListedDevice& a, const ListedDevice& b) {
        return std::pair(interface_of(a), a.node) < std::pair(interface_of(b), b.node);
      });
    }
    const auto [missing, its] = std::mismatch(
        wanted.begin(), wanted.end(), rows.begin(),
        [](const WantedRows& one, const auto& found) { return found.size() >= one.count; });
    if (missing == wanted.end()) return rows;
    if (std::chrono::steady_clock::now() > end) {
      ADD_FAILURE() << its->size() << " of " << missing->count << " nodes of "
                    << missing->spec.product_name << " on " << name(backend);
      return rows;
    }
    std::this_thread::sleep_for(kLookAgain);
  }
}

std::vector<ListedDevice> wait_for_rows(Backend backend, const firmware::DeviceSpec& spec,
                                        Cable cable, std::size_t count) {
  return wait_for_rows(backend, cable, {{spec, count}}).front();
}

void wait_until_all_are_gone() {
  for (const Backend backend : {Backend::kHidraw, Backend::kEvdev, Backend::kUsb}) {
    const auto is_left = [](const ListedDevice& row) {
      return hangs_on(row, Cable::kUhid) || hangs_on(row, Cable::kUsbip);
    };
    const auto end = std::chrono::steady_clock::now() + kPatience;
    for (;;) {
      const auto rows = list_devices_of(backend).value_or(std::vector<ListedDevice>());
      if (std::none_of(rows.begin(), rows.end(), is_left)) break;
      ASSERT_LT(std::chrono::steady_clock::now(), end) << "a device stays plugged in";
      std::this_thread::sleep_for(kLookAgain);
    }
  }
}

Taking::Taking(std::vector<ListedDevice> rows, std::size_t enough) {
  std::promise<void> open;
  open_ = open.get_future();
  taken_ = std::async(std::launch::async,
                      [rows = std::move(rows), enough, open = std::move(open)]() mutable {
                        return take(rows, enough, open);
                      });
}

Taken Taking::take(const std::vector<ListedDevice>& rows, std::size_t enough,
                   std::promise<void>& open) {
  std::vector<std::unique_ptr<Transport>> transports;
  for (const ListedDevice& row : rows) {
    auto opened = open_device(row);
    EXPECT_TRUE(opened) << opened.error().at << ": " << opened.error().what;
    if (!opened) continue;
    EXPECT_FALSE(opened->trouble) << row.device.name << ": " << opened->trouble->what;
    transports.push_back(std::move(opened->transport));
  }
  auto reader = LiveReader::start(std::move(transports));
  open.set_value();
  EXPECT_TRUE(reader) << reader.error().what;
  if (!reader) return {};
  Keeper keeper(rows);
  const Timestamp end = monotonic_clock().now() + kPatience;
  while (keeper.taken().report_count + keeper.taken().frames < enough) {
    auto event = (*reader)->next_until(end);
    EXPECT_TRUE(event) << event.error().what;
    if (!event || !*event || std::holds_alternative<TraceEnd>(**event)) break;
    std::visit(keeper, **event);
  }
  return keeper.finish();
}

Taken expected_of(firmware::BusDevice& device, std::size_t enough, Setup setup) {
  using firmware::HostEvent;
  using firmware::InMemoryHost;
  const firmware::DeviceSpec& spec = device.spec();
  std::vector<firmware::HostRequest> requests;
  if (setup == Setup::kWacom) {
    requests.push_back({firmware::set_report(0, firmware::ReportKind::kFeature, 2, 2), {2, 2}});
  }
  InMemoryHost host(device, InMemoryHost::Polling::kWhenDue, requests);
  Keeper keeper({});
  while (keeper.taken().report_count < enough) {
    const auto event = host.next(host.time() + kPatience);
    if (!event || event->kind == HostEvent::Kind::kUnplugged) break;
    if (event->kind == HostEvent::Kind::kReport) {
      keeper(Report{event->interface, event->time, event->bytes});
      continue;
    }
    for (std::size_t i = 0; i < spec.interfaces.size(); ++i) {
      const auto interface = static_cast<std::uint8_t>(i);
      TraceDevice described;
      described.index = interface;
      described.name = spec.product_name;
      described.bus = static_cast<std::uint16_t>(spec.bus);
      described.vendor = spec.vendor;
      described.product = spec.product;
      const auto descriptor = host.report_descriptor(interface);
      described.report_descriptor.assign(descriptor.begin(), descriptor.end());
      keeper(DeviceDescribed{&described});
    }
    const PenInitialization* const sequence = find_pen_initialization(spec.vendor, spec.product);
    if (setup != Setup::kLimn || sequence == nullptr) continue;
    app::BusControl control(host, sequence->interface_number);
    for (const std::string& note : set_up_pen(*sequence, control).notes) {
      keeper(TraceNote{note, sequence->interface_number});
    }
  }
  return keeper.finish();
}

}  // namespace limn::test
