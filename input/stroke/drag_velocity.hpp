#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "input/base/error.hpp"
#include "input/base/time.hpp"
#include "input/sample/motion_sample.hpp"
#include "input/stroke/rest_tracker.hpp"

namespace limn {

/// How a 3D mouse's deflection becomes velocity.
struct DragOptions {
  double mm_per_s = 100;  ///< at full deflection
  double rad_per_s = 1;   ///< at full deflection
  /// Deflections up to this count as none, and velocity grows from 0 at its edge. 0: no count of
  /// motion is swallowed. Below it lies, on devices whose rest is noisy, what was learned of the
  /// noise (RestTracker).
  double dead_zone = 0;
  /// 0: velocity is proportional to deflection; 1: to its cube; between: a blend. Full deflection
  /// gives full velocity with any.
  double curve = 0;
  /// Factor of each axis of the result; 0: off.
  std::array<double, kMotionAxes> sensitivity{1, 1, 1, 1, 1, 1};
  std::array<bool, kMotionAxes> inverted{};  ///< axes of the result
  /// Which axis of the device drives each axis of the result.
  std::array<std::uint8_t, kMotionAxes> source{0, 1, 2, 3, 4, 5};
  /// Of the axes that drive anything only the one that is deflected most counts, until another is
  /// so by a quarter more.
  bool dominant_axis = false;
};

/// Nothing, or what is wrong: kOutOfRange for numbers that are not finite, a dead zone outside 0 to
/// 0.9, a curve outside 0 to 1, a source that is no axis. `at` is the member's name.
Expected<void> check(const DragOptions& options);

/// Velocity of a drag, and how far it went.
struct Drag {
  Timestamp time{};
  std::array<double, 3> mm_per_s{};
  std::array<double, 3> rad_per_s{};
  std::array<double, 3> mm{};   ///< since the Drag before
  std::array<double, 3> rad{};  ///< the same, as a vector of rotation
  /// The cap was let go: three reports of zeros (of no more than noise), silence; or it is stuck.
  bool at_rest = true;
};

/// MotionSamples of one device -> Drags, in the samples' frame. A pure function of what it is
/// given; allocates nothing; + - * / only. Not thread-safe.
///
/// Between two reports of a half (translation, rotation) its velocity goes in a straight line, as a
/// hand does; from rest it starts, and to rest it ends, at the report that says so, and what was
/// not told for longer than kLongestStep was held. So a constant deflection gives the same way
/// whatever the reports' intervals are, and silence before a motion counts nothing.
class DragVelocity {
 public:
  /// Precondition: check(options).
  explicit DragVelocity(const DragOptions& options = {});

  /// The next sample's. Samples whose time goes back count as simultaneous with the one before.
  Drag push(const MotionSample& sample) noexcept;

  /// For those who want to know what the device's rest was found to be.
  const RestTracker& rest() const noexcept { return rest_; }

  static constexpr std::chrono::milliseconds kLongestStep{60};
  static constexpr double kHysteresis = 1.25;

 private:
  static constexpr std::size_t kHalves = 2;
  using Six = std::array<double, kMotionAxes>;

  /// Translation or rotation.
  struct Half {
    std::array<double, 3> velocity{};
    std::optional<Timestamp> told;
  };

  Six shaped(const Six& deflection) noexcept;
  void keep_dominant(Six& axes) noexcept;
  static void advance(Half& half, const std::array<double, 3>& velocity, Timestamp time,
                      bool is_told, std::array<double, 3>& moved) noexcept;

  DragOptions options_;
  RestTracker rest_;
  std::array<Half, kHalves> halves_;
  std::optional<std::size_t> dominant_;
  std::optional<Timestamp> last_;
};

}  // namespace limn
