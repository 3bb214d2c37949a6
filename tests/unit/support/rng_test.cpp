#include "tests/support/rng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace limn::test {
namespace {

TEST(Rng, GivesThePublishedSequenceOfSplitMix64) {
  // First outputs for seed 1234567 of the reference implementation (Vigna, splitmix64.c).
  Rng rng(1234567);
  EXPECT_EQ(rng(), 6457827717110365317U);
  EXPECT_EQ(rng(), 3203168211198807973U);
  EXPECT_EQ(rng(), 9817491932198370423U);
}

TEST(Rng, StaysInsideItsRanges) {
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const double u = rng.uniform(-2.0, 3.0);
    EXPECT_GE(u, -2.0);
    EXPECT_LT(u, 3.0);
    const auto n = rng.integer(-1, 1);
    EXPECT_GE(n, -1);
    EXPECT_LE(n, 1);
  }
  EXPECT_EQ(rng.integer(7, 7), 7);
  constexpr auto kLow = std::numeric_limits<std::int64_t>::min();
  constexpr auto kHigh = std::numeric_limits<std::int64_t>::max();
  EXPECT_NE(rng.integer(kLow, kHigh), rng.integer(kLow, kHigh));
}

TEST(Rng, HasTheMomentsOfItsDistributions) {
  constexpr int kDraws = 20'000;
  constexpr double kTolerance = 0.05;  // more than six standard errors of every mean below
  Rng rng(2);
  double uniform = 0;
  double normal = 0;
  double square = 0;
  int heads = 0;
  for (int i = 0; i < kDraws; ++i) {
    uniform += rng.uniform(0.0, 1.0);
    const double z = rng.normal();
    normal += z;
    square += z * z;
    heads += rng.chance(0.3) ? 1 : 0;
  }
  EXPECT_NEAR(uniform / kDraws, 0.5, kTolerance);
  EXPECT_NEAR(normal / kDraws, 0.0, kTolerance);
  EXPECT_NEAR(std::sqrt(square / kDraws), 1.0, kTolerance);
  EXPECT_NEAR(static_cast<double>(heads) / kDraws, 0.3, kTolerance);
}

TEST(Rng, FillsBytes) {
  Rng rng(3);
  const auto bytes = rng.bytes(64);
  ASSERT_EQ(bytes.size(), 64U);
  EXPECT_NE(bytes, rng.bytes(64));
}

}  // namespace
}  // namespace limn::test
