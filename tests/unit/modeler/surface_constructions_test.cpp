#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "modeler/bspline/jet.hpp"
#include "modeler/bspline/surface_evaluator.hpp"
#include "modeler/surface/constructions.hpp"
#include "modeler/surface/primitives.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

template <class T>
T must(Expected<T> made) {
  if (!made) throw std::runtime_error(made.error().at + ": " + made.error().what);
  return *std::move(made);
}

/// A frame that is not the world's.
Frame tilted() {
  const Eigen::AngleAxisd turn(0.7, Vector3d(1, 2, -1).normalized());
  return {Vector3d(3, -2, 5), turn * Vector3d::UnitX(), turn * Vector3d::UnitY(),
          turn * Vector3d::UnitZ()};
}

Vector3d local(const Frame& f, const Vector3d& p) {
  return {(p - f.origin).dot(f.x), (p - f.origin).dot(f.y), (p - f.origin).dot(f.z)};
}

/// Calls check(point in the frame, normal in the frame) over the surface, off its edges.
template <class Check>
void over(const BsplineSurface& surface, const Frame& frame, Check check) {
  const SurfaceEvaluator prepared(surface);
  for (int i = 1; i < 20; ++i) {
    for (int j = 1; j < 20; ++j) {
      const auto at = [&](int d, int k) {
        const KnotVector& knots = surface.knots(d);
        return knots.domain_begin() + (knots.domain_end() - knots.domain_begin()) * k / 20;
      };
      const SurfaceJet jet = prepared.jet(at(0, i), at(1, j));
      const auto n = normal(jet);
      ASSERT_TRUE(n);
      check(local(frame, jet.point), Vector3d(n->dot(frame.x), n->dot(frame.y), n->dot(frame.z)));
    }
  }
}

TEST(Primitives, AreExactAndFaceOutwards) {
  const Frame f = tilted();
  constexpr double kExact = 1e-13;
  over(must(make_sphere(f, 2)), f, [](const Vector3d& p, const Vector3d& n) {
    EXPECT_NEAR(p.norm(), 2, kExact);
    EXPECT_LT((n - p / 2).norm(), 1e-12);
  });
  over(must(make_cylinder(f, 2, 7)), f, [](const Vector3d& p, const Vector3d& n) {
    EXPECT_NEAR(p.head<2>().norm(), 2, kExact);
    EXPECT_LT((n - Vector3d(p.x(), p.y(), 0) / 2).norm(), 1e-12);
  });
  over(must(make_cone(f, 2, 0, 4)), f, [](const Vector3d& p, const Vector3d& n) {
    EXPECT_NEAR(p.head<2>().norm(), 2 - p.z() / 2, kExact);
    EXPECT_NEAR(n.z(), 1 / std::sqrt(5.0), 1e-12);
  });
  over(must(make_torus(f, 5, 2)), f, [](const Vector3d& p, const Vector3d& n) {
    const double round = p.head<2>().norm();
    EXPECT_NEAR(std::hypot(round - 5, p.z()), 2, kExact);
    const Vector3d ring = Vector3d(p.x(), p.y(), 0) * (5 / round);
    EXPECT_LT((n - (p - ring) / 2).norm(), 1e-12);
  });
  over(must(make_disc(f, 3)), f, [](const Vector3d& p, const Vector3d& n) {
    EXPECT_NEAR(p.z(), 0, kExact);
    EXPECT_LT(p.norm(), 3);
    EXPECT_NEAR(n.z(), 1, 1e-12);
  });
  over(must(make_plane(f, 3, 2)), f, [](const Vector3d& p, const Vector3d& n) {
    EXPECT_NEAR(p.z(), 0, kExact);
    EXPECT_TRUE(p.x() > 0 && p.x() < 3 && p.y() > 0 && p.y() < 2);
    EXPECT_NEAR(n.z(), 1, 1e-12);
  });
}

TEST(Primitives, ABoxHasSixFacesThatFaceOutwards) {
  const Frame f = tilted();
  const Vector3d size(2, 3, 4);
  const auto faces = must(make_box(f, size));
  for (int i = 0; i < 6; ++i) {
    over(faces[i], f, [&](const Vector3d& p, const Vector3d& n) {
      const int axis = i / 2;
      EXPECT_NEAR(p[axis], i % 2 == 1 ? size[axis] : 0, 1e-13);
      EXPECT_NEAR(n[axis], i % 2 == 1 ? 1 : -1, 1e-12);
      EXPECT_TRUE((p.array() > -1e-12).all() && (p.array() < size.array() + 1e-12).all());
    });
  }
}

