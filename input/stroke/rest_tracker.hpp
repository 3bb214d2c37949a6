#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "input/sample/motion_sample.hpp"

namespace limn {

/// Learns how a 3D mouse rests, from its samples, and takes that off their deflections.
///
/// Devices with exact rest send three reports of zeros and fall silent. They have no noise to take
/// off, so none is: a count is a count. What is known of a device by its table
/// (MotionSample::rests_exactly) holds until it proves wrong: a worn device never shows such a
/// rest, and for kWornAfter stays within kSmall, no axis wandering by more than kWornSpread.
///
/// Any other device may send noise at rest. Until it is known nothing below kSmall counts; once all
/// axes stayed within kSmall for kFirstLook, their mean is the bias and three times their largest
/// excursion the noise. The bias then follows what stays in the noise; a steady kNextLook elsewhere
/// within kSmall replaces it. A deliberate deflection below kSmall, held as still as that, is taken
/// for rest: nothing tells them apart. But a report of zeros only, where rest was learned to be
/// elsewhere, shows that it was none, and is forgotten.
///
/// A device that says the same to the count, near full deflection or beyond, for kStuckAfter is
/// stuck until it says something else: no hand is so still, and whoever flies that far can nudge
/// it.
///
/// A pure function of the samples. Allocates nothing.
class RestTracker {
 public:
  enum class Kind {
    kExact,    ///< exact zeros
    kUnknown,  ///< nothing was seen that tells
    kNoisy,    ///< bias and noise were learned
  };

  static constexpr double kSmall = 0.05;  ///< of full deflection
  static constexpr std::chrono::milliseconds kFirstLook{1000};
  static constexpr std::chrono::seconds kNextLook{2};
  static constexpr std::chrono::seconds kWornAfter{30};
  static constexpr double kWornSpread = 0.015;             ///< of full deflection: some five counts
  static constexpr std::chrono::milliseconds kPause{100};  ///< silence
  static constexpr int kZeroReports = 3;
  static constexpr double kNearFull = 0.95;
  static constexpr std::chrono::seconds kStuckAfter{60};

  /// Takes in the next sample.
  void push(const MotionSample& sample) noexcept;

  Kind kind() const noexcept { return kind_; }
  /// Whether the cap was let go: so many reports of rest came last, or it fell silent.
  bool at_rest() const noexcept { return at_rest_; }

  /// Whether what it says is to be believed no longer.
  bool is_stuck() const noexcept { return stuck_; }

  /// What the axis reads at rest; 0 but for kNoisy.
  double bias(std::size_t axis) const noexcept { return bias_[axis]; }
  /// How far from that it may be at rest.
  double noise(std::size_t axis) const noexcept;

 private:
  using Six = std::array<double, kMotionAxes>;

  /// Samples that stay within kSmall, one after the other.
  struct Window {
    Timestamp begin{};
    std::size_t samples = 0;
    Six sum{};
    Six low{};
    Six high{};
  };

  bool is_quiet(const MotionSample& sample) const noexcept;
  void watch(const MotionSample& sample) noexcept;
  void look(const MotionSample& sample) noexcept;
  void judge(Timestamp time) noexcept;
  void learn() noexcept;
  void forget(const MotionSample& sample) noexcept;
  bool is_within(double spread) const noexcept;

  Kind kind_ = Kind::kUnknown;
  bool started_ = false;
  bool shown_exact_ = false;  // it rested exactly once, which is for good
  bool at_rest_ = true;
  bool stuck_ = false;
  Timestamp same_since_{};
  std::array<std::int32_t, kMotionAxes> same_{};  // counts
  int zero_reports_ = 0;                          // one after the other
  int quiet_reports_ = 0;                         // the same, within the noise
  std::optional<Timestamp> last_;                 // that axes were told
  std::optional<Window> window_;
  Six bias_{};
  Six noise_{};
};

}  // namespace limn
