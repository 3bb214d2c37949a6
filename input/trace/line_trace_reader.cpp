#include "input/trace/line_trace_reader.hpp"

#include <algorithm>
#include <utility>

#include "input/base/expect.hpp"
#include "input/trace/text.hpp"

namespace limn {
namespace {

std::string line_place(std::uint64_t number) { return "line " + std::to_string(number); }

constexpr std::string_view kRemedy = "add --salvage to skip the damaged part";

}  // namespace

LineTraceReader::LineTraceReader(std::unique_ptr<ByteSource> bytes, bool salvage)
    : lines_(std::move(bytes)), salvage_(salvage) {}

Expected<TraceEvent> LineTraceReader::next() {
  while (given_ == queue_.size()) {
    queue_.clear();
    given_ = 0;
    if (failure_) return tl::unexpected(*failure_);
    if (finished_) {
      queue_.push_back({TraceEnd{}, place_});
    } else if (const auto stepped = step(); !stepped) {
      failure_ = stepped.error();
    }
  }
  PlacedEvent& placed = queue_[given_++];
  place_ = placed.line;
  return std::move(placed.event);
}

std::string LineTraceReader::place() const { return line_place(place_); }

/// Takes in one line, or the end. An error ends the reading.
Expected<void> LineTraceReader::step() {
  const auto line = lines_.next();
  if (!line) return tl::unexpected(line.error());
  finished_ = !line->has_value();
  if (!finished_) number_ = (*line)->number;
  went_back_ = false;
  auto taken = finished_ ? finish() : take_checked(**line);
  if (!taken) {
    if (!salvage_) return taken;
    add_damage(taken.error(), finished_ ? 0 : 1);
    if (!finished_) skipped(**line);
  }
  if (finished_) emit_damage();
  return {};
}

Expected<void> LineTraceReader::take_checked(const Line& line) {
  const std::size_t nul = line.text.find('\0');
  if (nul != std::string_view::npos) {
    std::size_t end = line.text.find_first_not_of('\0', nul);
    if (end == std::string_view::npos) end = line.text.size();
    Error error = damaged(text::counted(end - nul, "NUL byte") + " in the text").value();
    error.at = "byte " + std::to_string(line.offset + nul);
    return tl::unexpected(std::move(error));
  }
  if (line.too_long) {
    return damaged("the line is longer than " + std::to_string(kMaxLineBytes) + " bytes",
                   ErrorCode::kLimit);
  }
  return take(line);
}

void LineTraceReader::emit(TraceEvent event) { emit(std::move(event), number_); }

void LineTraceReader::emit(TraceEvent event, std::uint64_t number) {
  emit_damage();
  queue_.push_back({std::move(event), number});
}

tl::unexpected<Error> LineTraceReader::damaged(std::string what, ErrorCode code) const {
  return fail(code, line_place(number_), std::move(what), std::string(kRemedy));
}

tl::unexpected<Error> LineTraceReader::went_back(std::string_view word, std::string_view what) {
  went_back_ = true;
  return damaged("the time " + std::string(word) + " is before that of the " + std::string(what) +
                     " before it",
                 ErrorCode::kOutOfRange);
}

tl::unexpected<Error> LineTraceReader::cut_short() const {
  return fail(ErrorCode::kSyntax, line_place(number_),
              "the last line is cut short: it has no line end",
              "record again, or " + std::string(kRemedy));
}

void LineTraceReader::add_damage(Error error, std::uint64_t lines) {
  if (!damage_) damage_ = Damage{std::move(error), number_, 0, {}};
  damage_->lines += lines;
}

void LineTraceReader::lose_report(DeviceIndex device) {
  LIMN_EXPECT(damage_.has_value());
  std::vector<LostReports>& lost = damage_->lost;
  const auto known = std::find_if(lost.begin(), lost.end(), [device](const LostReports& reports) {
    return reports.device == device;
  });
  if (known != lost.end()) {
    ++known->count;
    known->time_went_back |= went_back_;
  } else if (lost.size() < kMaxTraceDevices) {
    lost.push_back({device, 1, went_back_});
  }
}

void LineTraceReader::emit_damage() {
  if (!damage_) return;
  Damage damage = std::move(*damage_);
  damage_.reset();
  damage.error.what += " (" + text::counted(damage.lines, "line") + " skipped)";
  damage.error.remedy = "the rest is read; look at what comes just after it with care";
  queue_.push_back({TraceDamage{std::move(damage.error), std::move(damage.lost)}, damage.line});
}

}  // namespace limn
