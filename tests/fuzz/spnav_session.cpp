// Any bytes from a client of spacenavd's protocol, among motions and buttons, taken at any pace.
//
//   steps: u8 kind modulo 6, then
//     0: u8 length, bytes from the client     1: u16 x of a motion       2: u8 button, u8 pressed
//     3: u8 device, u8 came                   4: u16 bytes that it takes 5: events are let out

#include "drivers/spnav_server/spnav_session.hpp"

#include <cstring>
#include <vector>

#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using namespace limn;

/// What a client that never speaks came to know.
struct Client {
  std::vector<std::uint8_t> bytes;
  bool moves = false;
  MotionButtons pressed;

  void take(SpnavSession& session, std::size_t most) {
    while (most > 0 && !session.output().empty()) {
      const auto output = session.output();
      fuzz::require(output.size() <= spnav::kMessageBytes, "one message at a time");
      const auto taken = output.first(std::min(most, output.size()));
      bytes.insert(bytes.end(), taken.begin(), taken.end());
      most -= taken.size();
      session.sent(taken.size());
      understand();
    }
  }

  void understand() {
    const auto word_at = [this](std::size_t i) {
      std::int32_t word = 0;
      std::memcpy(&word, &bytes[i * sizeof word], sizeof word);
      return word;
    };
    if (bytes.size() < spnav::kMessageBytes) return;
    const std::int32_t type = word_at(0);
    if (type == spnav::kMotion) {
      moves = false;
      for (std::size_t i = 1; i <= kMotionAxes; ++i) moves |= word_at(i) != 0;
      fuzz::require(word_at(spnav::kStatus) >= 0, "a period is no negative one");
    } else if (type == spnav::kPress || type == spnav::kRelease) {
      const auto number = static_cast<unsigned>(word_at(1));
      const bool press = type == spnav::kPress;
      fuzz::require(pressed.has(number + 1) != press, "a button changes");
      pressed.set(number + 1, press);
    } else {
      fuzz::require(false, "an event of the first version");
    }
    bytes.erase(bytes.begin(), bytes.begin() + spnav::kMessageBytes);
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  SpnavSession session;
  const SpnavDevice device{0, "a device of a name that has more than one piece", "/dev/x", 1, 2, 3};
  Client client;
  MotionButtons pressed;
  bool moves = false;
  bool has_spoken = false;
  while (!input.empty()) {
    switch (input.byte() % 6) {
      case 0: {
        if (!session.takes_requests()) break;
        has_spoken = true;
        const std::size_t length = input.byte();
        if (!session.receive(input.take(length), (length & 1) != 0 ? &device : nullptr)) return 0;
        break;
      }
      case 1: {
        SpnavMotion motion;
        motion.axes[0] = static_cast<std::int16_t>(input.word());
        motion.period_ms = 0x7FFF;
        moves = !motion.is_rest();
        session.motion(motion);
        break;
      }
      case 2: {
        const unsigned number = input.byte();
        const bool press = (input.byte() & 1) != 0;
        session.button(number, press);
        pressed.set(number + 1, press);
        break;
      }
      case 3:
        session.device({input.byte(), "", "", 1, 2, 3}, (input.byte() & 1) != 0);
        break;
      case 4:
        // Pieces of messages are not told apart where the client's own bytes are answered.
        if (has_spoken) {
          session.sent(std::min<std::size_t>(input.word(), session.output().size()));
        } else {
          client.take(session, input.word());
        }
        break;
      default:
        session.start();
    }
  }
  session.start();
  if (has_spoken) {
    std::size_t messages = 0;
    for (; !session.output().empty(); ++messages) session.sent(session.output().size());
    fuzz::require(messages <= SpnavSession::kMostEvents + MotionButtons::kMost +
                                  SpnavSession::kMostAnswers + 255 * 11,
                  "bounded memory");
    return 0;
  }
  client.take(session, SIZE_MAX);
  fuzz::require(client.bytes.empty(), "whole messages");
  fuzz::require(client.pressed == pressed, "it knows how the buttons stand");
  fuzz::require(moves || !client.moves, "it knows of rest");
  return 0;
}
