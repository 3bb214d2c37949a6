#include "input/trace_import/libinput_reader.hpp"

#include <span>
#include <string>
#include <utility>

namespace limn {
namespace {

Error went_back(std::uint32_t line, std::string_view what) {
  return {ErrorCode::kOutOfRange, "line " + std::to_string(line),
          "its time is before that of the " + std::string(what) + " before it",
          "add --salvage to skip it"};
}

}  // namespace

LibinputReader::LibinputReader(LibinputRecord record, TraceOptions options)
    : SteppedTraceReader("line", options.salvage),
      record_(std::move(record)),
      supplied_(std::move(options.supplied)),
      last_frame_(record_.devices.size()) {
  for (TraceDevice& device : record_.devices) supply(device);
}

void LibinputReader::supply(TraceDevice& device) const {
  if (device.report_descriptor.empty()) device.report_descriptor = supplied_.report_descriptor;
  if (device.vendor == 0 && device.product == 0) {
    device.vendor = supplied_.vendor;
    device.product = supplied_.product;
  }
}

Expected<bool> LibinputReader::step() {
  if (item_ < record_.items.size()) {
    const LibinputRecord::Item& item = record_.items[item_++];
    if (auto taken = take(item); !taken) return tl::unexpected(taken.error());
    return true;
  }
  announce_up_to(record_.devices.size(), item_ == 0 ? 1 : record_.items.back().line);
  if (!record_.failure) return false;
  Error failure = *std::exchange(record_.failure, std::nullopt);
  // A source that fails is no damage of the file.
  if (failure.code == ErrorCode::kIo) return tl::unexpected(std::move(failure));
  if (auto told = damaged(std::move(failure)); !told) return tl::unexpected(told.error());
  return true;
}

Expected<void> LibinputReader::take(const LibinputRecord::Item& item) {
  switch (item.kind) {
    case LibinputRecord::Kind::kFrame:
      return take_frame(item);
    case LibinputRecord::Kind::kReport:
      return take_report(item);
    case LibinputRecord::Kind::kDamage:
      break;
  }
  announce_up_to(item.source, item.line);
  const LibinputRecord::Damage& damage = record_.damage[item.begin];
  for (std::uint64_t i = 0; i < damage.places; ++i) {
    const auto of = i < item.count ? std::optional<DeviceIndex>(item.device) : std::nullopt;
    if (auto told = damaged(damage.first, of); !told) return told;
  }
  return {};
}

Expected<void> LibinputReader::take_frame(const LibinputRecord::Item& item) {
  const auto events = std::span(record_.events).subspan(item.begin, item.count);
  std::optional<Timestamp> last = last_frame_[item.device];
  bool in_order = true;
  for (const EvdevEvent& event : events) {
    in_order &= !last || *last <= event.time;
    last = event.time;
  }
  in_order &= !last || *last <= item.time;
  if (!in_order) return damaged(went_back(item.line, "event"), item.device, true);
  last_frame_[item.device] = item.time;
  announce_up_to(item.device + 1, item.line);
  emit(EvdevFrame{item.device, item.time, events}, item.line);
  return {};
}

Expected<void> LibinputReader::take_report(const LibinputRecord::Item& item) {
  const auto [found, added] = nodes_.try_emplace(item.source);
  Node& node = found->second;
  if (added) {
    node.recorded_with = item.device;
    node.description = record_.devices[item.device];
    node.description.index = static_cast<DeviceIndex>(record_.devices.size() + item.source);
    node.description.axes.clear();
  }
  if (node.recorded_with != item.device) return {};  // the same report, told by each event node
  if (node.last && item.time < *node.last) {
    return damaged(went_back(item.line, "report"), node.description.index, true);
  }
  node.last = item.time;
  announce_up_to(item.device + 1, item.line);
  if (!std::exchange(node.announced, true)) emit(DeviceDescribed{&node.description}, item.line);
  emit(Report{node.description.index, item.time,
              std::span(record_.bytes).subspan(item.begin, item.count)},
       item.line);
  return {};
}

void LibinputReader::announce_up_to(std::size_t count, std::uint64_t line) {
  for (; announced_ < count; ++announced_) {
    emit(DeviceDescribed{&record_.devices[announced_]}, line);
  }
}

}  // namespace limn
