#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input/trace/trace.hpp"

namespace limn::test {

struct ReadReport {
  DeviceIndex device = 0;
  std::int64_t time_ns = 0;
  std::vector<std::uint8_t> bytes;
  friend bool operator==(const ReadReport&, const ReadReport&) = default;
};

struct ReadFrame {
  std::int64_t time_ns = 0;
  std::vector<EvdevEvent> events;
};

/// All that a reader gave, owned, and a letter for each event in order: d(escribed), r(eport),
/// f(rame), s(ample), n(ote), x (damage), and at the end "." or, for an error, "!".
struct Reading {
  std::optional<TraceFormat> format;  // none: not opened
  std::string order;
  std::vector<TraceDevice> devices;
  std::vector<ReadReport> reports;
  std::vector<ReadFrame> frames;
  std::vector<PenSample> samples;
  std::vector<std::string> notes;
  std::vector<Error> damage;
  std::vector<std::string> places;  // of each event but the end
  Error error;                      // where order ends with "!"
};

Reading read_trace(std::unique_ptr<ByteSource> bytes, TraceOptions options = {});
Reading read_trace(std::string_view text, TraceOptions options = {});
Reading salvage_trace(std::string_view text);

/// What a reader that is already open, or the error of opening it, gives.
Reading read_whole(Expected<std::unique_ptr<TraceReader>> reader);

/// Gives `text` in pieces of 1, 2, .. `longest` bytes and again 1, as a pipe might.
std::unique_ptr<ByteSource> dribble_bytes(std::string_view text, std::size_t longest);

/// A line of "what": "line 3: the length says ..", for comparing place and cause at once.
std::string at_and_what(const Error& error);

}  // namespace limn::test
