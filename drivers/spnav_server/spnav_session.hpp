#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string_view>

#include "drivers/spnav_server/spnav_device.hpp"
#include "drivers/spnav_server/spnav_events.hpp"
#include "drivers/spnav_server/spnav_protocol.hpp"

namespace limn {

/// One client of spacenavd's protocol, without its socket: bytes in, events in, messages out.
///
/// Version 0: events as eight words; from the client, words that are its sensitivity. Version 1,
/// for which a client asks first: the same events, and requests of eight words, each answered but
/// for names. Requests that limn does not know, and those that would change the configuration of
/// spacenavd, are answered with a failure. What is no request ends the session.
///
/// A client that does not take its events is not waited for: motions that nobody took become the
/// newest one; of buttons kMostEvents changes are kept, then how they stand in the end. That the
/// motion ended, or a button was released, is told whatever comes between. Answers go before
/// events, since libspnav takes the next message for its answer.
///
/// Events are held back until start(), and a new client knows of no motion and no button.
class SpnavSession final : public SpnavSink {
 public:
  /// Events and requests that wait for a client; with more, no request is read.
  static constexpr std::size_t kMostEvents = 64;
  static constexpr std::size_t kMostAnswers = 64;
  /// libspnav 1.0's spnav_sensitivity() sends the lower half of a double: what lies outside is
  /// refused, which leaves the client as it was.
  static constexpr float kLeastSensitivity = 1e-3F;
  static constexpr float kMostSensitivity = 1e3F;

  /// What the client wrote, in any pieces. `device` answers questions; nullptr: there is none.
  /// False: it does not speak the protocol.
  bool receive(std::span<const std::uint8_t> bytes, const SpnavDevice* device);
  /// Whether it has sent anything.
  bool has_spoken() const noexcept { return has_spoken_; }
  bool takes_requests() const noexcept { return answers_.size() < kMostAnswers; }

  void motion(const SpnavMotion& motion) override;
  void button(unsigned number, bool pressed) override;
  /// A device came or went.
  void device(const SpnavDevice& device, bool came);
  /// Lets events out.
  void start();

  /// The next bytes for the client, at most one message; empty: none. Valid until the next call of
  /// anything else.
  std::span<const std::uint8_t> output() const noexcept;
  /// So many of these were sent.
  void sent(std::size_t count);

 private:
  struct Waiting {
    spnav::Message message{};
    std::size_t size = spnav::kMessageBytes;
  };

  void take_word();
  bool take_request(const SpnavDevice* device);
  void answer(spnav::Message message, std::int32_t status);
  void answer_text(std::int32_t request, std::string_view text);
  bool set_sensitivity(std::int32_t bits) noexcept;
  bool wants(spnav::EventMask events) const noexcept { return (mask_ & events) != 0; }
  bool has_room() const noexcept { return is_started_ && events_.size() < kMostEvents; }
  void fill();
  static bool is_motion(const Waiting& waiting) noexcept {
    return waiting.size == spnav::kMessageBytes && waiting.message[0] == spnav::kMotion;
  }

  std::array<std::uint8_t, spnav::kMessageBytes> received_{};
  std::size_t received_size_ = 0;
  std::int32_t version_ = 0;
  std::uint32_t mask_ = spnav::kMotions | spnav::kButtons;
  float sensitivity_ = 1;
  bool has_spoken_ = false;
  bool is_started_ = false;

  std::size_t sent_ = 0;            // of the message in front
  bool event_is_in_front_ = false;  // begun, so that answers wait for its rest
  std::deque<Waiting> answers_;
  std::deque<Waiting> events_;

  SpnavMotion newest_;
  bool motion_is_due_ = false;  // newest_ is not among the events yet
  bool moves_ = false;          // as the client will know it once it has its events
  MotionButtons pressed_;
  MotionButtons told_;  // the same of buttons
};

}  // namespace limn
