// Which meeting places are one touch, and how large it is.

#include <gtest/gtest.h>

#include <vector>

#include "modeler/surface/crossing_touches.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;

/// On a line: the place's first parameter is x.
MeetingPlace at(double x, double reach) {
  return {CrossingPlace(x, 0, 0, 0), Vector3d(x, 0, 0), reach};
}

TEST(Touches, OneIsolatedPlaceHasNoExtent) {
  const auto found = touches_of({at(1, 0), at(1 + 1e-9, 0), at(1 - 1e-9, 0)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].extent, 0);
  EXPECT_NEAR(found[0].point.x(), 1, 2e-9);
}

TEST(Touches, IsolatedPlacesStayApart) {
  const auto found = touches_of({at(0, 0), at(1e-3, 0), at(-5, 0)});
  ASSERT_EQ(found.size(), 3U);
  for (const SurfaceTouch& touch : found) EXPECT_EQ(touch.extent, 0);
}

TEST(Touches, AChainIsOne) {
  std::vector<MeetingPlace> places;
  for (int i = 0; i <= 100; ++i) places.push_back(at(37 * i % 101, 0.5));
  places.push_back(at(200, 0.5));
  const auto found = touches_of(places);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].extent, 101, 1e-9);
  EXPECT_NEAR(found[1].extent, 1, 1e-9);
}

/// A place that is isolated as far as its own parts tell may be the end of what others found.
TEST(Touches, AnIsolatedPlaceDoesNotHideTheRest) {
  const auto found = touches_of({at(0, 0.5), at(1, 0.5), at(2, 0.5), at(2.2, 0)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].extent, 2.2 + 1, 1e-9);
  EXPECT_EQ(found[0].on_first.x(), 2.2) << "which is known best";
}

}  // namespace
}  // namespace limn