TEST(Primitives, RefuseSizesThatAreNone) {
  const Frame f;
  EXPECT_FALSE(make_sphere(f, 0));
  EXPECT_FALSE(make_sphere(f, -1));
  EXPECT_FALSE(make_sphere(f, NAN));
  EXPECT_FALSE(make_cylinder(f, 1, INFINITY));
  EXPECT_FALSE(make_cone(f, 0, 0, 1));
  EXPECT_TRUE(make_cone(f, 0, 1, 1));
  EXPECT_FALSE(make_torus(f, 2, 2));
  EXPECT_FALSE(make_plane(f, 1, 0));
  EXPECT_FALSE(make_box(f, {1, -1, 1}));
  EXPECT_FALSE(make_circle(f, 0));
  EXPECT_FALSE(make_disc(f, 0));
  EXPECT_FALSE(make_disc(f, 1e-250));
  EXPECT_FALSE(make_sphere(f, 1e300));
  const Frame broken{Vector3d(NAN, 0, 0)};
  EXPECT_FALSE(make_sphere(broken, 1));
  EXPECT_FALSE(make_cylinder(broken, 1, 1));
  EXPECT_FALSE(make_box(broken, {1, 1, 1}));
  EXPECT_FALSE(make_circle(broken, 1));
}

BsplineCurve<3> wave(double z, int degree = 3) {
  std::vector<Vector3d> points;
  for (int i = 0; i < degree + 3; ++i) points.emplace_back(i, std::sin(i + z), z);
  return must(
      BsplineCurve<3>::make(*KnotVector::make_clamped(degree, 0, 3, std::array{1.0, 2.0}), points));
}

TEST(Revolve, TurnsByTheAngle) {
  const Frame axis{Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  const auto profile = must(
      BsplineCurve<3>::make(*KnotVector::make_clamped(2, 0, 1), {{2, 0, 0}, {4, 0, 1}, {1, 0, 3}}));
  for (const double angle : {0.3, kPi / 2, 2.0, kPi, 5.0, 2 * kPi}) {
    const auto surface = must(revolve(profile, axis, angle));
    EXPECT_EQ(surface.knots(0).domain_end(), angle);
    for (double v = 0; v <= 1; v += 0.125) {
      const Vector3d from = profile.point(v);
      for (double part = 0; part <= 1; part += 0.125) {
        const Vector3d p = surface.point({angle * part, v});
        EXPECT_NEAR(p.head<2>().norm(), from.x(), 1e-13);
        EXPECT_NEAR(p.z(), from.z(), 1e-13);
      }
      const Vector3d end = surface.point({angle, v});
      EXPECT_LT(
          (end - Vector3d(from.x() * std::cos(angle), from.x() * std::sin(angle), from.z())).norm(),
          1e-13);
    }
  }
  EXPECT_FALSE(revolve(profile, axis, 0));
  EXPECT_FALSE(revolve(profile, axis, 7));
  EXPECT_FALSE(revolve(profile, axis, NAN));
}

TEST(Extrude, MovesTheCurve) {
  const auto surface = must(extrude(wave(0), {1, 2, 3}));
  for (double u = 0; u <= 3; u += 0.25) {
    EXPECT_LT((surface.point({u, 0.25}) - wave(0).point(u) - 0.25 * Vector3d(1, 2, 3)).norm(),
              1e-14);
  }
  EXPECT_FALSE(extrude(wave(0), {0, 0, 0}));
}

TEST(Ruled, JoinsByLinesAtEqualParameters) {
  const auto surface = must(make_ruled(wave(0), wave(4, 2)));
  for (double u = 0; u <= 3; u += 0.25) {
    const Vector3d expected = 0.7 * wave(0).point(u) + 0.3 * wave(4, 2).point(u);
    EXPECT_LT((surface.point({u, 0.3}) - expected).norm(), 1e-13);
  }
}

TEST(Coons, HasItsEdges) {
  const auto bottom = wave(0);
  const auto top = wave(4);
  const auto side = [](const Vector3d& a, const Vector3d& b) {
    return must(BsplineCurve<3>::make(*KnotVector::make_clamped(2, 0, 1),
                                      {a, 0.5 * (a + b) + Vector3d(0, 1, 0), b}));
  };
  const auto left = side(bottom.point(0), top.point(0));
  const auto right = side(bottom.point(3), top.point(3));
  const auto surface = must(make_coons(bottom, top, left, right));
  for (double part = 0; part <= 1; part += 0.0625) {
    EXPECT_LT((surface.point({3 * part, 0}) - bottom.point(3 * part)).norm(), 1e-13);
    EXPECT_LT((surface.point({3 * part, 1}) - top.point(3 * part)).norm(), 1e-13);
    EXPECT_LT((surface.point({0, part}) - left.point(part)).norm(), 1e-13);
    EXPECT_LT((surface.point({3, part}) - right.point(part)).norm(), 1e-13);
  }
  const auto apart = make_coons(bottom, top, left, side(bottom.point(3), Vector3d(9, 9, 9)));
  ASSERT_FALSE(apart);
  EXPECT_EQ(apart.error().code, ErrorCode::kNumeric);
  EXPECT_EQ(apart.error().at, "corner 3");
}

TEST(Skin, GoesThroughItsSections) {
  std::vector<BsplineCurve<3>> sections;
  for (int i = 0; i < 7; ++i) sections.push_back(wave(i * i * 0.2, i % 2 == 0 ? 3 : 2));
  for (std::size_t count = 2; count <= 7; ++count) {
    const auto skin = must(make_skin(std::span(sections).first(count)));
    EXPECT_LT(skin.deviation, 1e-12);
    for (std::size_t i = 0; i < count; ++i) {
      for (double u = 0; u <= 3; u += 0.25) {
        EXPECT_LT((skin.surface.point({u, skin.parameters[i]}) - sections[i].point(u)).norm(),
                  1e-12);
      }
    }
  }
  EXPECT_FALSE(make_skin(std::span(sections).first(1)));
  const std::vector<BsplineCurve<3>> same = {wave(0), wave(0)};
  EXPECT_FALSE(make_skin(same));
}

TEST(Skin, RationalSectionsToo) {
  std::vector<BsplineCurve<3>> sections;
  for (int i = 0; i < 5; ++i) {
    sections.push_back(must(make_circle({Vector3d(0, 0, 2 * i)}, 1 + 0.3 * (i % 2))));
  }
  const auto skin = must(make_skin(sections));
  EXPECT_LT(skin.deviation, 1e-12);
  EXPECT_TRUE(skin.surface.is_rational());
}

TEST(Skin, LocallyAChangeStaysLocal) {
  std::vector<BsplineCurve<3>> sections;
  for (int i = 0; i < 12; ++i) sections.push_back(wave(i));
  const auto before = must(make_skin(sections, Skinning::kLocal));
  EXPECT_LT(before.deviation, 0.2);
  EXPECT_GT(before.deviation, 1e-6) << "near its sections, not through them";
  auto rows = sections;
  ASSERT_TRUE(rows[6].set_control_point(2, rows[6].control_points()[2] + Vector3d(0, 1e-3, 0)));
  const auto after = must(make_skin(rows, Skinning::kLocal, before.parameters));
  const auto moved = [&](double v) {
    return (after.surface.point({1.2, v}) - before.surface.point({1.2, v})).norm();
  };
  EXPECT_GT(moved(before.parameters[6]), 1e-5);
  // Rows of four sections each, functions of four spans each: three and more sections away nothing
  // moves by a bit.
  for (const std::size_t far : {0, 1, 2, 10, 11})
    EXPECT_EQ(moved(before.parameters[far]), 0) << far;
  const std::vector<double> none = {0, 1, 1};
  EXPECT_FALSE(make_skin(std::span(rows).first(3), Skinning::kInterpolate, none));
  EXPECT_FALSE(make_skin(rows, Skinning::kInterpolate, none));
  const auto global = must(make_skin(rows));
  EXPECT_LT(global.deviation, 1e-12);
}

PointGrid hills(int columns, int rows) {
  PointGrid grid{columns, rows, {}};
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double x = 10.0 * i / (columns - 1);
      const double y = 8.0 * j / (rows - 1);
      grid.points.emplace_back(x, y, std::sin(0.6 * x) * std::cos(0.5 * y));
    }
  }
  return grid;
}

