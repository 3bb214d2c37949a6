#include <gtest/gtest.h>

#include "drivers/hid/usages.hpp"

namespace limn::hid {
namespace {

TEST(HidUsages, StandardTwinsOfVendorUsages) {
  EXPECT_EQ(standard_usage({0xFF0D, 0x42}), usage::kTipSwitch);
  EXPECT_EQ(standard_usage({0xFF0D, 0x130}), usage::kX);
  EXPECT_EQ(standard_usage({0xFF0D, 0x131}), usage::kY);
  EXPECT_EQ(standard_usage({0xFF11, 0x30}), usage::kTipPressure);
  EXPECT_EQ(standard_usage({0xFF09, 0x02}), usage::kPen);
  EXPECT_EQ(standard_usage({0xFF11, 0x11}), usage::kTouchScreen);
  for (const Usage own :
       {usage::kWacomSense, usage::kWacomSerialHigh, usage::kWacomToolType, usage::kWacomDistance,
        usage::kWacomSequenceNumber, usage::kX, Usage{0xFF00, 0x42}, Usage{0xFF0D, 0x1013}}) {
    EXPECT_EQ(standard_usage(own), own) << usage_name(own);
  }
}

TEST(HidUsages, Names) {
  EXPECT_EQ(usage_name(usage::kTipPressure), "Tip Pressure");
  EXPECT_EQ(usage_name(usage::kX), "X");
  EXPECT_EQ(usage_name({page::kButton, 3}), "Button 3");
  EXPECT_EQ(usage_name(usage::kWacomToolType), "Wacom Tool Type");
  EXPECT_EQ(usage_name({0xFF11, 0x42}), "Wacom Tip Switch");
  EXPECT_EQ(usage_name({0xFF12, 0xAB}), "0xFF12:00AB");
  EXPECT_EQ(page_name(page::kDigitizer), "Digitizer");
  EXPECT_EQ(page_name(0x9999), "");
}

TEST(HidUsages, TouchApplicationsCountOnVendorPagesToo) {
  EXPECT_TRUE(is_touch_application(usage::kTouchScreen));
  EXPECT_TRUE(is_touch_application(usage::kTouchPad));
  EXPECT_TRUE(is_touch_application(usage::kMultiplePointDigitizer));
  EXPECT_TRUE(is_touch_application({page::kWacomG11, 0x11}));
  EXPECT_FALSE(is_touch_application(usage::kPen));
  EXPECT_FALSE(is_touch_application(usage::kMouse));
}

}  // namespace
}  // namespace limn::hid
