// Laws of the rasteriser, on random triangles, lines and cameras.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "modeler/view/raster/camera.hpp"
#include "modeler/view/raster/rasterizer.hpp"
#include "tests/support/for_all.hpp"

namespace limn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::for_all;
using test::Rng;

constexpr int kWidth = 90;
constexpr int kHeight = 70;
constexpr std::int32_t kMiddle = kSubsamples / 2;

struct Triangle {
  RasterVertex a, b, c;
};

std::int32_t coordinate(Rng& rng, double low, double high) {
  return static_cast<std::int32_t>(rng.integer(static_cast<std::int64_t>(low * kSubsamples),
                                               static_cast<std::int64_t>(high * kSubsamples)));
}

/// A corner; some exactly in a sample's centre, row or column, where ties are decided.
RasterVertex any_vertex(Rng& rng, double around_x, double around_y, double reach) {
  RasterVertex v;
  v.x = coordinate(rng, around_x - reach, around_x + reach);
  v.y = coordinate(rng, around_y - reach, around_y + reach);
  if (rng.chance(0.4)) v.x = v.x / kSubsamples * kSubsamples + kMiddle;
  if (rng.chance(0.4)) v.y = v.y / kSubsamples * kSubsamples + kMiddle;
  v.nearness = static_cast<float>(rng.uniform(0, 1));
  return v;
}

/// Small ones, ones as large as the raster, and ones as large as can be.
Triangle any_triangle(Rng& rng) {
  const double reaches[] = {0.8, 2, 7, 30, 200, 5e5};
  const double reach = reaches[rng.integer(0, 5)];
  const double x = rng.uniform(0, kWidth);
  const double y = rng.uniform(0, kHeight);
  return {any_vertex(rng, x, y, reach), any_vertex(rng, x, y, reach), any_vertex(rng, x, y, reach)};
}

RasterBand drawn(const std::vector<Triangle>& triangles) {
  RasterBand band(kWidth);
  band.restart(0, kHeight);
  std::uint32_t id = 0;
  for (const Triangle& t : triangles) band.draw_triangle(t.a, t.b, t.c, id++);
  return band;
}

std::vector<std::uint64_t> keys_of(const RasterBand& band) {
  std::vector<std::uint64_t> out;
  for (int y = band.first_row(); y < band.end_row(); ++y) {
    out.insert(out.end(), band.row(y).begin(), band.row(y).end());
  }
  return out;
}

/// The rule in another form, in exact arithmetic: a centre that is moved by an infinitely small
/// step to the right, and one infinitely smaller downwards, is strictly inside. So each term
/// decides where those before it are 0.
bool covers(const Triangle& t, int x, int y) {
  using Wide = std::int64_t;  // corners are at most 2^28 from the origin, products 2^58
  const auto side = [&](const RasterVertex& p, const RasterVertex& q) {
    const Wide dx = Wide{q.x} - p.x;
    const Wide dy = Wide{q.y} - p.y;
    const Wide at =
        dx * (Wide{y} * kSubsamples + kMiddle - p.y) - dy * (Wide{x} * kSubsamples + kMiddle - p.x);
    for (const Wide term : {at, -dy, dx}) {
      if (term != 0) return term > 0 ? 1 : -1;
    }
    return 0;
  };
  const int ab = side(t.a, t.b);
  return ab != 0 && ab == side(t.b, t.c) && ab == side(t.c, t.a);
}

TEST(RasterLaws, ATriangleCoversWhatExactArithmeticSays) {
  int covered = 0;
  for_all(3000, [&](Rng& rng) {
    const Triangle t = any_triangle(rng);
    const RasterBand band = drawn({t});
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool is_covered = RasterBand::id_of(band.row(y)[static_cast<std::size_t>(x)]) == 0;
        ASSERT_EQ(is_covered, covers(t, x, y)) << "(" << x << ", " << y << ")";
        covered += is_covered;
      }
    }
  });
  EXPECT_GT(covered, 3000);
}

TEST(RasterLaws, NearnessIsLinearOnATriangle) {
  // Floats, between values of at most 1; slivers as long as the raster's reach amplify none of it,
  // since weights are exact.
  constexpr double kFloatRounding = 4e-7;
  for_all(1000, [&](Rng& rng) {
    const Triangle t = any_triangle(rng);
    const RasterBand band = drawn({t});
    const auto area = [](double ax, double ay, double bx, double by, double cx, double cy) {
      return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    };
    const double whole = area(t.a.x, t.a.y, t.b.x, t.b.y, t.c.x, t.c.y);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::uint64_t key = band.row(y)[static_cast<std::size_t>(x)];
        if (RasterBand::id_of(key) != 0) continue;
        const double px = x * kSubsamples + kMiddle;
        const double py = y * kSubsamples + kMiddle;
        const double expected = (area(t.b.x, t.b.y, t.c.x, t.c.y, px, py) * t.a.nearness +
                                 area(t.c.x, t.c.y, t.a.x, t.a.y, px, py) * t.b.nearness +
                                 area(t.a.x, t.a.y, t.b.x, t.b.y, px, py) * t.c.nearness) /
                                whole;
        ASSERT_NEAR(RasterBand::nearness_of(key), expected, kFloatRounding);
      }
    }
  });
}

