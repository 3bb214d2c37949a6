#include "input/trace_import/stepped_trace_reader.hpp"

#include <algorithm>
#include <utility>

#include "input/trace/text.hpp"

namespace limn {

Expected<TraceEvent> SteppedTraceReader::next() {
  while (given_ == queue_.size()) {
    queue_.clear();
    given_ = 0;
    if (failure_) return tl::unexpected(*failure_);
    if (finished_) {
      queue_.push_back({TraceEnd{}, place_});
      break;
    }
    const auto more = step();
    if (!more) {
      failure_ = more.error();
    } else if (!*more) {
      finished_ = true;
      emit_damage();
    }
  }
  PlacedEvent& placed = queue_[given_++];
  place_ = placed.number;
  return std::move(placed.event);
}

std::string SteppedTraceReader::place() const {
  return std::string(unit_) + ' ' + std::to_string(place_);
}

void SteppedTraceReader::emit(TraceEvent event, std::uint64_t number) {
  emit_damage();
  queue_.push_back({std::move(event), number});
}

Expected<void> SteppedTraceReader::damaged(Error error, std::optional<DeviceIndex> report_of,
                                           bool went_back) {
  if (!salvage_) return tl::unexpected(std::move(error));
  if (!damage_) damage_ = Damage{{std::move(error), {}}, 0};
  ++damage_->parts;
  if (!report_of) return {};
  auto& lost = damage_->event.lost;
  const auto known = std::find_if(lost.begin(), lost.end(), [&](const LostReports& reports) {
    return reports.device == *report_of;
  });
  if (known == lost.end()) {
    lost.push_back({*report_of, 1, went_back});
  } else {
    ++known->count;
    known->time_went_back |= went_back;
  }
  return {};
}

void SteppedTraceReader::emit_damage() {
  if (!damage_) return;
  Damage damage = *std::exchange(damage_, std::nullopt);
  damage.event.error.what += " (" + text::counted(damage.parts, "damage") + " skipped)";
  damage.event.error.remedy = "the rest is read; look at what comes just after it with care";
  queue_.push_back({std::move(damage.event), place_});
}

}  // namespace limn
