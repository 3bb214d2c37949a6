#include "modeler/surface/primitives.hpp"

#include <numbers>
#include <utility>
#include <vector>

#include "modeler/base/tolerance.hpp"
#include "modeler/surface/constructions.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;

/// Sizes below are coincidence, above nothing that doubles could tell to kGeometric.
constexpr double kLargest = 1e9;

Expected<void> check_size(const char* name, double size, bool may_be_zero = false) {
  if ((size >= kGeometric && size <= kLargest) || (may_be_zero && size == 0)) return {};
  return fail(ErrorCode::kOutOfRange, name, "the size is not from 1e-9 to 1e9 mm",
              "give it in mm, above 0");
}

Expected<BsplineCurve<3>> line(const Vector3d& from, const Vector3d& to, double end) {
  auto knots = KnotVector::make_clamped(1, 0, end);
  if (!knots) return tl::unexpected(std::move(knots.error()));
  return BsplineCurve<3>::make(*std::move(knots), {from, to});
}

/// The half circle in the plane of a and b: centre - b, centre + a, centre + b; or all of it.
Expected<BsplineCurve<3>> arc(const Vector3d& center, const Vector3d& a, const Vector3d& b,
                              bool full) {
  const double diagonal = std::numbers::sqrt2 / 2;
  const double quarter = std::numbers::pi / 2;
  std::vector<Vector3d> points;
  std::vector<double> weights;
  std::vector<double> interior;
  const std::array<Vector3d, 4> spoke = {a, b, -a, -b};
  const std::size_t first = full ? 0 : 3;
  const std::size_t quarters = full ? 4 : 2;
  for (std::size_t i = 0; i <= quarters; ++i) {
    const Vector3d& here = spoke[(first + i) % 4];
    points.push_back(center + here);
    weights.push_back(1);
    if (i == quarters) break;
    points.push_back(center + here + spoke[(first + i + 1) % 4]);
    weights.push_back(diagonal);
    if (i > 0) interior.insert(interior.end(), 2, static_cast<double>(i) * quarter);
  }
  const double end = static_cast<double>(quarters) * quarter;
  auto knots = KnotVector::make_clamped(2, 0, end, interior);
  if (!knots) return tl::unexpected(std::move(knots.error()));
  return BsplineCurve<3>::make_rational({*std::move(knots)}, points, weights);
}

/// Turned all the way round frame.z.
Expected<BsplineSurface> revolved(const Expected<BsplineCurve<3>>& profile, const Frame& frame) {
  if (!profile) return tl::unexpected(profile.error());
  return revolve(*profile, frame, kTurn);
}

}  // namespace

Expected<BsplineCurve<3>> make_circle(const Frame& frame, double radius) {
  if (auto ok = check_size("radius", radius); !ok) return tl::unexpected(std::move(ok.error()));
  return arc(frame.origin, radius * frame.x, radius * frame.y, true);
}

Expected<BsplineSurface> make_plane(const Frame& frame, double width, double depth) {
  if (auto ok = check_size("width", width); !ok) return tl::unexpected(std::move(ok.error()));
  if (auto ok = check_size("depth", depth); !ok) return tl::unexpected(std::move(ok.error()));
  return BsplineSurface::make(
      {*KnotVector::make_clamped(1, 0, width), *KnotVector::make_clamped(1, 0, depth)},
      {frame.point(0, 0, 0), frame.point(width, 0, 0), frame.point(0, depth, 0),
       frame.point(width, depth, 0)});
}

Expected<std::array<BsplineSurface, 6>> make_box(const Frame& frame, const Vector3d& size) {
  const auto [x, y, z] = std::array{size.x(), size.y(), size.z()};
  for (const double s : {x, y, z}) {
    if (auto ok = check_size("size", s); !ok) return tl::unexpected(std::move(ok.error()));
  }
  const std::array<Frame, 6> corners = {{
      {frame.origin, frame.z, frame.y, -frame.x},
      {frame.point(x, 0, 0), frame.y, frame.z, frame.x},
      {frame.origin, frame.x, frame.z, -frame.y},
      {frame.point(0, y, 0), frame.z, frame.x, frame.y},
      {frame.origin, frame.y, frame.x, -frame.z},
      {frame.point(0, 0, z), frame.x, frame.y, frame.z},
  }};
  const std::array<std::array<double, 2>, 6> sides = {
      {{z, y}, {y, z}, {x, z}, {z, x}, {y, x}, {x, y}}};
  std::array<BsplineSurface, 6> faces;
  for (std::size_t i = 0; i < 6; ++i) {
    auto face = make_plane(corners[i], sides[i][0], sides[i][1]);
    if (!face) return tl::unexpected(std::move(face.error()));
    faces[i] = *std::move(face);
  }
  return faces;
}

Expected<BsplineSurface> make_disc(const Frame& frame, double radius) {
  if (auto ok = check_size("radius", radius); !ok) return tl::unexpected(std::move(ok.error()));
  return revolved(line(frame.point(radius, 0, 0), frame.origin, radius), frame);
}

Expected<BsplineSurface> make_cylinder(const Frame& frame, double radius, double height) {
  if (auto ok = check_size("radius", radius); !ok) return tl::unexpected(std::move(ok.error()));
  if (auto ok = check_size("height", height); !ok) return tl::unexpected(std::move(ok.error()));
  return revolved(line(frame.point(radius, 0, 0), frame.point(radius, 0, height), height), frame);
}

Expected<BsplineSurface> make_cone(const Frame& frame, double bottom_radius, double top_radius,
                                   double height) {
  if (auto ok = check_size("bottom radius", bottom_radius, top_radius > 0); !ok) {
    return tl::unexpected(std::move(ok.error()));
  }
  if (auto ok = check_size("top radius", top_radius, bottom_radius > 0); !ok) {
    return tl::unexpected(std::move(ok.error()));
  }
  if (auto ok = check_size("height", height); !ok) return tl::unexpected(std::move(ok.error()));
  return revolved(
      line(frame.point(bottom_radius, 0, 0), frame.point(top_radius, 0, height), height), frame);
}

Expected<BsplineSurface> make_sphere(const Frame& frame, double radius) {
  if (auto ok = check_size("radius", radius); !ok) return tl::unexpected(std::move(ok.error()));
  return revolved(arc(frame.origin, radius * frame.x, radius * frame.z, false), frame);
}

Expected<BsplineSurface> make_torus(const Frame& frame, double ring_radius, double tube_radius) {
  if (auto ok = check_size("ring radius", ring_radius); !ok) {
    return tl::unexpected(std::move(ok.error()));
  }
  if (auto ok = check_size("tube radius", tube_radius); !ok) {
    return tl::unexpected(std::move(ok.error()));
  }
  if (!(tube_radius < ring_radius)) {
    return fail(ErrorCode::kOutOfRange, "tube radius", "the tube is not thinner than the ring",
                "make the tube's radius less than the ring's");
  }
  return revolved(
      arc(frame.point(ring_radius, 0, 0), tube_radius * frame.x, tube_radius * frame.z, true),
      frame);
}

}  // namespace limn
