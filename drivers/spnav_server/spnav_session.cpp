#include "drivers/spnav_server/spnav_session.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace limn {
namespace {

using namespace spnav;

/// Longer names than any device has are cut.
constexpr std::size_t kLongestText = 255;

}  // namespace

bool SpnavSession::receive(std::span<const std::uint8_t> bytes, const SpnavDevice* device) {
  has_spoken_ |= !bytes.empty();
  for (const std::uint8_t byte : bytes) {
    received_[received_size_++] = byte;
    if (received_size_ < (version_ == 0 ? sizeof(std::int32_t) : kMessageBytes)) continue;
    received_size_ = 0;
    if (version_ == 0) {
      take_word();
    } else if (!take_request(device)) {
      return false;
    }
  }
  return true;
}

void SpnavSession::take_word() {
  std::int32_t word = 0;
  std::memcpy(&word, received_.data(), sizeof word);
  if ((word & ~0xFF) != (kTag | kChangeVersion)) {
    set_sensitivity(word);
    return;
  }
  version_ = std::min(word & 0xFF, kHighestVersion);
  if (version_ >= 1) mask_ |= kDevices;
  Waiting hello;
  hello.message[0] = kTag | kChangeVersion | version_;
  hello.size = sizeof word;
  answers_.push_back(hello);
}

bool SpnavSession::take_request(const SpnavDevice* device) {
  Message message{};
  std::memcpy(message.data(), received_.data(), received_.size());
  // libspnav 1.0 leaves the tag of strings out.
  const bool is_string = message[0] == kSetName || message[0] == kSetSerialDevice;
  if ((message[0] & ~0xFFFF) != kTag && !is_string) return false;
  constexpr std::int32_t kDone = 0;
  constexpr std::int32_t kFailed = -1;
  const std::int32_t of_device = device != nullptr ? kDone : kFailed;
  switch (const std::int32_t request = message[0] & 0xFFFF; request) {
    case kSetName:
    case kSetSerialDevice:
      break;  // nobody waits for an answer, which would be taken for an event
    case kSetSensitivity:
      answer(message, set_sensitivity(message[1]) ? kDone : kFailed);
      break;
    case kGetSensitivity:
      message[1] = std::bit_cast<std::int32_t>(sensitivity_);
      answer(message, kDone);
      break;
    case kSetEventMask:
      mask_ = std::bit_cast<std::uint32_t>(message[1]);
      answer(message, kDone);
      break;
    case kGetEventMask:
      message[1] = std::bit_cast<std::int32_t>(mask_);
      answer(message, kDone);
      break;
    case kDeviceName:
    case kDevicePath:
      if (device == nullptr) {
        answer(message, kFailed);
      } else {
        answer_text(request, request == kDeviceName ? device->name : device->path);
      }
      break;
    case kDeviceAxes:
      message[1] = kMotionAxes;
      answer(message, of_device);
      break;
    case kDeviceButtons:
      message[1] = device != nullptr ? static_cast<std::int32_t>(device->buttons) : 0;
      answer(message, of_device);
      break;
    case kDeviceUsbId:
      message[1] = device != nullptr ? device->vendor : 0;
      message[2] = device != nullptr ? device->product : 0;
      answer(message, message[1] != 0 ? kDone : kFailed);
      break;
    case kDeviceType:
      message[1] = device != nullptr ? spnav_device_type(device->vendor, device->product) : 0;
      answer(message, of_device);
      break;
    default:
      answer(message, kFailed);
  }
  return true;
}

void SpnavSession::answer(Message message, std::int32_t status) {
  message[kStatus] = status;
  answers_.push_back({message});
}

void SpnavSession::answer_text(std::int32_t request, std::string_view text) {
  text = text.substr(0, kLongestText);
  std::int32_t later = 0;
  do {
    Message message{kTag | request};
    const std::string_view piece = text.substr(0, kStringPiece);
    std::memcpy(&message[1], piece.data(), piece.size());
    answer(message, static_cast<std::int32_t>(text.size()) | later);
    text.remove_prefix(piece.size());
    later = kLaterPiece;
  } while (!text.empty());
}