TEST(InterpolateGrid, GoesThroughThePoints) {
  for (const auto& [columns, rows] : {std::pair(2, 2), {3, 2}, {9, 14}}) {
    for (const int degree : {1, 3, 5}) {
      const auto fitted = must(interpolate_grid(hills(columns, rows), degree));
      EXPECT_LT(fitted.deviation, 1e-12);
      EXPECT_EQ(fitted.surface.control_points().size(), static_cast<std::size_t>(columns * rows));
    }
  }
  auto bad = hills(4, 4);
  bad.points[5].x() = NAN;
  EXPECT_FALSE(interpolate_grid(bad));
  bad = hills(4, 4);
  bad.points.pop_back();
  EXPECT_FALSE(interpolate_grid(bad));
  EXPECT_FALSE(interpolate_grid(hills(4, 4), 0));
  EXPECT_FALSE(interpolate_grid({2, 2, std::vector<Vector3d>(4, Vector3d(1, 1, 1))}));
}

TEST(ApproximateGrid, NeedsFewPointsForASmoothShape) {
  const auto grid = hills(60, 50);
  for (const double tolerance : {0.1, 1e-3, 1e-5}) {
    const auto fitted = must(approximate_grid(grid, tolerance));
    EXPECT_LE(fitted.deviation, tolerance);
    EXPECT_LT(fitted.surface.control_points().size(), 1300U) << tolerance;
    EXPECT_LT((fitted.surface.point({0, 0}) - grid.points.front()).norm(), 1e-12);
    EXPECT_LT((fitted.surface.point({1, 1}) - grid.points.back()).norm(), 1e-12);
  }
  EXPECT_LT(must(approximate_grid(grid, 0.1)).surface.control_points().size(), 60U);
  EXPECT_FALSE(approximate_grid(grid, 0));
  EXPECT_FALSE(approximate_grid(grid, NAN));
}

}  // namespace
}  // namespace limn
