#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "input/sample/report.hpp"

namespace limn::bench {

/// Reports of one device, as its firmware would send them while it draws.
struct ReportStream {
  std::string name;
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::vector<std::uint8_t> descriptor;
  std::vector<std::vector<std::uint8_t>> reports;

  /// Report `i`, 5 ms after report i - 1; borrows from this.
  Report report(std::size_t i) const;
};

/// A generic HID pen (that of firmware_sim) on a path of circles, `count` reports.
ReportStream generic_pen_stream(std::size_t count);

/// A Wacom Intuos5 touch M in the vendor's format on the same path: the stylus enters, then `count`
/// reports in contact.
ReportStream wacom_intuos_stream(std::size_t count);

}  // namespace limn::bench
