#include "drivers/devices/evdev_motion_decoder.hpp"

#include <algorithm>

#include "drivers/devices/device_traits.hpp"

namespace limn {
namespace {

// <linux/input-event-codes.h>
constexpr std::uint16_t kEvSyn = 0x00;
constexpr std::uint16_t kEvKey = 0x01;
constexpr std::uint16_t kEvRel = 0x02;
constexpr std::uint16_t kEvAbs = 0x03;
constexpr std::uint16_t kSynDropped = 3;
constexpr std::uint16_t kBtn0 = 0x100;

constexpr std::size_t kHalf = kMotionAxes / 2;
constexpr double kSpacenavdFullCounts = 500;

}  // namespace

EvdevMotionDecoder::EvdevMotionDecoder(const TraceDevice& device) {
  const bool spacenavd = device.physical_path == kSpacenavdPath;
  full_counts_.fill(spacenavd ? kSpacenavdFullCounts : kUsualFullCounts);
  for (const EvdevAxis& axis : device.axes) {
    if (axis.code >= kMotionAxes || spacenavd) continue;
    full_counts_[axis.code] = full_counts(axis.minimum, axis.maximum);
  }
  const MotionSpec* const spec = find_motion_spec(device.vendor, device.product);
  state_.changes_only = true;
  state_.rests_exactly = spec != nullptr || spacenavd;
  if (spacenavd) {
    frame_ = MotionFrame::kUp;
  } else if (spec != nullptr) {
    frame_ = spec->frame;
  }
}

void EvdevMotionDecoder::set(std::size_t axis, std::int32_t count) noexcept {
  state_.raw[axis] = count;
  axes_[axis] = count / full_counts_[axis];
  (axis < kHalf ? state_.translation_told : state_.rotation_told) = true;
}

void EvdevMotionDecoder::release(Half half) noexcept {
  for (std::size_t axis = half * kHalf; axis < (half + 1) * kHalf; ++axis) set(axis, 0);
  relative_[half].reset();
}

std::span<const MotionSample> EvdevMotionDecoder::decode(const EvdevFrame& frame) noexcept {
  count_ = 0;
  if (const auto end = due(); end && *end <= frame.time) {
    advance(*end);
  }
  const auto is_dropped = [](const EvdevEvent& event) {
    return event.type == kEvSyn && event.code == kSynDropped;
  };
  if (std::any_of(frame.events.begin(), frame.events.end(), is_dropped)) {
    dropped_ = true;
    return pushed();
  }
  state_.device = frame.device;
  std::array<bool, 2> relative{};
  bool told = false;
  for (const EvdevEvent& event : frame.events) {
    if (event.type == kEvAbs && event.code < kMotionAxes) {
      set(event.code, event.value);
    } else if (event.type == kEvRel && event.code < kMotionAxes) {
      const Half half = event.code / kHalf;
      if (!relative[half]) release(half);
      relative[half] = true;
      relative_[half] = frame.time;
      set(event.code, event.value);
    } else if (event.type == kEvKey && event.code >= kBtn0) {
      state_.buttons.set(event.code - kBtn0 + 1U, event.value != 0);
    } else {
      continue;
    }
    told = true;
  }
  if (!told) return pushed();
  for (Half half = 0; half < relative_.size(); ++half) {
    if (relative_[half] && frame.time - *relative_[half] >= kRelativeSilence) release(half);
  }
  if (state_.translation_told || state_.rotation_told) moved_ = frame.time;
  push(frame.time);
  return pushed();
}

void EvdevMotionDecoder::push(Timestamp time) noexcept {
  state_.time = time;
  state_.deflection = in_motion_frame(axes_, frame_);
  if (dropped_) {
    state_.lost = 1;
    state_.lost_estimated = true;
    state_.disturbances = Disturbance::kOverrun;
  }
  out_[count_++] = state_;
  dropped_ = false;
  state_.translation_told = state_.rotation_told = false;
  state_.silence = false;
  state_.lost = 0;
  state_.lost_estimated = false;
  state_.disturbances = {};
}

std::optional<Timestamp> EvdevMotionDecoder::due() const noexcept {
  if (!relative_[0] && !relative_[1]) {
    if (!moved_ || state_.is_zero()) return std::nullopt;
    return *moved_ + kLongestHold;
  }
  const Timestamp last =
      std::max(relative_[0].value_or(Timestamp::min()), relative_[1].value_or(Timestamp::min()));
  return last + kRelativeSilence;
}

std::span<const MotionSample> EvdevMotionDecoder::advance(Timestamp now) noexcept {
  count_ = 0;
  const auto end = due();
  if (!end || *end > now) return pushed();
  if (!relative_[0] && !relative_[1]) {
    state_.lost = 1;  // the frame of its release
    state_.lost_estimated = true;
    state_.disturbances = Disturbance::kGap;
  }
  stop(*end);
  return pushed();
}

void EvdevMotionDecoder::stop(Timestamp time) noexcept {
  for (Half half = 0; half < relative_.size(); ++half) release(half);
  state_.translation_told = state_.rotation_told = false;
  state_.silence = true;
  push(time);
}

std::span<const MotionSample> EvdevMotionDecoder::disconnect(DeviceIndex device,
                                                             Timestamp time) noexcept {
  count_ = 0;
  if (state_.is_zero() && state_.buttons.empty()) return {};
  state_.device = device;
  state_.buttons = {};
  stop(time);
  return pushed();
}

}  // namespace limn
