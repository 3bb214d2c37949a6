#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "input/base/error.hpp"

namespace limn {

/// Opaque pixels in rows, from the top left: 0x00RRGGBB, sRGB.
struct PixelImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> pixels;  ///< width times height

  std::uint32_t at(int x, int y) const noexcept {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

/// The bytes of a PNG file. Errors: kMissing where limn was built without cairo; kNumeric where
/// cairo fails. Precondition: 1 to 32,767 pixels a side.
Expected<std::string> encode_png(const PixelImage& image);

}  // namespace limn
