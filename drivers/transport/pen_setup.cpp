#include "drivers/transport/pen_setup.hpp"

#include <algorithm>
#include <utility>

#include "input/trace/noted_string.hpp"

namespace limn {

PenSetup set_up_pen(const PenInitialization& sequence, DeviceControl& control,
                    WaitingClock& clock) {
  PenSetup setup{PenInitializer(sequence), {}, {}};
  const Timestamp latest = clock.now() + kLongestSetup;
  while (const PenInitStep* step = setup.initializer.next()) {
    if (clock.now() > latest) {
      setup.trouble = Error{ErrorCode::kIo, "", "the device answers too slowly to be set up",
                            "unplug it and plug it in again"};
      return setup;
    }
    Expected<void> done;
    NotedString string{step->string_index, {}};
    switch (step->action) {
      case PenInitAction::kReadString: {
        auto answer = control.read_string(step->string_index, kPenStringLanguage, kPenStringLength);
        if (answer) {
          string.bytes = *std::move(answer);
          string.bytes.resize(std::min(string.bytes.size(), NotedString::kMostBytes));
          setup.notes.push_back(note_of(string));
        } else {
          done = tl::unexpected(std::move(answer.error()));
        }
        break;
      }
      case PenInitAction::kWriteInterrupt:
        done = control.write_interrupt(step->endpoint, step->bytes);
        break;
      case PenInitAction::kSetFeature:
        done = control.set_feature(step->bytes);
        break;
    }
    if (!done) {
      setup.trouble = std::move(done.error());
      return setup;
    }
    setup.initializer.done(string.bytes);
  }
  return setup;
}

}  // namespace limn
