#include "drivers/devices/motion_decoder.hpp"

#include <algorithm>
#include <limits>

#include "drivers/hid/report_layout.hpp"
#include "drivers/hid/usages.hpp"

namespace limn {
namespace {

constexpr std::uint8_t kTranslation = 1;
constexpr std::uint8_t kRotation = 2;
constexpr std::uint8_t kButtons = 3;
constexpr std::uint8_t kBattery = 0x17;
constexpr std::uint8_t kPressedNumbers = 0x1C;
constexpr std::uint32_t kAxisBits = 16;
constexpr std::size_t kHalf = kMotionAxes / 2;
constexpr std::uint32_t kMostBitmapBits = 8 * 32;

constexpr hid::Usage kBatteryStrength{0x06, 0x20};  // Generic Device Controls

bool is_multi_axis(const hid::ReportDescriptor& descriptor, hid::CollectionIndex collection) {
  const auto top = descriptor.top_level(collection);
  return top != hid::kNoCollection && descriptor.collections[static_cast<std::size_t>(top)].usage ==
                                          hid::usage::kMultiAxisController;
}

bool is_multi_axis(const hid::ReportDescriptor& descriptor) {
  return std::any_of(descriptor.collections.begin(), descriptor.collections.end(),
                     [](const hid::Collection& collection) {
                       return collection.parent == hid::kNoCollection &&
                              collection.usage == hid::usage::kMultiAxisController;
                     });
}

std::uint32_t read_le16(std::span<const std::uint8_t> report, std::size_t at) {
  return report[at] | static_cast<std::uint32_t>(report[at + 1]) << 8;
}

}  // namespace

bool is_multi_axis_controller(std::span<const std::uint8_t> report_descriptor) {
  const auto descriptor = hid::parse_descriptor(report_descriptor);
  return descriptor && is_multi_axis(*descriptor);
}

Expected<MotionDecoder> MotionDecoder::make(std::uint16_t vendor, std::uint16_t product,
                                            std::span<const std::uint8_t> report_descriptor) {
  MotionDecoder decoder;
  decoder.spec_ = find_motion_spec(vendor, product);
  if (decoder.spec_ != nullptr) decoder.frame_ = decoder.spec_->frame;
  decoder.state_.rests_exactly = decoder.spec_ != nullptr;
  const auto descriptor = hid::parse_descriptor(report_descriptor);
  if (descriptor && is_multi_axis(*descriptor)) {
    decoder.take_layouts(*descriptor);
  } else if (decoder.spec_ == nullptr) {
    if (!descriptor && !report_descriptor.empty()) return tl::unexpected(descriptor.error());
    return fail(ErrorCode::kMissing, "", "is no 3D mouse by its ids or its report descriptor",
                "give its report descriptor");
  }
  if (decoder.spec_ != nullptr) decoder.complete_3dconnexion();
  return decoder;
}

MotionDecoder::Layout& MotionDecoder::layout(std::uint8_t id) {
  const auto found = std::find_if(layouts_.begin(), layouts_.end(),
                                  [id](const Layout& one) { return one.id == id; });
  if (found != layouts_.end()) return *found;
  layouts_.emplace_back().id = id;
  return layouts_.back();
}

void MotionDecoder::take_layouts(const hid::ReportDescriptor& descriptor) {
  numbered_ = false;
  for (const hid::Field& field : descriptor.fields) {
    if (field.kind != hid::ReportKind::kInput) continue;
    numbered_ |= field.report_id != 0;
    if (field.flags.constant() || !is_multi_axis(descriptor, field.collection)) continue;
    const auto index = static_cast<std::uint32_t>(&field - descriptor.fields.data());
    const auto first = [&descriptor, index](hid::Usage usage) {
      const auto places = hid::locate_in_field(descriptor, index, usage);
      return places.empty() ? hid::FieldReader() : places.front().reader;
    };
    Layout& into = layout(field.report_id);
    for (std::size_t axis = 0; axis < kMotionAxes; ++axis) {
      const auto is_it = [axis](const Axis& known) { return known.index == axis; };
      if (std::any_of(into.axes.begin(), into.axes.end(), is_it)) continue;
      const auto id = static_cast<std::uint16_t>(hid::usage::kX.id + axis);
      if (const auto reader = first({hid::page::kGenericDesktop, id})) {
        into.axes.push_back(
            {axis, reader, full_counts(field.logical.minimum, field.logical.maximum)});
      }
    }
    for (unsigned number = 1; number <= MotionButtons::kMost; ++number) {
      const auto is_it = [number](const Button& known) { return known.number == number; };
      if (std::any_of(into.buttons.begin(), into.buttons.end(), is_it)) continue;
      if (const auto reader = first({hid::page::kButton, static_cast<std::uint16_t>(number)})) {
        into.buttons.push_back({number, reader});
      }
    }
    if (const auto reader = first(kBatteryStrength)) into.battery = reader;
  }
}

/// What is known of all of them, where the descriptor leaves it open.
void MotionDecoder::complete_3dconnexion() {
  const auto axes_at = [](std::size_t first, std::uint32_t byte) {
    std::vector<Axis> axes;
    for (std::uint32_t i = 0; i < kHalf; ++i) {
      axes.push_back(
          {first + i, hid::FieldReader::of_bits(8 * byte + kAxisBits * i, kAxisBits, true)});
    }
    return axes;
  };
  constexpr std::uint32_t kBehindTranslation = 1 + kHalf * kAxisBits / 8;
  const auto has_rotation = [](const Layout& one) {
    return std::any_of(one.axes.begin(), one.axes.end(),
                       [](const Axis& axis) { return axis.index >= kHalf; });
  };
  if (layout(kTranslation).axes.empty()) layout(kTranslation).axes = axes_at(0, 1);
  if (!has_rotation(layout(kTranslation))) {
    if (layout(kRotation).axes.empty()) layout(kRotation).axes = axes_at(kHalf, 1);
    beyond_ = axes_at(kHalf, kBehindTranslation);
    for (Axis& axis : beyond_) axis.full_counts = layout(kTranslation).axes.front().full_counts;
  }
  if (layout(kButtons).buttons.empty()) {
    for (std::uint32_t bit = 0; bit < kMostBitmapBits; ++bit) {
      layout(kButtons).buttons.push_back({bit + 1, hid::FieldReader::of_bits(8 + bit, 1, false)});
    }
  }
  if (!layout(kBattery).battery) {
    layout(kBattery).battery = hid::FieldReader::of_bits(8, 8, false);
  }
  layout(kPressedNumbers).pressed_numbers = true;
}

const MotionDecoder::Layout* MotionDecoder::find(
    std::span<const std::uint8_t> report) const noexcept {
  if (numbered_ && report.empty()) return nullptr;
  const std::uint8_t id = numbered_ ? report[0] : 0;
  const auto found = std::find_if(layouts_.begin(), layouts_.end(),
                                  [id](const Layout& one) { return one.id == id; });
  return found == layouts_.end() ? nullptr : &*found;
}

MotionDecoder::Decoded MotionDecoder::decode(const Report& report) noexcept {
  count_ = 0;
  const Layout* const layout = find(report.bytes);
  if (layout == nullptr) {
    // 3Dconnexion's devices have reports of which nothing is published.
    return {spec_ != nullptr ? ReportClass::kOther : ReportClass::kUnknownId, {}};
  }
  if (const auto end = due(); end && *end <= report.time) push_silence(*end);
  state_.device = report.device;
  state_.time = report.time;
  state_.silence = false;
  state_.disturbances = {};
  state_.lost = 0;
  state_.lost_estimated = false;
  const bool moved = read_axes(*layout, report.bytes);
  const bool pressed = read_buttons(*layout, report.bytes);
  state_.battery_percent.reset();
  std::int64_t battery = 0;
  if (layout->battery.read(report.bytes, battery) && battery >= 0 && battery <= 100) {
    state_.battery_percent = static_cast<std::uint8_t>(battery);
  }
  if (moved) moved_ = report.time;
  if (moved || pressed || state_.battery_percent) {
    out_[count_++] = state_;
    const bool status = !moved && !pressed;
    return {status ? ReportClass::kStatus : ReportClass::kMotion, pushed()};
  }
  const bool nothing_in_it = layout->axes.empty() && layout->buttons.empty() && !layout->battery &&
                             !layout->pressed_numbers;
  return {nothing_in_it ? ReportClass::kOther : ReportClass::kTooShort, pushed()};
}

/// Whether a half was read as a whole; one that is cut off stays as it was.
bool MotionDecoder::read_axes(const Layout& layout, std::span<const std::uint8_t> report) noexcept {
  std::array<bool, 2> told{};
  std::array<bool, 2> cut{};
  auto counts = state_.raw;
  auto axes = axes_;
  const auto read = [&](const Axis& axis) {
    const std::size_t half = axis.index / kHalf;
    std::int64_t count = 0;
    if (!axis.reader.read(report, count)) {
      cut[half] = true;
      return;
    }
    told[half] = true;
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
    counts[axis.index] = static_cast<std::int32_t>(std::clamp(count, -kMost, kMost));
    axes[axis.index] = counts[axis.index] / axis.full_counts;
  };
  for (const Axis& axis : layout.axes) read(axis);
  if (layout.id == kTranslation && !beyond_.empty() &&
      beyond_.back().reader.read(report).has_value()) {
    for (const Axis& axis : beyond_) read(axis);
  }
  for (std::size_t half = 0; half < told.size(); ++half) {
    told[half] = told[half] && !cut[half];
    if (!told[half]) continue;
    std::copy_n(counts.begin() + half * kHalf, kHalf, state_.raw.begin() + half * kHalf);
    std::copy_n(axes.begin() + half * kHalf, kHalf, axes_.begin() + half * kHalf);
  }
  state_.translation_told = told[0];
  state_.rotation_told = told[1];
  state_.deflection = in_motion_frame(axes_, frame_);
  return told[0] || told[1];
}

bool MotionDecoder::read_buttons(const Layout& layout,
                                 std::span<const std::uint8_t> report) noexcept {
  if (layout.pressed_numbers) {
    if (report.size() < 3) return false;
    state_.buttons = {};
    for (std::size_t at = 1; at + 1 < report.size(); at += 2) {
      state_.buttons.set(read_le16(report, at), true);
    }
    return true;
  }
  bool read = false;
  for (const Button& button : layout.buttons) {
    std::int64_t value = 0;
    if (!button.reader.read(report, value)) continue;
    state_.buttons.set(button.number, value != 0);
    read = true;
  }
  return read;
}

std::optional<Timestamp> MotionDecoder::due() const noexcept {
  if (!moved_ || state_.is_zero()) return std::nullopt;
  return *moved_ + kSilence;
}

void MotionDecoder::push_silence(Timestamp time) noexcept {
  state_.time = time;
  state_.raw = {};
  axes_ = {};
  state_.deflection = {};
  state_.translation_told = state_.rotation_told = false;
  state_.silence = true;
  state_.battery_percent.reset();
  state_.lost = 1;  // the report of its release
  state_.lost_estimated = true;
  state_.disturbances = Disturbance::kGap;
  out_[count_++] = state_;
}

std::span<const MotionSample> MotionDecoder::advance(Timestamp now) noexcept {
  count_ = 0;
  if (const auto end = due(); end && *end <= now) push_silence(*end);
  return pushed();
}

std::span<const MotionSample> MotionDecoder::disconnect(DeviceIndex device,
                                                        Timestamp time) noexcept {
  count_ = 0;
  if (state_.is_zero() && state_.buttons.empty()) return {};
  state_.device = device;
  state_.buttons = {};
  push_silence(time);
  MotionSample& last = out_[count_ - 1];
  last.lost = 0;
  last.lost_estimated = false;
  last.disturbances = {};
  return pushed();
}

}  // namespace limn
