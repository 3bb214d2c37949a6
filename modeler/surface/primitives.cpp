#include "modeler/surface/primitives.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "modeler/surface/constructions.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;

Expected<void> check_size(const char* name, double size, bool may_be_zero = false) {
  if (std::isfinite(size) && (size > 0 || (may_be_zero && size == 0))) return {};
  return fail(ErrorCode::kOutOfRange, name, "the size is not a finite number above 0",
              "give it in mm, above 0");
}

BsplineCurve<3> line(const Vector3d& from, const Vector3d& to, double end) {
  return *BsplineCurve<3>::make(*KnotVector::make_clamped(1, 0, end), {from, to});
}

/// The half circle in the plane of a and b: centre - b, centre + a, centre + b; or all of it.
BsplineCurve<3> arc(const Vector3d& center, const Vector3d& a, const Vector3d& b, bool full) {
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
  return *BsplineCurve<3>::make_rational({*KnotVector::make_clamped(2, 0, end, interior)}, points,
                                         weights);
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
  const Vector3d far = frame.point(x, y, z);
  const Frame low_x{frame.origin, frame.z, frame.y, -frame.x};
  const Frame low_y{frame.origin, frame.x, frame.z, -frame.y};
  const Frame low_z{frame.origin, frame.y, frame.x, -frame.z};
  const Frame high_x{frame.point(x, 0, 0), frame.y, frame.z, frame.x};
  const Frame high_y{frame.point(0, y, 0), frame.z, frame.x, frame.y};
  const Frame high_z{frame.point(0, 0, z), frame.x, frame.y, frame.z};
  std::array<BsplineSurface, 6> faces = {*make_plane(low_x, z, y), *make_plane(high_x, y, z),
                                         *make_plane(low_y, x, z), *make_plane(high_y, z, x),
                                         *make_plane(low_z, y, x), *make_plane(high_z, x, y)};
  if (!far.allFinite()) {
    return fail(ErrorCode::kOutOfRange, "size", "a corner is not finite", "give it in mm");
  }
  return faces;
}

Expected<BsplineSurface> make_disc(const Frame& frame, double radius) {
  if (auto ok = check_size("radius", radius); !ok) return tl::unexpected(std::move(ok.error()));
  return revolve(line(frame.point(radius, 0, 0), frame.origin, radius), frame, kTurn);
}

Expected<BsplineSurface> make_cylinder(const Frame& frame, double radius, double height) {
  if (auto ok = check_size("radius", radius); !ok) return tl::unexpected(std::move(ok.error()));
  if (auto ok = check_size("height", height); !ok) return tl::unexpected(std::move(ok.error()));
  return revolve(line(frame.point(radius, 0, 0), frame.point(radius, 0, height), height), frame,
                 kTurn);
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
  return revolve(line(frame.point(bottom_radius, 0, 0), frame.point(top_radius, 0, height), height),
                 frame, kTurn);
}

Expected<BsplineSurface> make_sphere(const Frame& frame, double radius) {
  if (auto ok = check_size("radius", radius); !ok) return tl::unexpected(std::move(ok.error()));
  return revolve(arc(frame.origin, radius * frame.x, radius * frame.z, false), frame, kTurn);
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
  return revolve(
      arc(frame.point(ring_radius, 0, 0), tube_radius * frame.x, tube_radius * frame.z, true),
      frame, kTurn);
}

}  // namespace limn
