#include "drivers/devices/trace_decoder.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "drivers/devices/device_traits.hpp"
#include "drivers/devices/evdev_motion_decoder.hpp"
#include "drivers/devices/motion_decoder.hpp"
#include "drivers/devices/pen_initialization.hpp"
#include "input/trace/noted_loss.hpp"
#include "input/trace/noted_string.hpp"

namespace limn {
namespace {

/// A device with several rows shows only by its reports which of them it speaks.
void describe(const PenDecoder& decoder, TraceDeviceSummary& summary) {
  const PenSpec* spec = decoder.spec();
  summary.kind = spec != nullptr     ? std::string(name(spec->family))
                 : decoder.has_pen() ? "HID pen"
                                     : "no pen";
  summary.range = decoder.range();
}

/// Goes again through the initialisation that gave these strings; nothing where none is noted.
std::optional<PenInitializer> initialized(const TraceDevice& device,
                                          std::span<const NotedString> strings) {
  const PenInitialization* sequence =
      strings.empty() ? nullptr : find_pen_initialization(device.vendor, device.product);
  if (sequence == nullptr) return std::nullopt;
  PenInitializer initializer(*sequence);
  while (const PenInitStep* step = initializer.next()) {
    const auto found = std::find_if(strings.begin(), strings.end(), [step](const auto& string) {
      return step->action == PenInitAction::kReadString && string.index == step->string_index;
    });
    initializer.done(found == strings.end() ? std::span<const std::uint8_t>() : found->bytes);
  }
  return initializer;
}

}  // namespace

struct TraceDecoder::Device {
  TraceDevice described;
  TraceDeviceSummary summary;
  std::vector<NotedString> strings;  // noted since the description, at most kMostStrings
  std::optional<PenDecoder> reports;
  std::optional<EvdevPenDecoder> frames;
  std::optional<MotionDecoder> motions;
  std::optional<EvdevMotionDecoder> motion_frames;
  bool stale = true;                  // a decoder is to be made (again) before the next report
  bool refused = false;               // salvaging: nothing can be decoded
  std::uint64_t repaired_before = 0;  // by decoders that a new description replaced
  Timestamp last_time{};
  LossTracker losses;

  static constexpr std::size_t kMostStrings = 8;  // twice what any initialisation reads

  void forget_decoders() noexcept {
    reports.reset();
    frames.reset();
    motions.reset();
    motion_frames.reset();
  }

  /// When it says something without a report.
  std::optional<Timestamp> due() const noexcept {
    if (reports) return reports->due();
    if (motions) return motions->due();
    return motion_frames ? motion_frames->due() : std::nullopt;
  }

  std::uint64_t repaired_now() const noexcept {
    return (reports ? reports->repaired_transitions() : 0) +
           (frames ? frames->repaired_transitions() : 0);
  }
};

std::uint64_t TraceDeviceSummary::all_reports() const noexcept {
  return std::accumulate(reports.begin(), reports.end(), undecodable_reports);
}

std::uint64_t TraceSummary::repaired_transitions() const noexcept {
  return std::accumulate(devices.begin(), devices.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const TraceDeviceSummary& device) {
                           return sum + device.repaired_transitions;
                         });
}

StreamLosses TraceSummary::losses() const noexcept {
  StreamLosses sum;
  for (const TraceDeviceSummary& device : devices) sum.add(device.losses);
  return sum;
}

TraceDecoder::TraceDecoder(std::unique_ptr<TraceReader> reader, TraceDecoderOptions options)
    : reader_(std::move(reader)), options_(options) {}
TraceDecoder::TraceDecoder(TraceDecoder&&) noexcept = default;
TraceDecoder& TraceDecoder::operator=(TraceDecoder&&) noexcept = default;
TraceDecoder::~TraceDecoder() = default;

Expected<const PenSample*> TraceDecoder::next() {
  for (;;) {
    auto sample = next_any();
    if (!sample) return tl::unexpected(std::move(sample.error()));
    if (const auto* const pen = std::get_if<const PenSample*>(&*sample)) return *pen;
    if (std::holds_alternative<std::monostate>(*sample)) return nullptr;
  }
}

