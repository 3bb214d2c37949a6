#pragma once

#include <cstdint>
#include <span>

#include "modeler/view/canvas.hpp"

namespace limn {

/// A colour in linear light, which can be added and averaged: 0 black to 1 white in each of sRGB's
/// primaries.
struct Tone {
  float red = 0;
  float green = 0;
  float blue = 0;

  Tone& operator+=(const Tone& other) noexcept {
    red += other.red;
    green += other.green;
    blue += other.blue;
    return *this;
  }
  friend Tone operator+(Tone a, const Tone& b) noexcept { return a += b; }
  friend Tone operator*(float factor, const Tone& t) noexcept {
    return {factor * t.red, factor * t.green, factor * t.blue};
  }
};

Tone to_tone(Color color) noexcept;

/// 0x00RRGGBB, each part the nearest to the tone's; below black and above white are these. The same
/// bits on every processor. Precondition: equal sizes.
void to_pixels(std::span<const Tone> tones, std::span<std::uint32_t> pixels) noexcept;

/// Blue over light grey (0) to red, evenly bright on both sides: value from -1 to 1, beyond which
/// the ends stay. Source: [Moreland09], its table of nine colours, interpolated in linear light.
Tone diverging(double value) noexcept;

}  // namespace limn
