#include "tests/peers/random_surfaces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/peers/known_surfaces.hpp"

namespace limn::peers {
namespace {

void expect_sound_knots(const std::vector<double>& knots, int degree, int count) {
  ASSERT_EQ(std::ssize(knots), count + degree + 1);
  EXPECT_TRUE(std::is_sorted(knots.begin(), knots.end()));
  std::map<double, int> multiplicity;
  for (const double knot : knots) ++multiplicity[knot];
  for (const auto& [knot, times] : multiplicity) {
    const bool is_end = knot == knots.front() || knot == knots.back();
    if (is_end) {
      EXPECT_EQ(times, degree + 1);
    } else {
      EXPECT_LE(times, degree);
    }
  }
}

void expect_sound(const PeerSurface& surface) {
  const auto count = static_cast<std::size_t>(surface.count[0] * surface.count[1]);
  for (std::size_t d = 0; d < 2; ++d)
    expect_sound_knots(surface.knots[d], surface.degree[d], surface.count[d]);
  EXPECT_EQ(surface.points.size(), 3 * count);
  if (!surface.weights.empty()) {
    EXPECT_EQ(surface.weights.size(), count);
    EXPECT_THAT(surface.weights, testing::Each(testing::Gt(0.0)));
  }
}

TEST(RandomSurfaces, AreSoundAndOfAllKinds) {
  test::Rng rng(7);
  std::set<int> degrees;
  std::set<bool> rational;
  int repeated = 0;
  for (int k = 0; k < 500; ++k) {
    const PeerSurface surface = random_surface(rng);
    expect_sound(surface);
    degrees.insert(surface.degree.begin(), surface.degree.end());
    rational.insert(!surface.weights.empty());
    const std::set<double> distinct(surface.knots[0].begin(), surface.knots[0].end());
    const auto interior = surface.count[0] - surface.degree[0] - 1;
    EXPECT_GE(distinct.size(), 3U);
    EXPECT_LE(distinct.size(), 10U);
    repeated += interior > std::ssize(distinct) - 2 ? 1 : 0;
  }
  EXPECT_EQ(degrees, (std::set{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(rational.size(), 2U);
  EXPECT_GT(repeated, 100);
}

TEST(RandomSurfaces, AreTheSameForTheSameSeed) {
  test::Rng a(11), b(11);
  EXPECT_EQ(random_surface(a).points, random_surface(b).points);
  EXPECT_EQ(random_crossing_pair(a).second.points, random_crossing_pair(b).second.points);
}

TEST(RandomSurfaces, AreRoundedOnRequest) {
  test::Rng rng(12);
  const PeerSurface surface = random_surface(rng, {.rational = 1.0, .decimals = 3});
  for (const auto* numbers : {&surface.points, &surface.weights, &surface.knots[0]})
    for (const double x : *numbers) EXPECT_NEAR(1e3 * x, std::round(1e3 * x), 1e-9);
}

TEST(RandomCurves, AreSound) {
  test::Rng rng(13);
  for (int k = 0; k < 200; ++k) {
    const PeerCurve curve = random_curve(rng, 2 + k % 2);
    expect_sound_knots(curve.knots, curve.degree, curve.count);
    EXPECT_EQ(std::ssize(curve.points), curve.dimension * curve.count);
  }
}

TEST(KnownSurfaces, AreSound) {
  for (const auto& surface :
       {wavy_sheet(13), wavy_sheet(103), paraboloid(), torus(5, 2), sphere(3)})
    expect_sound(surface);
  EXPECT_EQ(wavy_sheet(103).count, (std::array{103, 103}));
}

TEST(RandomCrossingPairs, AreSound) {
  test::Rng rng(14);
  for (int k = 0; k < 50; ++k) {
    const auto [first, second] = random_crossing_pair(rng);
    expect_sound(first);
    expect_sound(second);
  }
}

}  // namespace
}  // namespace limn::peers