Expected<AnySample> TraceDecoder::next_any() {
  if (error_) return tl::unexpected(*error_);
  while (pending_.empty() && pending_motions_.empty() && !ended_) {
    const Step step = advance();
    if (!step) {
      error_ = step.error();
      return tl::unexpected(*error_);
    }
  }
  const Timestamp start = start_.value_or(Timestamp{});
  if (!pending_.empty()) {
    sample_ = pending_.front();
    sample_.time -= start;
    pending_ = pending_.subspan(1);
    pending_from_->losses.complete(sample_, reader_->format() != TraceFormat::kStrokeCsv);
    ++samples_;
    return &sample_;
  }
  if (pending_motions_.empty()) return AnySample();
  motion_ = pending_motions_.front();
  motion_.time -= start;
  pending_motions_ = pending_motions_.subspan(1);
  pending_from_->losses.complete(motion_);
  ++samples_;
  return &motion_;
}

/// One event of the stream: the reader's next, or what a device's silence means before it.
TraceDecoder::Step TraceDecoder::advance() {
  Device* const leaving = next_to_leave();
  auto event = reader_->next_until(leaving ? *leaving->due() : Timestamp::max());
  if (!event) return tl::unexpected(std::move(event.error()));
  if (*event) return std::visit([this](const auto& content) { return take(content); }, **event);
  if (leaving != nullptr) leave_silently(*leaving);
  return {};
}

/// The device whose pen leaves (whose motion ends) first if nothing more comes, if any.
TraceDecoder::Device* TraceDecoder::next_to_leave() const noexcept {
  Device* first = nullptr;
  Timestamp earliest = Timestamp::max();
  for (const auto& device : devices_) {
    const auto due = device->due();
    if (!due || (first != nullptr && earliest <= *due)) continue;
    first = device.get();
    earliest = *due;
  }
  return first;
}

void TraceDecoder::leave_silently(Device& device) noexcept {
  const Timestamp due = *device.due();
  if (device.reports) {
    give(device, device.reports->advance(device.summary.index, due), due);
  } else if (device.motions) {
    give(device, device.motions->advance(due), due);
  } else {
    give(device, device.motion_frames->advance(due), due);
  }
}

TraceSummary TraceDecoder::summary() const {
  TraceSummary summary;
  summary.samples = samples_;
  summary.damaged_parts = damaged_parts_;
  summary.damage = damage_;
  for (const auto& device : devices_) {
    summary.devices.push_back(device->summary);
    summary.devices.back().repaired_transitions = device->repaired_before + device->repaired_now();
    summary.devices.back().losses = device->losses.losses();
    if (device->reports) describe(*device->reports, summary.devices.back());
  }
  return summary;
}

// Once the trace is over, what silence means comes as if more time went by, in its order.
// Each step hands out one device's samples; the reader's end comes again for the next.
TraceDecoder::Step TraceDecoder::take(TraceEnd) {
  if (Device* const leaving = next_to_leave()) {
    leave_silently(*leaving);
  } else {
    ended_ = true;
  }
  return {};
}

TraceDecoder::Step TraceDecoder::take(const DeviceDescribed& described) {
  auto found = device(described.device->index);
  if (!found) return tl::unexpected(std::move(found.error()));
  Device& device = **found;
  device.described = *described.device;
  device.summary.name = described.device->name;
  device.summary.vendor = described.device->vendor;
  device.summary.product = described.device->product;
  device.strings.clear();
  device.stale = true;
  device.losses.described();
  leave(device);  // described anew, it was replugged
  return {};
}

/// What the device held in range, moved or pressed is gone.
void TraceDecoder::leave(Device& device) noexcept {
  const auto disconnect = [this, &device](auto& decoder) {
    if (decoder) {
      give(device, decoder->disconnect(device.summary.index, device.last_time), device.last_time);
    }
  };
  disconnect(device.reports);
  disconnect(device.frames);
  disconnect(device.motions);
  disconnect(device.motion_frames);
}

