#include <gtest/gtest.h>

#include <cmath>

#include "drivers/hid/units.hpp"

namespace limn::hid {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kTight = 1e-12;  // relative to values near 1: a few roundings

Field field(Range logical, Range physical, std::uint32_t unit, int exponent) {
  Field made;
  made.logical = logical;
  made.physical = physical;
  made.unit = unit;
  made.unit_exponent = static_cast<std::int8_t>(exponent);
  return made;
}

TEST(HidUnits, KnowsTheUnitsOfPens) {
  EXPECT_EQ(quantity(0), Quantity::kNone);
  EXPECT_EQ(quantity(0x11), Quantity::kLength);
  EXPECT_EQ(quantity(0x13), Quantity::kLength);
  EXPECT_EQ(quantity(0x33), Quantity::kLength);
  EXPECT_EQ(quantity(0x12), Quantity::kAngle);
  EXPECT_EQ(quantity(0x14), Quantity::kAngle);
  EXPECT_EQ(quantity(0x1001), Quantity::kTime);
  EXPECT_EQ(quantity(0x1003), Quantity::kTime);
  EXPECT_EQ(quantity(0xE111), Quantity::kForce);
  EXPECT_EQ(quantity(0x1000), Quantity::kOther);  // seconds of no system
  EXPECT_EQ(quantity(0x31), Quantity::kOther);
  EXPECT_EQ(unit_name(0x11), "cm");
  EXPECT_EQ(unit_name(0x33), "inch");
  EXPECT_EQ(unit_name(0xF0D121), "unit 0xF0D121");
  EXPECT_EQ(unit_name(0), "");
}

TEST(HidUnits, PositionsInMillimeters) {
  // An Intuos Pro M: 44704 counts over 22352 * 10^-3 cm, 200 counts/mm or 5080 lpi.
  const Field cm = field({0, 44704}, {0, 22352}, 0x11, -3);
  EXPECT_NEAR((*position_map(cm))(44704), 223.52, 223.52 * kTight);
  EXPECT_NEAR(*counts_per_mm(cm), 200.0, 200 * kTight);
  EXPECT_NEAR(*resolution(cm), 2000.0, 2000 * kTight);
  // 8000 counts over 4 inch, as a good unit and as the malformed one.
  for (const std::uint32_t unit : {0x13U, 0x33U}) {
    const Field inch = field({0, 8000}, {0, 4000}, unit, -3);
    EXPECT_NEAR((*position_map(inch))(8000), 101.6, 101.6 * kTight);
    EXPECT_NEAR(*counts_per_mm(inch) * 25.4, 2000.0, 2000 * kTight);
  }
}

TEST(HidUnits, PositionsStartAtLogicalMinimum) {
  const Field offset = field({-100, 900}, {50, 150}, 0x11, -1);
  EXPECT_EQ((*position_map(offset))(-100), 0.0);
  EXPECT_NEAR((*position_map(offset))(900), 100.0, 100 * kTight);
  EXPECT_NEAR((*physical_map(offset, Quantity::kLength))(-100), 50.0, 50 * kTight);
}

TEST(HidUnits, AnEmptyPhysicalRangeMeansTheLogicalOne) {
  const Field bare = field({0, 15360}, {0, 0}, 0x13, -3);
  EXPECT_EQ(physical_range(bare), bare.logical);
  EXPECT_NEAR((*position_map(bare))(15360), 15.36 * 25.4, 400 * kTight);
  EXPECT_NEAR(*resolution(bare), 1000.0, 1000 * kTight);
}

TEST(HidUnits, NoMapWithoutUnitOrRange) {
  EXPECT_FALSE(position_map(field({0, 100}, {0, 100}, 0, 0)).has_value());
  EXPECT_FALSE(position_map(field({0, 100}, {0, 100}, 0x14, 0)).has_value());
  EXPECT_FALSE(position_map(field({0, 0}, {0, 100}, 0x11, 0)).has_value());
  EXPECT_FALSE(position_map(field({0, 100}, {5, 5}, 0x11, 0)).has_value());
  EXPECT_FALSE(position_map(field({100, 0}, {0, 5}, 0x11, 0)).has_value());
  EXPECT_FALSE(resolution(field({0, 100}, {0, 100}, 0, 0)).has_value());
  EXPECT_FALSE(counts_per_mm(field({0, 100}, {0, 100}, 0x1001, 0)).has_value());
}

TEST(HidUnits, AnglesInRadians) {
  const Field hundredths = field({-9000, 9000}, {-9000, 9000}, 0x14, -2);
  EXPECT_NEAR(angle_map(hundredths, false)(9000), kPi / 2, kTight);
  EXPECT_NEAR(angle_map(hundredths, false)(-4500), -kPi / 4, kTight);
  const Field radians = field({-60, 60}, {-10472, 10472}, 0x12, -4);
  EXPECT_NEAR(angle_map(radians, false)(60), 1.0472, kTight);
  const Field twist = field({-900, 899}, {-180, 179}, 0x14, 0);
  EXPECT_NEAR(angle_map(twist, true)(-900), -kPi, 4 * kTight);
  const Field turn = field({0, 36000}, {0, 36000}, 0x14, -2);
  EXPECT_NEAR(angle_map(turn, true)(36000), 2 * kPi, 8 * kTight);
}

TEST(HidUnits, AnUprightPenHasExactlyNoTilt) {
  for (const Field& tilt :
       {field({-9000, 9000}, {-9000, 9000}, 0x14, -2), field({-64, 63}, {-64, 63}, 0x14, 0),
        field({-60, 60}, {-10472, 10472}, 0x12, -4)}) {
    EXPECT_EQ(angle_map(tilt, false)(0), 0.0);
  }
  EXPECT_EQ(angle_map(field({0, 18000}, {-90, 90}, 0x14, 0), false)(9000), 0.0);
  // No count is exactly upright here.
  const Field askew = field({0, 255}, {-90, 90}, 0x14, 0);
  EXPECT_NEAR(angle_map(askew, false)(0), -kPi / 2, kTight);
  EXPECT_NEAR(angle_map(askew, false)(255), kPi / 2, kTight);
}

TEST(HidUnits, AnglesWithoutUnitAreDegreesTenthsOrHundredths) {
  const auto scale = [](std::int64_t extreme, bool full_turn) {
    return angle_map(field({-extreme, extreme}, {0, 0}, 0, 0), full_turn)(1) * 180 / kPi;
  };
  EXPECT_NEAR(scale(60, false), 1, kTight);
  EXPECT_NEAR(scale(90, false), 1, kTight);
  EXPECT_NEAR(scale(127, false), 1, kTight);
  EXPECT_NEAR(scale(900, false), 0.1, kTight);
  EXPECT_NEAR(scale(9000, false), 0.01, kTight);
  EXPECT_NEAR(scale(180, true), 1, kTight);
  EXPECT_NEAR(scale(360, true), 1, kTight);
  EXPECT_NEAR(scale(1800, true), 0.1, kTight);
  EXPECT_NEAR(scale(18000, true), 0.01, kTight);
  // Zero stays zero, also in ranges that lie askew.
  EXPECT_EQ(angle_map(field({-61, 60}, {-61, 60}, 0, 0), false)(0), 0.0);
}

TEST(HidUnits, UnusableAnglesFallBackToCounts) {
  // Left over from another field: inches; and hundredths declared without their exponent.
  for (const Field& stale :
       {field({-90, 90}, {0, 2048}, 0x33, -3), field({-9000, 9000}, {-9000, 9000}, 0x14, 0)}) {
    EXPECT_NEAR(angle_map(stale, false)(stale.logical.maximum), kPi / 2, kTight);
  }
}

TEST(HidUnits, ScanTimeIsInHundredMicroseconds) {
  EXPECT_NEAR(time_map(field({0, 65535}, {0, 65535}, 0x1001, -4))(10000), 1.0, kTight);
  EXPECT_NEAR(time_map(field({0, 65535}, {0, 0}, 0, 0))(10000), 1.0, kTight);
  EXPECT_NEAR(time_map(field({0, INT32_MAX}, {0, 1739}, 0x11, -2))(10000), 1.0, kTight);
  EXPECT_NEAR(time_map(field({0, 1000}, {0, 1000}, 0x1001, -3))(1000), 1.0, kTight);
}

TEST(HidUnits, ForceInNewtons) {
  const Field force = field({0, 1000}, {0, 1000}, 0xE111, 2);  // 1000 * 10^2 dyn
  EXPECT_NEAR((*physical_map(force, Quantity::kForce))(1000), 1.0, kTight);
}

TEST(HidUnits, UnitInterval) {
  const auto map = unit_interval_map(field({-10, 30}, {0, 0}, 0, 0));
  EXPECT_EQ(map(-10), 0.0);
  EXPECT_EQ(map(10), 0.5);
  EXPECT_EQ(map(30), 1.0);
  EXPECT_EQ(unit_interval_map(field({4, 4}, {0, 0}, 0, 0))(4), 0.0);  // no division by zero
}

TEST(HidUnits, ExtremeExponentsStayFinite) {
  for (const int exponent : {-128, 127}) {
    const Field extreme = field({INT32_MIN, INT32_MAX}, {INT32_MIN, INT32_MAX}, 0x13, exponent);
    const auto map = position_map(extreme);
    ASSERT_TRUE(map.has_value());
    EXPECT_TRUE(std::isfinite((*map)(INT32_MAX)));
    EXPECT_TRUE(std::isfinite(*counts_per_mm(extreme)));
  }
}

}  // namespace
}  // namespace limn::hid