TEST(RasterLaws, TrianglesThatMeetCoverEachSampleOnce) {
  // A rectangle's net of triangles whose inner corners move at random.
  for_all(25, [](Rng& rng) {
    const int cells = static_cast<int>(rng.integer(1, 10));
    const std::int32_t left = coordinate(rng, -4, kWidth - 8);
    const std::int32_t top = coordinate(rng, -4, kHeight - 8);
    const std::int32_t step_x = coordinate(rng, 0.2, 12);
    const std::int32_t step_y = coordinate(rng, 0.2, 12);
    std::vector<RasterVertex> net;
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) {
        // Less than half a cell: no triangle turns over.
        const bool inner = i > 0 && j > 0 && i < cells && j < cells;
        const double x = (i + (inner ? rng.uniform(-0.2, 0.2) : 0)) * step_x + left;
        const double y = (j + (inner ? rng.uniform(-0.2, 0.2) : 0)) * step_y + top;
        net.push_back({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), 0.5F, 0});
      }
    }
    std::vector<int> times(kWidth * kHeight, 0);
    RasterBand band(kWidth);
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      band.restart(0, kHeight);
      band.draw_triangle(net[a], net[b], net[c], 0);
      const auto keys = keys_of(band);
      for (std::size_t i = 0; i < keys.size(); ++i) times[i] += keys[i] != 0;
    };
    const auto at = [&](int i, int j) { return static_cast<std::size_t>(i + (cells + 1) * j); };
    for (int j = 0; j < cells; ++j) {
      for (int i = 0; i < cells; ++i) {
        add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        add(at(i, j), at(i, j + 1), at(i + 1, j + 1));
      }
    }
    std::vector<int> expected;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto within = [cells](int sample, std::int32_t low, std::int32_t step) {
          const std::int32_t centre = sample * kSubsamples + kMiddle;
          return centre >= low && centre < low + cells * step;
        };
        expected.push_back(within(x, left, step_x) && within(y, top, step_y));
      }
    }
    EXPECT_EQ(times, expected);
  });
}

TEST(RasterLaws, NeitherOrderNorBandsNorTurnsChangeASample) {
  for_all(40, [](Rng& rng) {
    std::vector<Triangle> triangles;
    for (int i = 0; i < 50; ++i) triangles.push_back(any_triangle(rng));
    // Twice the same: the lower number stays.
    triangles.push_back(triangles.front());
    const auto expected = keys_of(drawn(triangles));

    std::vector<std::uint32_t> order(triangles.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), rng);
    RasterBand band(kWidth);
    std::vector<std::uint64_t> found;
    const int rows = static_cast<int>(rng.integer(1, kHeight));
    for (int first = 0; first < kHeight; first += rows) {
      band.restart(first, std::min(rows, kHeight - first));
      for (const std::uint32_t i : order) {
        band.draw_triangle(triangles[i].a, triangles[i].b, triangles[i].c, i);
      }
      const auto keys = keys_of(band);
      found.insert(found.end(), keys.begin(), keys.end());
    }
    EXPECT_EQ(found, expected);
  });
}

TEST(RasterLaws, ALineCoversWhatIsWithinItsRadius) {
  for_all(500, [](Rng& rng) {
    const auto place = [&rng] {
      return Vector2d(rng.uniform(-40, kWidth + 40), rng.uniform(-40, kHeight + 40));
    };
    const Vector2d a = place();
    const Vector2d b = rng.chance(0.2)   ? a
                       : rng.chance(0.2) ? Vector2d(place().x(), a.y())
                                         : place();
    LineOnRaster line;
    line.ends = {glm::dvec4(a.x(), a.y(), 0.5, 1), glm::dvec4(b.x(), b.y(), 0.5, 1)};
    line.radius = rng.uniform(0.2, 6);
    RasterBand band(kWidth);
    band.restart(0, kHeight);
    band.draw_line(line, 0);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const Vector2d p(x + 0.5, y + 0.5);
        const double length2 = (b - a).squaredNorm();
        const double t = length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
        const double distance = (a + t * (b - a) - p).norm();
        constexpr double kRounding = 1e-9;
        if (std::abs(distance - line.radius) < kRounding) continue;
        const bool is_covered = band.row(y)[static_cast<std::size_t>(x)] != 0;
        ASSERT_EQ(is_covered, distance < line.radius) << "(" << x << ", " << y << ")";
      }
    }
  });
}

