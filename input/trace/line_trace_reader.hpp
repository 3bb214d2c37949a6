#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input/trace/line_source.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// What all text formats share: lines in, events out, errors and salvage. A format overrides take()
/// and finish(), which emit() any number of events each, and skipped().
class LineTraceReader : public TraceReader {
 public:
  Expected<TraceEvent> next() final;
  std::string place() const final;

 protected:
  LineTraceReader(std::unique_ptr<ByteSource> bytes, bool salvage);

  /// Takes in the next line, which holds no NUL byte and is not too long. An error is damage.
  virtual Expected<void> take(const Line& line) = 0;

  /// Called once, after the last line. An error is damage.
  virtual Expected<void> finish() = 0;

  /// `line` is damaged and was skipped (salvage only): forget what depended on it, and say what was
  /// lost with it by lose_report().
  virtual void skipped(const Line& line) = 0;

  /// Queues an event that stands in line `number`, by default the one in hand. What it borrows must
  /// outlive the call of take() that emits it until the next call of take().
  void emit(TraceEvent event);
  void emit(TraceEvent event, std::uint64_t number);

  /// A report of `device` was part of what is skipped. To be called in skipped() only.
  void lose_report(DeviceIndex device);

  std::uint64_t line_number() const noexcept { return number_; }

  /// Damage in the line in hand.
  tl::unexpected<Error> damaged(std::string what, ErrorCode code = ErrorCode::kSyntax) const;

  /// The line in hand is damage because its time `word` is before that of the `what` before it.
  tl::unexpected<Error> went_back(std::string_view word, std::string_view what);

  /// The last line has no line end and cannot be known to be whole.
  tl::unexpected<Error> cut_short() const;

 private:
  struct PlacedEvent {
    TraceEvent event;
    std::uint64_t line;
  };
  struct Damage {
    Error error;
    std::uint64_t line;
    std::uint64_t lines;
    std::vector<LostReports> lost;
  };

  Expected<void> step();
  Expected<void> take_checked(const Line& line);
  void add_damage(Error error, std::uint64_t lines);
  void emit_damage();

  LineSource lines_;
  bool salvage_;
  bool finished_ = false;
  std::uint64_t number_ = 0;
  std::uint64_t place_ = 0;
  std::vector<PlacedEvent> queue_;  // emptied before the next line, so it stays small
  std::size_t given_ = 0;           // of queue_
  std::optional<Damage> damage_;    // skipped since the last event
  bool went_back_ = false;          // the time of the line in hand
  std::optional<Error> failure_;
};

}  // namespace limn
