#include "input/sample/tilt.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace limn {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kExact = 4e-16;  // two roundings of an angle near 1

TEST(Tilt, PointsWhereTheAzimuthSays) {
  const Tilt right = tilt_from_altitude_azimuth(60, 0);
  EXPECT_NEAR(right.x_rad, kPi / 6, kExact);
  EXPECT_EQ(right.y_rad, 0);
  const Tilt towards_user = tilt_from_altitude_azimuth(60, 90);
  EXPECT_EQ(towards_user.x_rad, 0);
  EXPECT_NEAR(towards_user.y_rad, kPi / 6, kExact);
  const Tilt left = tilt_from_altitude_azimuth(60, 180);
  EXPECT_NEAR(left.x_rad, -kPi / 6, kExact);
  EXPECT_EQ(left.y_rad, 0);
  const Tilt away = tilt_from_altitude_azimuth(60, 270);
  EXPECT_EQ(away.x_rad, 0);
  EXPECT_NEAR(away.y_rad, -kPi / 6, kExact);
}

TEST(Tilt, IsZeroUprightAndBeyond) {
  for (const double altitude : {90.0, 91.0, 209.0}) {
    const Tilt tilt = tilt_from_altitude_azimuth(altitude, 33);
    EXPECT_EQ(tilt.x_rad, 0) << altitude;
    EXPECT_EQ(tilt.y_rad, 0) << altitude;
  }
}

TEST(Tilt, IsARightAngleFlatAndBelow) {
  for (const double altitude : {0.0, -5.0}) {
    const Tilt tilt = tilt_from_altitude_azimuth(altitude, -90);
    EXPECT_EQ(tilt.x_rad, 0) << altitude;
    EXPECT_EQ(tilt.y_rad, -kPi / 2) << altitude;
  }
}

TEST(Tilt, AgreesWithTheMathematicalLibraryAllOver) {
  constexpr double kRounding = 2e-13;  // of the angles in radians, over sin(altitude) >= 0.02
  for (double altitude = 1.25; altitude < 90; altitude += 1.25) {
    for (double azimuth = -725; azimuth < 725; azimuth += 3.75) {
      const double tangent = std::tan(altitude * kPi / 180);
      const double x = std::atan(std::cos(azimuth * kPi / 180) / tangent);
      const double y = std::atan(std::sin(azimuth * kPi / 180) / tangent);
      const Tilt tilt = tilt_from_altitude_azimuth(altitude, azimuth);
      ASSERT_NEAR(tilt.x_rad, x, kRounding) << altitude << ' ' << azimuth;
      ASSERT_NEAR(tilt.y_rad, y, kRounding) << altitude << ' ' << azimuth;
    }
  }
}

TEST(Tilt, IsFiniteForTheLargestAngles) {
  const Tilt tilt = tilt_from_altitude_azimuth(45, 1.7976931348623157e308);
  EXPECT_LE(std::hypot(std::tan(tilt.x_rad), std::tan(tilt.y_rad)), 1 + kExact * 4);
}

}  // namespace
}  // namespace limn
