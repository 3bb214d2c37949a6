// What is listed in a build that has no hidapi.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "drivers/transport/device_listing.hpp"
#include "tests/support/temp_folder.hpp"

namespace limn::test {
namespace {

TEST(ListDevicesWithoutHidapi, HasWhatNeedsNone) {
  const auto hid = list_hid_devices();
  ASSERT_FALSE(hid.has_value());
  EXPECT_EQ(hid.error().code, ErrorCode::kMissing);
  const TempFolder folder;
  const std::string socket = folder.write("spnav.sock", "").string();
  ::setenv("SPNAV_SOCKET", socket.c_str(), 1);
  const auto listed = list_devices();
  ::unsetenv("SPNAV_SOCKET");
  ASSERT_TRUE(listed.has_value()) << listed.error().what;
  const auto found = std::find_if(listed->begin(), listed->end(),
                                  [&](const ListedDevice& one) { return one.node == socket; });
  ASSERT_NE(found, listed->end());
  EXPECT_EQ(found->backend, Backend::kSpnav);
}

}  // namespace
}  // namespace limn::test
