#include "input/trace_import/trace_import.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "input/trace/peeked_bytes.hpp"
#include "input/trace/text.hpp"
#include "input/trace_import/libinput_reader.hpp"
#include "input/trace_import/motion_csv_reader.hpp"
#include "input/trace_import/usb_capture_reader.hpp"

namespace limn {
namespace {

using namespace std::string_view_literals;

/// How pcap files begin, in either byte order, with microseconds or nanoseconds, and pcapng files.
constexpr std::array kCaptures = {"\xA1\xB2\xC3\xD4"sv, "\xD4\xC3\xB2\xA1"sv, "\xA1\xB2\x3C\x4D"sv,
                                  "\x4D\x3C\xB2\xA1"sv, "\x0A\x0D\x0D\x0A"sv};

/// The first lines of a libinput recording, if these are some: comments, then version: and what
/// else stands at the top.
bool is_libinput_record(std::string_view text, bool whole) {
  bool version = false;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos && !whole) return false;
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.starts_with("# libinput record") || line.starts_with("ndevices:")) return true;
    if (line.starts_with("version:")) {
      version = true;
    } else if (version && (line.starts_with("libinput:") || line.starts_with("devices:"))) {
      return true;
    } else if (!line.empty() && line[0] != '#' && line[0] != '-' && line[0] != '\r' &&
               line[0] != ' ' && !version) {
      return false;
    }
  }
  return false;
}

/// Whether the first line that is no comment and not blank is one of a motion CSV.
bool is_motion_csv(std::string_view text, bool whole) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos && !whole) return false;
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty() || line[0] == '#') continue;
    return is_motion_csv_line(line);
  }
  return false;
}

/// The format of the window, if it is one that open_trace() does not know.
std::optional<TraceFormat> format_of(std::string_view window, bool whole) {
  for (const std::string_view capture : kCaptures) {
    if (window.starts_with(capture)) return TraceFormat::kUsbCapture;
  }
  if (is_libinput_record(window, whole)) return TraceFormat::kLibinputRecord;
  if (is_motion_csv(window, whole)) return TraceFormat::kMotionCsv;
  return std::nullopt;
}

}  // namespace

Expected<std::unique_ptr<TraceReader>> open_import(std::unique_ptr<ByteSource> bytes,
                                                   TraceOptions options) {
  // What decides is within the first step of the window; a pipe may give less at once.
  constexpr std::size_t kDecides = 4096;
  auto peeked = std::make_unique<PeekedBytes>(std::move(bytes));
  std::optional<TraceFormat> format;
  for (;;) {
    const auto grown = peeked->grow();
    if (!grown) return tl::unexpected(grown.error());
    const bool whole = peeked->ended() || !*grown;
    format = format_of(peeked->window(), whole);
    if (format || whole || peeked->window().size() >= kDecides) break;
  }
  if (format == TraceFormat::kUsbCapture) {
    auto capture = UsbCapture::open(std::move(peeked));
    if (!capture) return tl::unexpected(std::move(capture.error()));
    return std::make_unique<UsbCaptureReader>(*std::move(capture), std::move(options));
  }
  if (format == TraceFormat::kLibinputRecord) {
    auto record = read_libinput_record(std::move(peeked), options.salvage);
    if (!record) return tl::unexpected(std::move(record.error()));
    const bool another = record->failure && record->failure->code == ErrorCode::kUnknown;
    if (another && record->items.empty()) {
      return tl::unexpected(*std::move(record->failure));  // another version
    }
    return std::make_unique<LibinputReader>(*std::move(record), std::move(options));
  }
  if (format == TraceFormat::kMotionCsv) {
    return std::make_unique<MotionCsvReader>(std::move(peeked), std::move(options));
  }
  auto reader = open_trace(std::move(peeked), std::move(options));
  if (!reader && reader.error().code == ErrorCode::kSyntax) {
    reader.error().remedy =
        "give a capture of USB (pcap, pcapng), what libinput record, hid-recorder, usbhid-dump or "
        "evemu-record wrote, or a CSV file of a 3D mouse";
  }
  return reader;
}

Expected<std::unique_ptr<TraceReader>> open_import(const std::string& path, TraceOptions options) {
  auto bytes = open_bytes(path);
  if (!bytes) return tl::unexpected(std::move(bytes.error()));
  return open_import(*std::move(bytes), std::move(options));
}

}  // namespace limn
