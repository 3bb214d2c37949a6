#include "input/trace/descriptor_file.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "input/trace/format_detection.hpp"
#include "input/trace/line_source.hpp"
#include "input/trace/peeked_bytes.hpp"
#include "input/trace/text.hpp"

namespace limn {
namespace {

using Descriptor = std::vector<std::uint8_t>;

constexpr std::string_view kRemedy =
    "give raw descriptor bytes, hexadecimal text, or a recording with R: or DESCRIPTOR lines";

tl::unexpected<Error> too_long(std::string at) {
  return fail(ErrorCode::kLimit, std::move(at),
              "the descriptor is longer than " + std::to_string(kMaxDescriptorBytes) +
                  " bytes, which no device can declare",
              "check that this is a report descriptor");
}

/// NUL is not counted: it also is the damage that text suffers.
bool is_binary(std::string_view window) {
  return std::any_of(window.begin(), window.end(), [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return (code < ' ' && code != 0 && c != '\t' && c != '\n' && c != '\r' && c != '\f') ||
           code == 0x7F;
  });
}

std::vector<TraceDevice> only_device(Descriptor descriptor) {
  std::vector<TraceDevice> devices(1);
  devices[0].report_descriptor = std::move(descriptor);
  return devices;
}

Expected<std::vector<TraceDevice>> read_binary(ByteSource& bytes) {
  Descriptor descriptor;
  std::array<char, 4096> block{};
  for (;;) {
    const auto count = bytes.read(block);
    if (!count) return tl::unexpected(count.error());
    if (*count == 0) return only_device(std::move(descriptor));
    descriptor.insert(descriptor.end(), block.begin(),
                      block.begin() + static_cast<std::ptrdiff_t>(*count));
    if (descriptor.size() > kMaxDescriptorBytes) {
      return too_long("byte " + std::to_string(kMaxDescriptorBytes));
    }
  }
}

/// Reads hexadecimal text a line at a time; a comment may span lines.
class HexText {
 public:
  Expected<void> take(const Line& line) {
    std::string_view rest = line.text;
    for (;;) {
      const std::string_view word = take_word(rest);
      if (word.empty()) return {};
      if (!append(word)) {
        return fail(ErrorCode::kSyntax, "line " + std::to_string(line.number),
                    text::quoted(word) + " is no hexadecimal byte", std::string(kRemedy));
      }
      if (descriptor_.size() > kMaxDescriptorBytes) {
        return too_long("line " + std::to_string(line.number));
      }
    }
  }

  bool in_comment() const noexcept { return in_comment_; }
  Descriptor& descriptor() noexcept { return descriptor_; }

 private:
  static constexpr std::string_view kSeparators = " \t,\f";

  /// The next run without separators and comments; empty at the end of the line.
  std::string_view take_word(std::string_view& rest) {
    for (;;) {
      if (in_comment_) {
        const std::size_t end = rest.find("*/");
        if (end == std::string_view::npos) return {};
        in_comment_ = false;
        rest.remove_prefix(end + 2);
      }
      rest.remove_prefix(std::min(rest.find_first_not_of(kSeparators), rest.size()));
      if (rest.empty() || rest[0] == '#' || rest.substr(0, 2) == "//") return {};
      in_comment_ = rest.substr(0, 2) == "/*";
      if (in_comment_) {
        rest.remove_prefix(2);
        continue;
      }
      const std::size_t end = std::min(rest.find_first_of(" \t,\f#/"), rest.size());
      const std::string_view word = rest.substr(0, std::max<std::size_t>(end, 1));
      rest.remove_prefix(word.size());
      return word;
    }
  }

  bool append(std::string_view word) {
    constexpr int kHexadecimal = 16;
    const bool prefixed = word.substr(0, 2) == "0x" || word.substr(0, 2) == "0X";
    if (prefixed) word.remove_prefix(2);
    const std::size_t width = prefixed && word.size() == 1 ? 1 : 2;
    if (word.empty() || word.size() % width != 0 || (prefixed && word.size() > 2)) return false;
    for (; !word.empty(); word.remove_prefix(width)) {
      const auto byte = text::parse_integer<std::uint8_t>(word.substr(0, width), kHexadecimal);
      if (!byte) return false;
      descriptor_.push_back(*byte);
    }
    return true;
  }

