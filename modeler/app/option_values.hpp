#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/transport/device_listing.hpp"
#include "modeler/app/output_format.hpp"

namespace limn::app {

// Values of options, from text as typed. Each stores the value and returns "", or returns what is
// wrong with the text and what to write instead.

/// "VID:PID", one to four hexadecimal digits each, as lsusb prints it.
std::string parse_id(std::string_view text, std::uint16_t& vendor, std::uint16_t& product);

/// "text", "json", "jsonl" or "csv".
std::string parse_format(std::string_view text, OutputFormat& format);

/// "hidraw", "usb", "evdev" or "spnav".
std::string parse_backend(std::string_view text, Backend& backend);

/// A finite length above 0, in mm.
std::string parse_length(std::string_view text, double& length_mm);

/// A finite duration above 0, in seconds; at most 10^8 (three years).
std::string parse_seconds(std::string_view text, double& seconds);

/// A finite factor above 0.
std::string parse_speed(std::string_view text, double& speed);

/// A finite speed above 0, in mm/s or rad/s: at most 10^6.
std::string parse_full_speed(std::string_view text, double& speed);

/// A number from 0 to `most`.
std::string parse_fraction(std::string_view text, double most, double& fraction);

/// Six numbers, or one for all six, separated by commas.
std::string parse_factors(std::string_view text, std::array<double, 6>& factors);

/// Six axes of a 3D mouse, "x,y,z,rx,ry,rz" in any order, perhaps repeated, each with a "-" before
/// it where it is inverted: the device's axes that drive these.
std::string parse_axes(std::string_view text, std::array<std::uint8_t, 6>& source,
                       std::array<bool, 6>& inverted);

/// A TCP port of 127.0.0.1, the only address that limn serves; 0 is any that is free.
std::string parse_port(std::string_view text, std::uint16_t& port);

/// The number of a device in a recording, from 0 to 2^32 - 1.
std::string parse_index(std::string_view text, std::uint32_t& index);

/// A whole number from 0 to 2^64 - 1.
std::string parse_seed(std::string_view text, std::uint64_t& seed);

}  // namespace limn::app
