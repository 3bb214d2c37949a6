// Any kernel device, any frames.
//
//   u8       bit 0: a Wacom, bits 1..3: axes declared with a resolution
//   6 times  s32 minimum, s32 maximum of X, Y, pressure, distance, tilt X, twist
//   then events of 7 bytes: u8 type, u16 code, s32 value; a SYN_REPORT (0, 0) ends the frame

#include "drivers/devices/evdev_pen_decoder.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "tests/fuzz/pen_laws.hpp"

namespace {

constexpr std::array<std::uint16_t, 6> kAxes = {0x00, 0x01, 0x18, 0x19, 0x1A, 0x02};
constexpr std::size_t kHead = 1 + kAxes.size() * 8;
constexpr std::size_t kEvent = 7;
constexpr std::size_t kMostEventsAFrame = 64;

std::int32_t number(const std::uint8_t* bytes) {
  std::int32_t value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace limn;
  if (size < kHead) return 0;
  TraceDevice device;
  const unsigned options = data[0];
  device.vendor = (options & 1U) != 0 ? 0x056A : 0x1234;
  device.product = 0x0304;
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    EvdevAxis axis;
    axis.code = kAxes[i];
    axis.minimum = number(data + 1 + 8 * i);
    axis.maximum = number(data + 5 + 8 * i);
    axis.resolution = (options >> 1 & 7U) > i ? 40 : 0;
    device.axes.push_back(axis);
  }
  auto decoder = EvdevPenDecoder::make(device);
  if (!decoder) return 0;

  fuzz::PenLaws laws;
  std::vector<EvdevEvent> events;
  const auto end_frame = [&] {
    laws.check(decoder->decode(EvdevFrame{0, {}, events}));
    events.clear();
  };
  for (std::size_t at = kHead; at + kEvent <= size; at += kEvent) {
    EvdevEvent event;
    event.type = data[at];
    event.code = static_cast<std::uint16_t>(data[at + 1] | data[at + 2] << 8);
    event.value = number(data + at + 3);
    const bool report = event.type == 0 && event.code == 0;
    if (!report) events.push_back(event);
    if (report || events.size() == kMostEventsAFrame) end_frame();
  }
  end_frame();
  laws.check(decoder->disconnect(0, {}));
  return 0;
}