  Descriptor descriptor_;
  bool in_comment_ = false;
};

Expected<std::vector<TraceDevice>> read_hex_text(std::unique_ptr<ByteSource> bytes) {
  LineSource lines(std::move(bytes));
  HexText text;
  for (;;) {
    const auto line = lines.next();
    if (!line) return tl::unexpected(line.error());
    if (!line->has_value()) break;
    const std::string place = "line " + std::to_string((*line)->number);
    if ((*line)->too_long) {
      return fail(ErrorCode::kLimit, place,
                  "the line is longer than " + std::to_string(kMaxLineBytes) + " bytes",
                  std::string(kRemedy));
    }
    if (const auto taken = text.take(**line); !taken) return tl::unexpected(taken.error());
  }
  if (text.in_comment()) {
    return fail(ErrorCode::kSyntax, "", "a comment that begins with /* has no end", "add the */");
  }
  if (text.descriptor().empty()) {
    return fail(ErrorCode::kMissing, "", "the text holds no bytes", std::string(kRemedy));
  }
  return only_device(std::move(text.descriptor()));
}

/// Keeps a description unless its descriptor is known of that device; then it is the newer one.
Expected<void> keep(const TraceDevice& described, std::vector<TraceDevice>& devices) {
  if (described.report_descriptor.empty()) return {};
  const auto same = std::find_if(devices.begin(), devices.end(), [&](const TraceDevice& known) {
    return known.index == described.index && known.report_descriptor == described.report_descriptor;
  });
  if (same != devices.end()) {
    *same = described;
    return {};
  }
  if (devices.size() == kMaxTraceDevices) {
    return fail(ErrorCode::kLimit, "",
                "more than " + std::to_string(kMaxTraceDevices) + " different descriptors",
                "split the recording");
  }
  devices.push_back(described);
  return {};
}

Expected<std::vector<TraceDevice>> read_recording(std::unique_ptr<ByteSource> bytes, bool salvage) {
  TraceOptions options;
  options.salvage = salvage;
  auto reader = open_trace(std::move(bytes), options);
  if (!reader) return tl::unexpected(reader.error());
  std::vector<TraceDevice> devices;
  for (;;) {
    const auto event = (*reader)->next();
    if (!event) return tl::unexpected(event.error());
    if (std::holds_alternative<TraceEnd>(*event)) break;
    const auto* described = std::get_if<DeviceDescribed>(&*event);
    if (described == nullptr) continue;
    if (auto kept = keep(*described->device, devices); !kept) return tl::unexpected(kept.error());
  }
  if (!devices.empty()) return devices;
  return fail(
      ErrorCode::kMissing, "",
      "this " + std::string(name((*reader)->format())) + " recording holds no report descriptor",
      "give the descriptor as a file of its own, raw or hexadecimal");
}

}  // namespace

Expected<std::vector<TraceDevice>> read_descriptors(std::unique_ptr<ByteSource> bytes,
                                                    const TraceOptions& options) {
  auto peeked = std::make_unique<PeekedBytes>(std::move(bytes));
  const auto grown = peeked->grow();
  if (!grown) return tl::unexpected(grown.error());
  if (peeked->window().empty()) {
    return fail(ErrorCode::kSyntax, "byte " + std::to_string(peeked->leading_nuls()),
                "there is no content", std::string(kRemedy));
  }
  const bool binary = is_binary(peeked->window());
  const auto format = detect_format(*peeked);
  if (!format) return tl::unexpected(format.error());
  // Rows of hexadecimal bytes with commas pass for stroke CSV, which has no descriptors anyway.
  const bool recording = *format && **format != TraceFormat::kStrokeCsv;
  if (!recording && binary) return read_binary(*peeked);
  if (!recording) return read_hex_text(std::move(peeked));
  return read_recording(std::move(peeked), options.salvage);
}

}  // namespace limn