TraceDecoder::Step TraceDecoder::take(const Report& report) {
  start_at(report.time);
  auto found = device(report.device);
  if (!found) return tl::unexpected(std::move(found.error()));
  Device& device = **found;
  if (auto ready = prepare(device); !ready) return ready;
  if (device.refused) {
    ++device.summary.undecodable_reports;
    return {};
  }
  const auto take_decoded = [&](const auto& decoded) -> Step {
    ++device.summary.reports[static_cast<std::size_t>(decoded.kind)];
    if (auto known = check(device, decoded.kind, report.bytes); !known) return known;
    give(device, decoded.samples, report.time);
    return {};
  };
  return device.motions ? take_decoded(device.motions->decode(report))
                        : take_decoded(device.reports->decode(report));
}

TraceDecoder::Step TraceDecoder::check(const Device& device, ReportClass kind,
                                       std::span<const std::uint8_t> report) const {
  if (options_.salvage) return {};
  const unsigned id = report.empty() ? 0 : report[0];
  if (kind == ReportClass::kNoSize) {
    return tl::unexpected(
        located(Error{ErrorCode::kMissing, "",
                      "the pen of " + label(device) +
                          " has no physical size: its descriptor gives X and Y no unit of length",
                      "give a descriptor with Physical Maximum and Unit as --descriptor FILE"}));
  }
  if (kind == ReportClass::kUnknownId) {
    return tl::unexpected(located(
        Error{ErrorCode::kUnknown, "",
              "report ID " + std::to_string(id) + " of " + label(device) +
                  " is known neither to its report descriptor nor to the device tables",
              "check that the descriptor belongs to this interface, or skip such reports with "
              "--salvage"}));
  }
  return {};
}

TraceDecoder::Step TraceDecoder::take(const EvdevFrame& frame) {
  start_at(frame.events.empty() ? frame.time : frame.events.front().time);
  auto found = device(frame.device);
  if (!found) return tl::unexpected(std::move(found.error()));
  Device& device = **found;
  ++device.summary.frames;
  if (auto ready = prepare_kernel(device); !ready) return ready;
  if (device.refused) return {};
  if (device.motion_frames) {
    give(device, device.motion_frames->decode(frame), frame.time);
  } else {
    give(device, device.frames->decode(frame), frame.time);
  }
  return {};
}

TraceDecoder::Step TraceDecoder::take(const PenSample& sample) {
  start_at(sample.time);
  auto found = device(sample.device);
  if (!found) return tl::unexpected(std::move(found.error()));
  Device& device = **found;
  device.summary.kind = "stroke CSV";
  sample_ = sample;
  give(device, {&sample_, 1}, sample.time);
  return {};
}

TraceDecoder::Step TraceDecoder::take(const TraceNote& note) {
  const auto loss = noted_loss(note.text);
  auto string = noted_string(note.text);
  if (!loss && !string && note.text != "gone") return {};
  auto found = device(note.device);
  if (!found) return tl::unexpected(std::move(found.error()));
  Device& device = **found;
  if (loss) {
    device.losses.overrun(loss->count, loss->estimated);
  } else if (string) {
    if (device.strings.size() < Device::kMostStrings) device.strings.push_back(*std::move(string));
  } else {
    device.losses.gone();
    leave(device);
  }
  return {};
}

TraceDecoder::Step TraceDecoder::take(const TraceDamage& damage) {
  ++damaged_parts_;
  if (damage_.size() < TraceSummary::kDamageKept) damage_.push_back(damage.error);
  for (const LostReports& reports : damage.lost) {
    auto found = device(reports.device);
    if (!found) return tl::unexpected(std::move(found.error()));
    (*found)->losses.damage(reports.count, reports.time_went_back);
  }
  return {};
}

