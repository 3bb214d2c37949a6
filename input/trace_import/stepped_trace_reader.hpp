#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input/trace/trace.hpp"

namespace limn {

/// What readers of recordings that are no lines of text share: events out, errors and salvage. A
/// format overrides step(), which emits any number of events.
class SteppedTraceReader : public TraceReader {
 public:
  Expected<TraceEvent> next() final;
  std::string place() const final;

 protected:
  /// `unit` is what places are counted in: "packet", "line".
  SteppedTraceReader(std::string_view unit, bool salvage) : unit_(unit), salvage_(salvage) {}

  /// Takes in the next part of the recording; false at its end. What emitted events borrow must
  /// stay until the next call. An error ends the reading, whether it salvages or not.
  virtual Expected<bool> step() = 0;

  void emit(TraceEvent event, std::uint64_t number);

  /// Something of the recording is damaged: gives the error, or where the reading salvages keeps it
  /// for the next TraceDamage and gives none. `report_of`: a report of that device went with it.
  Expected<void> damaged(Error error, std::optional<DeviceIndex> report_of = {},
                         bool went_back = false);

 private:
  struct PlacedEvent {
    TraceEvent event;
    std::uint64_t number;
  };
  struct Damage {
    TraceDamage event;
    std::uint64_t parts = 0;
  };
  void emit_damage();

  std::string_view unit_;
  bool salvage_;
  bool finished_ = false;
  std::uint64_t place_ = 0;
  std::vector<PlacedEvent> queue_;  // emptied before the next step, so it stays small
  std::size_t given_ = 0;           // of queue_
  std::optional<Damage> damage_;    // skipped since the last event
  std::optional<Error> failure_;
};

}  // namespace limn
