#include "firmware_sim/devices/portable_math.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace limn::firmware {
namespace {

constexpr double kDocumented = 1e-12;

TEST(PortableMath, SineAndCosineAgreeWithTheLibrary) {
  for (int i = -40000; i <= 40000; ++i) {
    const double x = 0.025 * i;  // to 1e3 either way
    ASSERT_NEAR(portable_sin(x), std::sin(x), kDocumented) << x;
    ASSERT_NEAR(portable_cos(x), std::cos(x), kDocumented) << x;
  }
  EXPECT_EQ(portable_sin(0), 0);
}

TEST(PortableMath, LogarithmAgreesWithTheLibrary) {
  for (int i = -1000; i <= 1000; ++i) {
    const double x = std::exp(0.69 * i);
    ASSERT_NEAR(portable_log(x), std::log(x), kDocumented) << x;
  }
  EXPECT_EQ(portable_log(1), 0);
}

TEST(PortableMath, CubeRootAgreesWithTheLibrary) {
  for (int i = -200; i <= 200; ++i) {
    const double x = std::exp(0.1036 * i);
    ASSERT_NEAR(portable_cbrt(x) / std::cbrt(x), 1, kDocumented) << x;
  }
  EXPECT_DOUBLE_EQ(portable_cbrt(8), 2);
}

}  // namespace
}  // namespace limn::firmware