TEST(RasterLaws, ATriangleThroughTheCameraCoversWhatRaysHit) {
  int covered = 0;
  int cut = 0;
  for_all(400, [&](Rng& rng) {
    const auto place = [&rng] {
      return Vector3d(rng.uniform(-50, 50), rng.uniform(-50, 50), rng.uniform(-50, 50));
    };
    const std::vector<Vector3d> corners = {place(), place(), place()};
    View view;
    view.eye = 0.3 * place();
    view.target = place();
    view.fov = rng.uniform(0.3, 2.5);
    const std::span<const Vector3d> sets[] = {corners};
    const auto camera = place_camera(view, sets, kWidth, kHeight);
    if (!camera) return;  // all behind it
    const glm::dmat4 matrix = camera->to_raster(kWidth, kHeight);
    const ClippedTriangle clipped =
        clip_triangle({to_raster(matrix, corners[0]), to_raster(matrix, corners[1]),
                       to_raster(matrix, corners[2])});
    RasterBand band(kWidth);
    band.restart(0, kHeight);
    for (std::size_t k = 2; k < clipped.count; ++k) {
      ASSERT_EQ(clipped.corners[k].outside, 0U);
      band.draw_triangle(clipped.corners[0], clipped.corners[k - 1], clipped.corners[k], 0);
    }
    cut += clipped.count > 3;
    const double size = camera->sample_size(1, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const Vector3d ray = (x + 0.5 - 0.5 * kWidth) * size * camera->right +
                             (0.5 * kHeight - y - 0.5) * size * camera->up - camera->back;
        // eye + s ray = a + u (b - a) + v (c - a), by Cramer's rule.
        const Vector3d e1 = corners[1] - corners[0];
        const Vector3d e2 = corners[2] - corners[0];
        const Vector3d from = camera->eye - corners[0];
        const double whole = ray.dot(e1.cross(e2));
        const double u = ray.dot(from.cross(e2)) / whole;
        const double v = ray.dot(e1.cross(from)) / whole;
        const double s = -from.dot(e1.cross(e2)) / whole;
        // Beside the edges the raster's corners decide, which are snapped.
        const double inside = std::min({u, v, 1 - u - v});
        constexpr double kEdge = 0.02;
        if (std::abs(inside) < kEdge || std::abs(s / camera->near - 1) < kEdge) continue;
        // Seen almost along its plane, a little of the raster is much of the triangle.
        if (std::abs(whole) / (ray.norm() * e1.cross(e2).norm()) < kEdge) continue;
        const bool is_hit = inside > 0 && s > camera->near;
        const std::uint64_t key = band.row(y)[static_cast<std::size_t>(x)];
        ASSERT_EQ(key != 0, is_hit) << "(" << x << ", " << y << ") " << inside << ' ' << s;
        covered += is_hit;
        // A hundredth: of a sample's slope, where the triangle is steep.
        if (is_hit) {
          ASSERT_NEAR(RasterBand::nearness_of(key), camera->nearness(s),
                      0.02 * camera->nearness(s) + 1e-6);
        }
      }
    }
  });
  EXPECT_GT(covered, 10'000);
  EXPECT_GT(cut, 50);
}

TEST(RasterLaws, ACameraShowsTheWholeModelAndTouchesTheMargin) {
  int touched = 0;
  for_all(300, [&](Rng& rng) {
    std::vector<Vector3d> points;
    const double size = std::pow(10, rng.uniform(-3, 4));
    const auto count = rng.integer(2, 30);
    for (std::int64_t i = 0; i < count; ++i) {
      points.emplace_back(size * Vector3d(rng.normal(), 0.2 * rng.normal(), 3 + rng.normal()));
    }
    View view;
    view.towards_eye = {rng.normal(), rng.normal(), rng.normal()};
    if (rng.chance(0.5)) view.fov = rng.uniform(0.1, 2);
    const int width = static_cast<int>(rng.integer(1, 2000));
    const int height = static_cast<int>(rng.integer(1, 2000));
    const std::span<const Vector3d> sets[] = {points};
    const Camera camera = place_camera(view, sets, width, height).value();
    const glm::dmat4 matrix = camera.to_raster(width, height);
    double least = 1;  // free part of the picture beside the model
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3d& p : points) {
      const glm::dvec4 at = to_raster(matrix, p);
      ASSERT_GT(at.w, 0);
      const double x = at.x / at.w / width;
      const double y = at.y / at.w / height;
      least = std::min({least, x, 1 - x, y, 1 - y});
      nearest = std::min(nearest, at.w);
      EXPECT_GE(at.z / at.w, 0);
      EXPECT_LE(at.z / at.w, 1);
    }
    constexpr double kMargin = 0.05;
    constexpr double kRounding = 1e-9;
    EXPECT_GE(least, kMargin - kRounding);
    // A wide angle would take the eye into the model: it stays before it.
    Eigen::AlignedBox3d box;
    for (const Vector3d& p : points) box.extend(p);
    const bool stands_off = camera.is_perspective && nearest < 0.1001 * box.diagonal().norm();
    EXPECT_LE(least, stands_off ? 0.5 : kMargin + kRounding);
    touched += !stands_off;
  });
  EXPECT_GT(touched, 150);
}

}  // namespace
}  // namespace limn
