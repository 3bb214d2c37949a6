#include "input/trace/trace.hpp"

#include <array>
#include <utility>

#include "input/trace/evemu_reader.hpp"
#include "input/trace/format_detection.hpp"
#include "input/trace/hid_recorder_reader.hpp"
#include "input/trace/peeked_bytes.hpp"
#include "input/trace/stroke_csv_reader.hpp"
#include "input/trace/text.hpp"
#include "input/trace/usbhid_dump_reader.hpp"

namespace limn {
namespace {

std::unique_ptr<TraceReader> make_reader(TraceFormat format, std::unique_ptr<ByteSource> bytes,
                                         TraceOptions options) {
  switch (format) {
    case TraceFormat::kHidRecorder:
      return std::make_unique<HidRecorderReader>(std::move(bytes), std::move(options));
    case TraceFormat::kUsbhidDump:
      return std::make_unique<UsbhidDumpReader>(std::move(bytes), std::move(options));
    case TraceFormat::kEvemu:
      return std::make_unique<EvemuReader>(std::move(bytes), std::move(options));
    case TraceFormat::kStrokeCsv:
    case TraceFormat::kUsbCapture:  // this and those below are not told apart here
    case TraceFormat::kLibinputRecord:
    case TraceFormat::kMotionCsv:
      break;
  }
  return std::make_unique<StrokeCsvReader>(std::move(bytes), options);
}

tl::unexpected<Error> unknown_format(const PeekedBytes& bytes) {
  std::string what =
      "this is no recording: neither hid-recorder, usbhid-dump, evemu nor stroke CSV";
  if (bytes.window().empty()) {
    what = bytes.leading_nuls() == 0
               ? "the file is empty"
               : "there is nothing but " + text::counted(bytes.leading_nuls(), "NUL byte");
  }
  return fail(ErrorCode::kSyntax, "byte " + std::to_string(bytes.leading_nuls()), std::move(what),
              "give what hid-recorder, usbhid-dump or evemu-record wrote, or a CSV file with the "
              "columns t,x,y,p; limn convert-trace makes one of other programs' captures");
}

}  // namespace

std::string_view name(TraceFormat format) noexcept {
  constexpr std::array<std::string_view, 7> kNames = {
      "hid-recorder", "usbhid-dump",        "evemu",     "stroke CSV",
      "USB capture",  "libinput recording", "motion CSV"};
  return kNames[static_cast<std::size_t>(format)];
}

Expected<std::optional<TraceEvent>> TraceReader::next_until(Timestamp) { return next(); }

Expected<std::unique_ptr<TraceReader>> open_trace(std::unique_ptr<ByteSource> bytes,
                                                  TraceOptions options) {
  auto peeked = std::make_unique<PeekedBytes>(std::move(bytes));
  const auto format = detect_format(*peeked);
  if (!format) return tl::unexpected(format.error());
  if (!*format) return unknown_format(*peeked);
  return make_reader(**format, std::move(peeked), std::move(options));
}

}  // namespace limn