bool SpnavSession::set_sensitivity(std::int32_t bits) noexcept {
  const auto value = std::bit_cast<float>(bits);
  const float size = std::abs(value);
  if (!(size >= kLeastSensitivity && size <= kMostSensitivity)) return false;
  sensitivity_ = value;
  return true;
}

void SpnavSession::motion(const SpnavMotion& motion) {
  const bool ends_one = motion.is_rest() && (moves_ || motion_is_due_);  // that it was told of
  if (!wants(kMotions) && !ends_one) return;
  const std::uint32_t waited = motion_is_due_ ? newest_.period_ms : 0;
  newest_ = motion;
  newest_.period_ms += waited;
  for (std::int32_t& axis : newest_.axes) {
    axis = static_cast<std::int32_t>(static_cast<float>(axis) * sensitivity_);
  }
  motion_is_due_ = true;
  fill();
}

void SpnavSession::button(unsigned number, bool pressed) {
  pressed_.set(number + 1, pressed);
  fill();
}

void SpnavSession::device(const SpnavDevice& device, bool came) {
  if (!wants(kDevices) || version_ < 1 || !has_room()) return;
  Message message{kDevice,
                  came ? 0 : 1,
                  static_cast<std::int32_t>(device.index),
                  spnav_device_type(device.vendor, device.product),
                  device.vendor,
                  device.product};
  events_.push_back({message});
}

void SpnavSession::start() {
  if (is_started_) return;
  is_started_ = true;
  fill();
}

/// Buttons first: they were kept back before the motion that is due, or are older than it.
void SpnavSession::fill() {
  if (pressed_ != told_) {
    for (unsigned number = 1; number <= MotionButtons::kMost && has_room(); ++number) {
      const bool pressed = pressed_.has(number);
      if (pressed == told_.has(number)) continue;
      if (pressed && !wants(kButtons)) continue;  // a release ends what was told
      told_.set(number, pressed);
      const auto from_0 = static_cast<std::int32_t>(number - 1);
      events_.push_back({Message{pressed ? kPress : kRelease, from_0}});
    }
  }
  if (!motion_is_due_ || !is_started_) return;
  const bool begun = events_.size() == 1 && event_is_in_front_;
  const bool takes_place = !events_.empty() && is_motion(events_.back()) && !begun;
  if (!takes_place && !has_room()) return;
  Message message{kMotion};
  std::copy(newest_.axes.begin(), newest_.axes.end(), message.begin() + 1);
  std::uint32_t period = newest_.period_ms;
  if (takes_place) {
    period += static_cast<std::uint32_t>(events_.back().message[kStatus]);
    events_.pop_back();
  }
  message[kStatus] = static_cast<std::int32_t>(std::min<std::uint32_t>(period, INT32_MAX));
  events_.push_back({message});
  moves_ = !newest_.is_rest();
  motion_is_due_ = false;
}

std::span<const std::uint8_t> SpnavSession::output() const noexcept {
  const bool event = event_is_in_front_ || answers_.empty();
  const std::deque<Waiting>& queue = event ? events_ : answers_;
  if (queue.empty()) return {};
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(queue.front().message.data());
  return std::span(bytes, queue.front().size).subspan(sent_);
}

void SpnavSession::sent(std::size_t count) {
  const bool event = event_is_in_front_ || answers_.empty();
  std::deque<Waiting>& queue = event ? events_ : answers_;
  if (queue.empty()) return;
  sent_ += count;
  event_is_in_front_ = event && sent_ < queue.front().size;
  if (sent_ < queue.front().size) return;
  sent_ = 0;
  queue.pop_front();
  fill();
}

}  // namespace limn
