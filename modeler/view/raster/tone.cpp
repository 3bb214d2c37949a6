#include "modeler/view/raster/tone.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "input/base/expect.hpp"

namespace limn {
namespace {

/// By Newton's iteration, for 0 <= x <= 1: pow() has other last bits on other processors.
double fifth_root(double x) noexcept {
  if (x <= 0) return 0;
  double y = 1;
  // Convergence from above is monotone; y^5 falls by (4/5)^5 a step at first, then quadratically.
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) y = 0.8 * y + 0.2 * x / (y * y * y * y);
  return y;
}

/// Linear light of an sRGB value, both from 0 to 1 (IEC 61966-2-1).
double decode(double value) noexcept {
  if (value <= 0.04045) return value / 12.92;
  const double y = (value + 0.055) / 1.055;
  return y * y * fifth_root(y * y);  // y^2.4
}

constexpr int kLevels = 256;
/// Fine enough that the darkest levels, 1 / 3295 apart, have five entries each.
constexpr std::size_t kEncodings = 1 << 14;

std::array<float, kLevels> make_decoded() noexcept {
  std::array<float, kLevels> out;
  for (int i = 0; i < kLevels; ++i) {
    out[static_cast<std::size_t>(i)] = static_cast<float>(decode(i / 255.0));
  }
  return out;
}

using Encodings = std::array<std::uint8_t, kEncodings>;

/// The level nearest in sRGB to the linear light (i + 1/2) / kEncodings.
Encodings make_encodings() noexcept {
  Encodings out;
  int level = 0;
  double next = decode(0.5 / 255);
  for (std::size_t i = 0; i < kEncodings; ++i) {
    const double light = (static_cast<double>(i) + 0.5) / kEncodings;
    while (level < kLevels - 1 && light >= next) {
      ++level;
      next = decode((level + 0.5) / 255);
    }
    out[i] = static_cast<std::uint8_t>(level);
  }
  return out;
}

float decoded(std::uint8_t level) noexcept {
  static const std::array<float, kLevels> kTable = make_decoded();
  return kTable[level];
}

}  // namespace

Tone to_tone(Color color) noexcept {
  return {decoded(color.red), decoded(color.green), decoded(color.blue)};
}

void to_pixels(std::span<const Tone> tones, std::span<std::uint32_t> pixels) noexcept {
  LIMN_EXPECT(tones.size() == pixels.size());
  static const Encodings kTable = make_encodings();
  const auto level = [](float light) -> std::uint32_t {
    constexpr auto kScale = static_cast<float>(kEncodings);
    // 0 for a NaN, too.
    return kTable[light > 0 ? static_cast<std::size_t>(std::min(light * kScale, kScale - 1)) : 0];
  };
  std::transform(tones.begin(), tones.end(), pixels.begin(), [&level](const Tone& tone) {
    return level(tone.red) << 16 | level(tone.green) << 8 | level(tone.blue);
  });
}

Tone diverging(double value) noexcept {
  constexpr std::array<Color, 9> kColors = {{{59, 76, 192},
                                             {98, 130, 234},
                                             {141, 176, 254},
                                             {184, 208, 249},
                                             {221, 221, 221},
                                             {245, 196, 173},
                                             {244, 154, 123},
                                             {222, 96, 77},
                                             {180, 4, 38}}};
  constexpr double kIntervals = kColors.size() - 1;
  const double at = 0.5 * kIntervals * (1 + std::clamp(value, -1.0, 1.0));
  const auto i = std::min(static_cast<std::size_t>(at), kColors.size() - 2);
  const auto part = static_cast<float>(at - static_cast<double>(i));
  return (1 - part) * to_tone(kColors[i]) + part * to_tone(kColors[i + 1]);
}

}  // namespace limn
