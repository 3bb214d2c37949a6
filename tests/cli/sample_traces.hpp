#pragma once

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

namespace limn::test {

/// The head of a hid-recorder file of a small pen whose numbers are easy to see through. Report ID
/// 1, 6 bytes: tip switch (bit 0), in range (bit 1), X and Y of 16 bits, 0..1000 counts over
/// 0..100 mm, so 0.1 mm a count.
inline std::string small_pen_header() {
  return "R: 59 05 0d 09 02 a1 01 85 01 09 20 a1 00 09 42 09 32 15 00 25 01 75 01 95 02 81 02 95 "
         "06 81 03 05 01 15 00 26 e8 03 35 00 45 64 55 0f 65 11 75 10 95 01 09 30 81 02 09 31 81 "
         "02 c0 c0\nN: Small Pen\nI: 3 1209 0001\n";
}

/// Its report descriptor.
inline std::vector<std::uint8_t> small_pen_descriptor() {
  std::istringstream words(small_pen_header().substr(6));  // behind "R: 59 "
  std::vector<std::uint8_t> bytes;
  unsigned byte = 0;
  for (words >> std::hex; bytes.size() < 59 && words >> byte;) {
    bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  return bytes;
}

/// The same pen draws a line of 10 mm to the right in eleven samples, 5 ms apart, and leaves.
inline std::string small_pen_line() {
  std::string text = small_pen_header();
  text += "E: 5.000000 6 01 02 64 00 c8 00\n";
  for (int i = 0; i <= 10; ++i) {
    const char* digits = "0123456789abcdef";
    const int x = 100 + 10 * i;  // counts
    text += "E: 5.0" + std::to_string(10 + 5 * i).substr(0, 2) + "000 6 01 03 ";
    text += {digits[x >> 4], digits[x & 15], ' '};
    text += "00 c8 00\n";
  }
  return text + "E: 5.070000 6 01 02 c8 00 c8 00\nE: 5.075000 6 01 00 c8 00 c8 00\n";
}

}  // namespace limn::test
