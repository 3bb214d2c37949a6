#include "firmware_sim/devices/motions.hpp"

#include "firmware_sim/devices/portable_math.hpp"

namespace limn::firmware {
namespace {

constexpr MotionInfo kMotions[] = {
    {"push", "push away, to the right and down, one after the other, then click both buttons"},
    {"twist", "twist about the vertical axis to and fro, then tilt to the front"},
    {"orbit", "tilt in two full circles while pulling up a little"},
};

constexpr Deflection kRest{};
constexpr double kMove = 0.45;  // seconds there or back
constexpr double kPause = 0.6;

MotionPiece hold(const Deflection& at, double seconds, std::uint16_t buttons = 0) {
  return {{at}, seconds, buttons};
}

/// There, a moment, back, a pause.
void append_stroke(std::vector<MotionPiece>& pieces, const Deflection& to) {
  pieces.push_back({{kRest, to}, kMove, 0});
  pieces.push_back(hold(to, 0.3));
  pieces.push_back({{to, kRest}, kMove, 0});
  pieces.push_back(hold(kRest, kPause));
}

std::vector<MotionPiece> push() {
  std::vector<MotionPiece> pieces = {hold(kRest, 0.3)};
  append_stroke(pieces, {0, -0.9, 0, 0, 0, 0});
  append_stroke(pieces, {0.7, 0, 0, 0, 0, 0});
  append_stroke(pieces, {0, 0, 0.8, 0, 0, 0});
  for (const std::uint16_t button : {std::uint16_t{1}, std::uint16_t{2}}) {
    pieces.push_back(hold(kRest, 0.2, button));
    pieces.push_back(hold(kRest, 0.2));
  }
  return pieces;
}

std::vector<MotionPiece> twist() {
  std::vector<MotionPiece> pieces = {hold(kRest, 0.3)};
  append_stroke(pieces, {0, 0, 0, 0, 0, 0.8});
  append_stroke(pieces, {0, 0, 0, 0, 0, -0.8});
  append_stroke(pieces, {0, 0, 0, -0.6, 0, 0});
  return pieces;
}

std::vector<MotionPiece> orbit() {
  constexpr int kPointsATurn = 16;
  constexpr int kTurns = 2;
  constexpr double kTilt = 0.5;
  constexpr double kPull = -0.2;
  std::vector<Deflection> points = {kRest};
  for (int i = 0; i <= kTurns * kPointsATurn; ++i) {
    const double angle = 2 * kPi * i / kPointsATurn;
    points.push_back({0, 0, kPull, kTilt * portable_cos(angle), kTilt * portable_sin(angle), 0});
  }
  points.push_back(kRest);
  return {hold(kRest, 0.3), {points, 0.1, 0}, hold(kRest, kPause)};
}

}  // namespace

std::span<const MotionInfo> motions() noexcept { return kMotions; }

std::optional<Motion> find_motion(std::string_view name) {
  if (name == kMotions[0].name) return Motion{kMotions[0], push()};
  if (name == kMotions[1].name) return Motion{kMotions[1], twist()};
  if (name == kMotions[2].name) return Motion{kMotions[2], orbit()};
  return std::nullopt;
}

}  // namespace limn::firmware
