#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "modeler/bspline/control_point_map.hpp"

namespace limn {
namespace {

using testing::ElementsAre;

TEST(ControlPointMap, MapsLayersOfDoubles) {
  // Midpoints of neighbours, of two doubles each.
  const ControlPointMap midpoints(3, 2, {0, 1}, {0.5, 0.5, 0.5, 0.5});
  const std::vector<double> in = {0, 100, 2, 200, 6, 400};
  std::vector<double> out(4);
  map_layers(midpoints, 2, std::array<const double*, 1>{in.data()}, out.data());
  EXPECT_THAT(out, ElementsAre(1, 150, 4, 300));
}

TEST(ControlPointMap, ComposesLikeApplyingInTurn) {
  const ControlPointMap inner(4, 2, {0, 1, 2}, {0.5, 0.5, 0.25, 0.75, 1, 0});
  const ControlPointMap outer(3, 2, {0, 1}, {2, -1, 0.5, 0.5});
  const std::vector<double> in = {1, 4, 9, 16};
  std::vector<double> middle(3);
  std::vector<double> twice(2);
  std::vector<double> once(2);
  map_layers(inner, 1, std::array<const double*, 1>{in.data()}, middle.data());
  map_layers(outer, 1, std::array<const double*, 1>{middle.data()}, twice.data());
  const ControlPointMap both = compose(outer, inner);
  EXPECT_EQ(both.rows(), 2);
  EXPECT_EQ(both.columns(), 4);
  EXPECT_EQ(both.width(), 3) << "the union of two neighbouring rows, no more";
  map_layers(both, 1, std::array<const double*, 1>{in.data()}, once.data());
  EXPECT_EQ(once, twice);
}

TEST(KnotInsertion, HalvesABezierSpan) {
  const auto knots = KnotVector::make_clamped(2, 0, 1);
  const auto refinement = insert_knots(*knots, std::array{0.5});
  ASSERT_TRUE(refinement.has_value());
  EXPECT_THAT(refinement->knots.values(), ElementsAre(0, 0, 0, 0.5, 1, 1, 1));
  EXPECT_THAT(refinement->map.row(0), ElementsAre(1, 0, 0));
  EXPECT_THAT(refinement->map.row(1), ElementsAre(0.5, 0.5, 0));
  EXPECT_THAT(refinement->map.row(2), ElementsAre(0, 0.5, 0.5));
  EXPECT_THAT(refinement->map.row(3), ElementsAre(0, 0, 1));
}

TEST(KnotInsertion, NamesWhatItRefuses) {
  const auto knots = KnotVector::make_clamped(2, 0, 1);
  const auto outside = insert_knots(*knots, std::array{0.5, 1.5});
  ASSERT_FALSE(outside.has_value());
  EXPECT_EQ(outside.error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(outside.error().at, "added knot 1");
  const auto too_often = insert_knots(*knots, std::array{0.5, 0.5, 0.5, 0.5});
  ASSERT_FALSE(too_often.has_value());
  EXPECT_EQ(too_often.error().code, ErrorCode::kOutOfRange);
  const auto not_a_number = insert_knots(*knots, std::array{0.0 / 0.0});
  EXPECT_FALSE(not_a_number.has_value());
}

TEST(KnotInsertion, KeepsAPeriodicVectorPeriodic) {
  const auto knots = KnotVector::make_periodic(2, std::array{0.0, 1.0, 2.0, 3.0}, 4.0);
  const auto refinement = insert_knots(*knots, std::array{4.0, 0.5});
  ASSERT_TRUE(refinement.has_value());
  EXPECT_TRUE(refinement->knots.is_periodic());
  EXPECT_THAT(refinement->knots.breakpoints(), ElementsAre(0, 0.5, 1, 2, 3, 4));
  EXPECT_EQ(refinement->knots.multiplicity(0), 2) << "4 is 0, a period on";
}

TEST(DegreeElevation, GivesTheClassicalPoints) {
  const auto knots = KnotVector::make_clamped(1, 0, 1);
  const auto refinement = elevate_degree(*knots, 1);
  ASSERT_TRUE(refinement.has_value());
  EXPECT_THAT(refinement->knots.values(), ElementsAre(0, 0, 0, 1, 1, 1));
  EXPECT_THAT(refinement->map.row(1), ElementsAre(0.5, 0.5));
}

TEST(DegreeElevation, KeepsContinuity) {
  const auto knots = KnotVector::make_clamped(3, 0, 3, std::array{1.0, 2.0, 2.0});
  const auto refinement = elevate_degree(*knots, 2);
  ASSERT_TRUE(refinement.has_value());
  EXPECT_EQ(refinement->knots.degree(), 5);
  EXPECT_EQ(refinement->knots.multiplicity(1), 3);
  EXPECT_EQ(refinement->knots.multiplicity(2), 4);
}

TEST(DegreeElevation, RefusesWhatIsTooHigh) {
  const auto knots = KnotVector::make_clamped(24, 0, 1);
  EXPECT_TRUE(elevate_degree(*knots, 1).has_value());
  for (const int by : {2, -1, 1 << 30}) {
    const auto refused = elevate_degree(*knots, by);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, ErrorCode::kOutOfRange);
  }
}

}  // namespace
}  // namespace limn
