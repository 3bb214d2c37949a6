#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

#include "modeler/surface/measures.hpp"
#include "modeler/surface/primitives.hpp"
#include "modeler/surface/surface_crossings.hpp"

/// Shapes that cross, and what holds for whatever is found of them.
namespace limn::test {

inline constexpr double kTolerance = 1e-4;  // mm

inline Frame frame_at(const Eigen::Vector3d& origin,
                      const Eigen::Vector3d& x = Eigen::Vector3d::UnitX(),
                      const Eigen::Vector3d& y = Eigen::Vector3d::UnitY()) {
  return {origin, x, y, x.cross(y)};
}

/// A square about `middle` along x and y.
inline BsplineSurface square(const Eigen::Vector3d& middle, double side,
                             const Eigen::Vector3d& x = Eigen::Vector3d::UnitX(),
                             const Eigen::Vector3d& y = Eigen::Vector3d::UnitY()) {
  return *make_plane(frame_at(middle - 0.5 * side * (x + y), x, y), side, side);
}

inline BsplineSurface ball(const Eigen::Vector3d& middle, double radius) {
  return *make_sphere(frame_at(middle), radius);
}

inline Eigen::Vector3d on(const BsplineSurface& surface, const Eigen::Vector2d& at) {
  return surface.point({at.x(), at.y()});
}

inline SurfaceCrossings cross(const BsplineSurface& first, const BsplineSurface& second) {
  return cross_surfaces(SurfaceIndex(first), SurfaceIndex(second), kTolerance);
}

inline double total_length(const SurfaceCrossings& found) {
  double sum = 0;
  for (const SurfaceCrossing& c : found.curves) sum += arc_length(c.curve, 1e-9).value;
  return sum;
}

/// All control points of a curve of parameters lie in the domain of theirs.
inline void expect_inside(const BsplineCurve<2>& curve, int direction, const KnotVector& knots) {
  for (std::size_t i = 0; i < curve.control_points().size(); ++i) {
    const double u = curve.control_points()[i][direction];
    EXPECT_GE(u, knots.domain_begin());
    EXPECT_LE(u, knots.domain_end());
  }
}

/// The three curves agree within what is said, and tangents with t as arc length.
inline void expect_on_both(const SurfaceCrossing& crossing, const BsplineSurface& first,
                           const BsplineSurface& second) {
  EXPECT_LE(crossing.deviation, kTolerance);
  const double room = 1.5 * crossing.deviation + 1e-9;  // found in three places of a span
  const std::vector<double> ends = crossing.curve.knots().breakpoints();
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    for (const double part : {0.0, 0.15, 0.4, 0.6, 0.85}) {
      const double t = ends[i] + part * (ends[i + 1] - ends[i]);
      const Eigen::Vector3d point = crossing.curve.point(t);
      EXPECT_LE((on(first, crossing.on_first.point(t)) - point).norm(), room);
      EXPECT_LE((on(second, crossing.on_second.point(t)) - point).norm(), room);
    }
  }
  for (int d = 0; d < 2; ++d) {
    expect_inside(crossing.on_first, d, first.knots(d));
    expect_inside(crossing.on_second, d, second.knots(d));
  }
  const auto closes = [](const auto& curve) {
    const KnotVector& knots = curve.knots();
    return (curve.point(knots.domain_begin()) - curve.point(knots.domain_end())).norm() < 1e-12;
  };
  EXPECT_EQ(crossing.is_closed, closes(crossing.on_first) && closes(crossing.on_second));
}

/// Curves of this total length, all of them.
inline void expect_length(const BsplineSurface& first, const BsplineSurface& second,
                          double length) {
  const SurfaceCrossings found = cross(first, second);
  EXPECT_TRUE(found.complete);
  EXPECT_TRUE(found.touches.empty());
  EXPECT_NEAR(total_length(found), length, 1e-4 * length);
  for (const SurfaceCrossing& c : found.curves) expect_on_both(c, first, second);
}

}  // namespace limn::test
