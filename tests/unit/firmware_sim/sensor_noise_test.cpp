#include "firmware_sim/devices/sensor_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace limn::firmware {
namespace {

TEST(SensorNoise, HasTheMomentsOfTheNormalDistribution) {
  constexpr int kCount = 200000;
  SensorNoise noise(1);
  double sum = 0, squares = 0, fourth = 0, products = 0, previous = 0;
  int beyond_two = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = noise.next();
    sum += x;
    squares += x * x;
    fourth += x * x * x * x;
    products += x * previous;
    beyond_two += std::abs(x) > 2 ? 1 : 0;
    previous = x;
  }
  // Five standard errors each.
  const double root = std::sqrt(static_cast<double>(kCount));
  EXPECT_NEAR(sum / kCount, 0, 5 / root);
  EXPECT_NEAR(squares / kCount, 1, 5 * std::sqrt(2.0) / root);
  EXPECT_NEAR(fourth / kCount, 3, 5 * std::sqrt(96.0) / root);
  EXPECT_NEAR(products / kCount, 0, 5 / root);
  EXPECT_NEAR(static_cast<double>(beyond_two) / kCount, 0.0455, 5 * std::sqrt(0.0455) / root);
}

TEST(SensorNoise, IsTheSameForASeedAndDifferentForAnother) {
  SensorNoise a(7), b(7), c(8);
  int equal = 0;
  for (int i = 0; i < 100; ++i) {
    const double x = a.next();
    EXPECT_EQ(x, b.next());
    equal += x == c.next() ? 1 : 0;
  }
  EXPECT_EQ(equal, 0);
}

}  // namespace
}  // namespace limn::firmware
