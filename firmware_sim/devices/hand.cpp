#include "firmware_sim/devices/hand.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "firmware_sim/devices/portable_math.hpp"

namespace limn::firmware {
namespace {

constexpr double kRangeMm = 10;  // the height below which the tablet notices the pen
constexpr double kAwayMm = 14;
constexpr double kTouchRest = 0.03;  // seconds that the tip rests where it came down
constexpr double kLiftRest = 0.02;
constexpr double kCornerRest = 0.06;
constexpr double kDotRest = 0.06;  // in addition to kTouchRest and kLiftRest
constexpr double kTurningPen = 0.5;

double to_seconds(std::chrono::microseconds t) { return static_cast<double>(t.count()) * 1e-6; }

/// 0 to 1 over 0..1 with minimum jerk.
double ease(double u) noexcept {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10 + u * (6 * u - 15));
}

const PlanePoint& first_point(const PenStroke& stroke) { return stroke.pieces.front().front(); }

}  // namespace

Hand::Hand(const Drawing& drawing) {
  pen_ = first_point(drawing.strokes.front());
  PenEnd held = drawing.strokes.front().end;
  bool away = true;
  for (const PenStroke& stroke : drawing.strokes) {
    if (stroke.end != held) {
      add_flight(pen_, held, 0, kAwayMm);
      Leg turning{MinimumJerk::rest(pen_, kTurningPen), stroke.end, end_of_legs()};
      turning.begin_mm = turning.end_mm = kAwayMm;
      legs_.push_back(turning);
      held = stroke.end;
      away = true;
    }
    add_flight(first_point(stroke), held, away ? kAwayMm : 0, 0);
    add_contact(stroke);
    away = false;
  }
  add_flight(pen_, held, 0, kAwayMm);
  duration_ = std::chrono::microseconds(static_cast<std::int64_t>(end_of_legs() * 1e6));
}

double Hand::end_of_legs() const noexcept {
  return legs_.empty() ? 0 : legs_.back().begin + legs_.back().path.duration();
}

void Hand::add_flight(PlanePoint to, PenEnd end, double begin_mm, double end_mm) {
  const double distance = length(to - pen_);
  const double seconds = 0.15 + 0.025 * std::sqrt(distance);
  const PlanePoint ends[] = {pen_, to};
  const double durations[] = {seconds};
  Leg leg{distance > 0 ? MinimumJerk(ends, durations) : MinimumJerk::rest(to, seconds), end,
          end_of_legs()};
  leg.begin_mm = begin_mm;
  leg.end_mm = end_mm;
  // Ordinary ways over the sheet stay in range.
  leg.arch_mm = begin_mm == end_mm ? std::min(2.5 + 0.05 * distance, 0.8 * kRangeMm) : 0;
  legs_.push_back(std::move(leg));
  pen_ = to;
}

void Hand::add_contact(const PenStroke& stroke) {
  const std::size_t first_leg = legs_.size();
  const auto add = [&](MinimumJerk path) {
    Leg leg{std::move(path), stroke.end, end_of_legs()};
    leg.touches = true;
    leg.pressure = stroke.pressure;
    legs_.push_back(std::move(leg));
  };
  add(MinimumJerk::rest(pen_, kTouchRest));
  for (std::size_t i = 0; i < stroke.pieces.size(); ++i) {
    const std::vector<PlanePoint>& piece = stroke.pieces[i];
    if (i > 0) add(MinimumJerk::rest(pen_, kCornerRest));
    add(piece.size() == 1 ? MinimumJerk::rest(pen_, kDotRest)
                          : MinimumJerk(piece, power_law_durations(piece, stroke.tempo)));
    pen_ = piece.back();
  }
  add(MinimumJerk::rest(pen_, kLiftRest));
  for (std::size_t i = first_leg; i < legs_.size(); ++i) {
    legs_[i].touch_begin = legs_[first_leg].begin;
    legs_[i].touch_end = end_of_legs();
  }
}

double Hand::height_mm(const Leg& leg, double t) noexcept {
  const double u = (t - leg.begin) / leg.path.duration();
  const double bump = u * (1 - u);
  return leg.begin_mm + (leg.end_mm - leg.begin_mm) * ease(u) + 16 * leg.arch_mm * bump * bump;
}

double Hand::pressure(const Leg& leg, double t) noexcept {
  constexpr double kRise = 0.09;  // seconds
  constexpr double kFall = 0.06;
  constexpr double kLightest = 0.1;   // of full pressure, at the touch and at the lift
  constexpr double kDownwards = 0.5;  // how much harder strokes towards the user are
  constexpr double kSlow_mm_per_s = 25;
  const PlanePoint v = leg.path.velocity(t - leg.begin);
  const double rise = kLightest + (1 - kLightest) * ease((t - leg.touch_begin) / kRise);
  const double fall = kLightest + (1 - kLightest) * ease((leg.touch_end - t) / kFall);
  const double press = 1 + kDownwards * v.y / (length(v) + kSlow_mm_per_s);
  return std::clamp(leg.pressure * press * rise * fall, 0.0, 1.0);
}

PenPose Hand::pose(std::chrono::microseconds time) const noexcept {
  const double t = std::clamp(to_seconds(time), 0.0, end_of_legs());
  const auto after =
      std::upper_bound(legs_.begin() + 1, legs_.end(), t,
                       [](double value, const Leg& leg) { return value < leg.begin; });
  const Leg& leg = *(after - 1);
  const PlanePoint at = leg.path.position(t - leg.begin);

  PenPose pose;
  pose.time = time;
  pose.end = leg.end;
  pose.x_mm = at.x;
  pose.y_mm = at.y;
  if (leg.touches) {
    pose.proximity = Proximity::kTouching;
    pose.pressure = pressure(leg, t);
  } else {
    pose.proximity = height_mm(leg, t) < kRangeMm ? Proximity::kHovering : Proximity::kAway;
  }
  // A right hand's pen leans right and towards the user, the more so the farther right and away it
  // reaches; breath and wrist add slow waves.
  pose.tilt_x_deg = 14 + 0.09 * at.x + 3 * portable_sin(2 * kPi * t / 2.7);
  pose.tilt_y_deg = 40 - 0.08 * at.y + 2 * portable_sin(2 * kPi * t / 3.9);
  return pose;
}

}  // namespace limn::firmware
