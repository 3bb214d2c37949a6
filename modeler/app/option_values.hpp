#pragma once

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

/// A TCP port of 127.0.0.1, the only address that limn serves; 0 is any that is free.
std::string parse_port(std::string_view text, std::uint16_t& port);

/// The number of a device in a recording, from 0 to 2^32 - 1.
std::string parse_index(std::string_view text, std::uint32_t& index);

/// A whole number from 0 to 2^64 - 1.
std::string parse_seed(std::string_view text, std::uint64_t& seed);

}  // namespace limn::app