Expected<TraceDecoder::Device*> TraceDecoder::device(DeviceIndex index) {
  const auto found = std::find_if(devices_.begin(), devices_.end(), [index](const auto& device) {
    return device->summary.index == index;
  });
  if (found != devices_.end()) return found->get();
  if (devices_.size() >= kMaxDevices) {
    return tl::unexpected(located(Error{ErrorCode::kLimit, "",
                                        "more than " + std::to_string(kMaxDevices) + " devices",
                                        "split the recording"}));
  }
  devices_.push_back(std::make_unique<Device>());
  devices_.back()->summary.index = index;
  return devices_.back().get();
}

/// Before a decoder is made for what was described last.
void TraceDecoder::begin_anew(Device& device) noexcept {
  device.stale = false;
  device.refused = false;
  device.repaired_before += device.repaired_now();
  device.forget_decoders();
}

TraceDecoder::Step TraceDecoder::prepare(Device& device) {
  if (!device.stale && (device.reports || device.motions || device.refused)) return {};
  begin_anew(device);
  if (is_3d_mouse(device.described)) {
    auto decoder = MotionDecoder::make(device.described.vendor, device.described.product,
                                       device.described.report_descriptor);
    device.described.report_descriptor = {};
    if (!decoder) return refuse(device, std::move(decoder.error()));
    device.motions.emplace(std::move(*decoder));
    device.summary.kind = "3D mouse";
    return {};
  }
  PenIdentity identity;
  identity.vendor = device.described.vendor;
  identity.product = device.described.product;
  identity.product_name = device.described.name;
  const auto initializer = initialized(device.described, device.strings);
  if (initializer) identity.firmware = initializer->firmware();
  auto decoder = PenDecoder::make(identity, device.described.report_descriptor,
                                  initializer ? initializer->parameters() : nullptr);
  device.described.report_descriptor = {};  // a decoder is made once a description
  if (!decoder) return refuse(device, std::move(decoder.error()));
  device.reports.emplace(std::move(*decoder));
  describe(*device.reports, device.summary);
  return {};
}

TraceDecoder::Step TraceDecoder::prepare_kernel(Device& device) {
  if (!device.stale && (device.frames || device.motion_frames || device.refused)) return {};
  begin_anew(device);
  if (is_3d_mouse(device.described)) {
    device.motion_frames.emplace(device.described);
    device.summary.kind = "3D mouse";
    return {};
  }
  auto decoder = EvdevPenDecoder::make(device.described);
  if (!decoder) return refuse(device, std::move(decoder.error()));
  device.frames.emplace(std::move(*decoder));
  device.summary.kind = device.frames->has_pen() ? "kernel pen" : "no pen";
  device.summary.range = device.frames->range();
  return {};
}

TraceDecoder::Step TraceDecoder::refuse(Device& device, Error error) {
  if (!options_.salvage) {
    error.what = label(device) + ": " + error.what;
    return tl::unexpected(located(std::move(error)));
  }
  device.refused = true;
  device.summary.kind = "unknown";
  return {};
}

Error TraceDecoder::located(Error error) const {
  const std::string place = reader_->place();
  error.at = error.at.empty() ? place : place + ", " + error.at;
  return error;
}

std::string TraceDecoder::label(const Device& device) const {
  std::string text = "device " + std::to_string(device.summary.index);
  if (!device.summary.name.empty()) text += " (" + device.summary.name + ")";
  return text;
}

void TraceDecoder::start_at(Timestamp time) noexcept {
  if (!start_) start_ = time;
}

void TraceDecoder::give(Device& device, std::span<const PenSample> samples,
                        Timestamp time) noexcept {
  device.last_time = time;
  device.summary.samples += samples.size();
  pending_ = samples;
  pending_from_ = &device;
}

void TraceDecoder::give(Device& device, std::span<const MotionSample> samples,
                        Timestamp time) noexcept {
  device.last_time = time;
  device.summary.samples += samples.size();
  pending_motions_ = samples;
  pending_from_ = &device;
}

}  // namespace limn
