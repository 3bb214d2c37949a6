#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "modeler/bspline/knot_vector.hpp"

namespace limn {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

KnotVector must(Expected<KnotVector> made) {
  EXPECT_TRUE(made.has_value()) << (made ? "" : made.error().at + ": " + made.error().what);
  return made.value_or(KnotVector());
}

TEST(KnotVector, StartsAsOneConstantFunction) {
  const KnotVector knots;
  EXPECT_EQ(knots.degree(), 0);
  EXPECT_EQ(knots.basis_count(), 1);
  std::array<double, 1> value{};
  knots.basis(knots.find_span(0.3), 0.3, value);
  EXPECT_EQ(value[0], 1.0);
}

TEST(KnotVector, RefusesWhatIsNoKnotVector) {
  struct Case {
    const char* why;
    int degree;
    std::vector<double> values;
    Closure closure;
    ErrorCode code;
    const char* at;
  };
  const std::array<Case, 14> cases = {{
      {"degree below 0", -1, {0, 1}, Closure::kOpen, ErrorCode::kOutOfRange, "degree"},
      {"degree above 25", 26, {0, 1}, Closure::kOpen, ErrorCode::kOutOfRange, "degree"},
      {"periodic constant", 0, {0, 1}, Closure::kPeriodic, ErrorCode::kOutOfRange, "degree"},
      {"too few", 2, {0, 0, 0, 1, 1}, Closure::kOpen, ErrorCode::kPointCount, "knots"},
      {"none", 0, {}, Closure::kOpen, ErrorCode::kPointCount, "knots"},
      {"descending", 1, {0, 0, 2, 1, 3, 3}, Closure::kOpen, ErrorCode::kOutOfRange, "knot 3"},
      {"infinite", 1, {0, 0, 1, kInfinity}, Closure::kOpen, ErrorCode::kOutOfRange, "knot 3"},
      {"not a number", 1, {0, NAN, 1, 1}, Closure::kOpen, ErrorCode::kOutOfRange, "knot 1"},
      {"too close", 1, {0, 0, 1e-300, 1e-300}, Closure::kOpen, ErrorCode::kOutOfRange, "knot 2"},
      {"too multiple", 1, {0, 0, 1, 1, 1, 2, 2}, Closure::kOpen, ErrorCode::kOutOfRange, "knot 4"},
      {"span too wide", 0, {-1.5e308, 1.5e308}, Closure::kOpen, ErrorCode::kOutOfRange, "knot 1"},
      {"dead first", 1, {-1, 0, 0, 1, 2}, Closure::kOpen, ErrorCode::kOutOfRange, "knot 1"},
      {"dead last", 1, {0, 1, 2, 2, 3}, Closure::kOpen, ErrorCode::kOutOfRange, "knot 3"},
      {"not repeating", 1, {-1, 0, 1, 3, 4.5}, Closure::kPeriodic, ErrorCode::kNumeric, "knot 2"},
  }};
  for (const Case& c : cases) {
    const auto made = KnotVector::make(c.degree, c.values, c.closure);
    ASSERT_FALSE(made.has_value()) << c.why;
    EXPECT_EQ(made.error().code, c.code) << c.why;
    EXPECT_EQ(made.error().at, c.at) << c.why;
    EXPECT_FALSE(made.error().remedy.empty()) << c.why;
  }
}

TEST(KnotVector, PeriodicRefusesABreak) {
  // Multiplicity 2 in a periodic direction of degree 1 would tear the seam open.
  EXPECT_FALSE(KnotVector::make_periodic(1, std::array{0.0, 1.0, 1.0, 2.0}, 3.0).has_value());
  EXPECT_TRUE(KnotVector::make_periodic(2, std::array{0.0, 1.0, 1.0, 2.0}, 3.0).has_value());
}

TEST(KnotVector, FindsSpans) {
  const auto knots = must(KnotVector::make_clamped(2, 0, 3, std::array{1.0, 1.0, 2.0}));
  EXPECT_THAT(knots.values(), ElementsAre(0, 0, 0, 1, 1, 2, 3, 3, 3));
  EXPECT_EQ(knots.find_span(-5), 2);
  EXPECT_EQ(knots.find_span(0), 2);
  EXPECT_EQ(knots.find_span(0.999), 2);
  EXPECT_EQ(knots.find_span(1), 4) << "right-hand limit";
  EXPECT_EQ(knots.find_span(2), 5);
  EXPECT_EQ(knots.find_span(3), 5) << "left-hand limit at the end";
  EXPECT_EQ(knots.find_span(9), 5);
  EXPECT_EQ(knots.find_span(NAN), 5);
}

TEST(KnotVector, FindsTheLastSpanBeforeARepeatedEnd) {
  // Periodic with a corner at the seam: the domain's last value occurs before index n, too.
  const auto knots = must(KnotVector::make_periodic(3, std::array{0.0, 0.0, 0.0, 1.0}, 2.0));
  EXPECT_THAT(knots.values(), ElementsAre(-1, 0, 0, 0, 1, 2, 2, 2, 3, 4, 4));
  EXPECT_EQ(knots.domain_begin(), 0);
  EXPECT_EQ(knots.domain_end(), 2);
  EXPECT_EQ(knots.find_span(2), 4);
  EXPECT_EQ(knots.find_span(0), 3);
}

TEST(KnotVector, CountsMultiplicityAndBreakpoints) {
  const auto knots = must(KnotVector::make_clamped(3, -1, 4, std::array{0.5, 0.5, 2.0}));
  EXPECT_EQ(knots.basis_count(), 7);
  EXPECT_EQ(knots.multiplicity(-1), 4);
  EXPECT_EQ(knots.multiplicity(0.5), 2);
  EXPECT_EQ(knots.multiplicity(1), 0);
  EXPECT_THAT(knots.breakpoints(), ElementsAre(-1, 0.5, 2, 4));
}

TEST(KnotVector, GrevilleAbscissae) {
  const auto knots = must(KnotVector::make_clamped(2, 0, 4, std::array{1.0}));
  EXPECT_THAT(
      (std::array{knots.greville(0), knots.greville(1), knots.greville(2), knots.greville(3)}),
      ElementsAre(DoubleEq(0), DoubleEq(0.5), DoubleEq(2.5), DoubleEq(4)));
  EXPECT_EQ(KnotVector().greville(0), 0.5);
}

TEST(KnotVector, ClampsOrWraps) {
  const auto open = must(KnotVector::make_clamped(1, 2, 5));
  EXPECT_EQ(open.clamp(1), 2);
  EXPECT_EQ(open.clamp(7), 5);
  const auto periodic = must(KnotVector::make_periodic(2, std::array{2.0, 3.0, 4.0}, 5.0));
  EXPECT_EQ(periodic.clamp(5), 5) << "the end itself keeps its left-hand limit";
  EXPECT_DOUBLE_EQ(periodic.clamp(5.5), 2.5);
  EXPECT_DOUBLE_EQ(periodic.clamp(1.5), 4.5);
  EXPECT_DOUBLE_EQ(periodic.clamp(-7.5), 4.5);
}

TEST(KnotVector, BasisOfACubicIsBernsteinsOnOneSpan) {
  const auto knots = must(KnotVector::make_clamped(3, 0, 1));
  std::array<double, 4> value{};
  knots.basis(3, 0.25, value);
  EXPECT_THAT(value, ElementsAre(DoubleEq(27.0 / 64), DoubleEq(27.0 / 64), DoubleEq(9.0 / 64),
                                 DoubleEq(1.0 / 64)));
}

TEST(KnotVector, DerivativesAboveTheDegreeVanish) {
  const auto knots = must(KnotVector::make_clamped(2, 0, 2, std::array{1.0}));
  std::array<double, 15> out;
  out.fill(7);
  knots.basis_derivatives(knots.find_span(0.5), 0.5, 4, out);
  EXPECT_THAT((std::span(out).subspan(9)), testing::Each(0.0));
  // N'' of the first quadratic on knots 0 0 0 1: (1 - u)^2 has 2.
  EXPECT_DOUBLE_EQ(out[6], 2.0);
}

TEST(KnotVector, RotatesAPeriodicVector) {
  const auto knots = must(KnotVector::make_periodic(2, std::array{0.0, 1.0, 3.0, 6.0}, 10.0));
  const auto rotated = must(knots.rotated(2));
  EXPECT_EQ(rotated.domain_begin(), 3);
  EXPECT_EQ(rotated.domain_end(), 13);
  EXPECT_THAT(rotated.breakpoints(), ElementsAre(3, 6, 10, 11, 13));
  EXPECT_EQ(must(knots.rotated(0)), knots);
}

TEST(KnotVector, SmallPeriodsWrapMoreThanOnce) {
  // One span a round: every function is the constant's share, and they still sum to 1.
  const auto knots = must(KnotVector::make_periodic(3, std::array{0.0}, 1.0));
  EXPECT_EQ(knots.basis_count(), 4);
  std::array<double, 4> value{};
  knots.basis(knots.find_span(0.4), 0.4, value);
  EXPECT_DOUBLE_EQ(std::accumulate(value.begin(), value.end(), 0.0), 1.0);
}

}  // namespace
}  // namespace limn
