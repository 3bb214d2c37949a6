#include "modeler/app/option_values.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <vector>

#include "modeler/app/nearest_name.hpp"

namespace limn::app {
namespace {

constexpr std::array<std::string_view, 4> kFormatNames = {"text", "json", "jsonl", "csv"};
constexpr std::array<OutputFormat, 4> kFormats = {OutputFormat::kText, OutputFormat::kJson,
                                                  OutputFormat::kJsonl, OutputFormat::kCsv};

/// Whether all of `text` is one number, in the C locale, without sign or blank before it.
template <class Number, class... Base>
bool read_all(std::string_view text, Number& number, Base... base) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number, base...);
  return error == std::errc() && stop == end;
}

/// At commas.
std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> words;
  for (;;) {
    const auto comma = text.find(',');
    words.push_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return words;
    text.remove_prefix(comma + 1);
  }
}

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

}  // namespace

std::string parse_id(std::string_view text, std::uint16_t& vendor, std::uint16_t& product) {
  constexpr int kHexadecimal = 16;
  const auto colon = text.find(':');
  if (colon != std::string_view::npos && read_all(text.substr(0, colon), vendor, kHexadecimal) &&
      read_all(text.substr(colon + 1), product, kHexadecimal)) {
    return {};
  }
  return quoted(text) + " is no VID:PID of hexadecimal digits, such as 28bd:0905";
}

std::string parse_format(std::string_view text, OutputFormat& format) {
  for (std::size_t i = 0; i < kFormats.size(); ++i) {
    if (text != kFormatNames[i]) continue;
    format = kFormats[i];
    return {};
  }
  return "there is no format " + quoted(text) + "; " + suggest(text, kFormatNames);
}

std::string parse_backend(std::string_view text, Backend& backend) {
  std::vector<std::string_view> names;
  for (const Backend known : kBackends) {
    names.push_back(name(known));
    if (text != names.back()) continue;
    backend = known;
    return {};
  }
  return "there is no backend " + quoted(text) + "; " + suggest(text, names);
}

std::string parse_length(std::string_view text, double& length_mm) {
  if (read_all(text, length_mm) && std::isfinite(length_mm) && length_mm > 0) return {};
  return quoted(text) + " is no length above 0 mm, such as 0.1";
}

std::string parse_seconds(std::string_view text, double& seconds) {
  constexpr double kLongest = 1e8;
  if (read_all(text, seconds) && seconds > 0 && seconds <= kLongest) return {};
  return quoted(text) + " is no duration above 0 s, such as 10";
}

std::string parse_speed(std::string_view text, double& speed) {
  if (read_all(text, speed) && std::isfinite(speed) && speed > 0) return {};
  return quoted(text) + " is no factor above 0, such as 2";
}

std::string parse_full_speed(std::string_view text, double& speed) {
  constexpr double kFastest = 1e6;
  if (read_all(text, speed) && speed > 0 && speed <= kFastest) return {};
  return quoted(text) + " is no speed above 0, such as 100";
}

std::string parse_fraction(std::string_view text, double most, double& fraction) {
  if (read_all(text, fraction) && fraction >= 0 && fraction <= most) return {};
  char range[32];
  std::snprintf(range, sizeof range, "%g", most);
  return quoted(text) + " is no number from 0 to " + range;
}

std::string parse_factors(std::string_view text, std::array<double, 6>& factors) {
  constexpr double kMost = 1e6;
  const auto words = split(text);
  std::array<double, 6> read{};
  bool good = words.size() == 1 || words.size() == read.size();
  for (std::size_t i = 0; good && i < read.size(); ++i) {
    good = read_all(words[words.size() == 1 ? 0 : i], read[i]) && std::abs(read[i]) <= kMost;
  }
  if (!good) return quoted(text) + " is neither one factor nor six, such as 1,1,0.5,1,1,1";
  factors = read;
  return {};
}

std::string parse_axes(std::string_view text, std::array<std::uint8_t, 6>& source,
                       std::array<bool, 6>& inverted) {
  constexpr std::array<std::string_view, 6> kAxes = {"x", "y", "z", "rx", "ry", "rz"};
  const auto words = split(text);
  if (words.size() != kAxes.size()) {
    return quoted(text) + " are not six axes, such as x,y,z,rx,ry,-rz";
  }
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    std::string_view word = words[i];
    inverted[i] = word.starts_with('-');
    word.remove_prefix(inverted[i] ? 1 : 0);
    const auto* const found = std::find(kAxes.begin(), kAxes.end(), word);
    if (found == kAxes.end())
      return "there is no axis " + quoted(word) + "; " + suggest(word, kAxes);
    source[i] = static_cast<std::uint8_t>(found - kAxes.begin());
  }
  return {};
}

std::string parse_port(std::string_view text, std::uint16_t& port) {
  if (read_all(text, port)) return {};
  return quoted(text) + " is no port of 127.0.0.1 from 0 to 65535, such as 3240";
}

std::string parse_index(std::string_view text, std::uint32_t& index) {
  if (read_all(text, index)) return {};
  return quoted(text) + " is no device number from 0 on";
}

std::string parse_seed(std::string_view text, std::uint64_t& seed) {
  if (read_all(text, seed)) return {};
  return quoted(text) + " is no whole number from 0 to 2^64 - 1";
}

}  // namespace limn::app
