// The program that a small device embeds, fed by a simulated pen through a socket.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <sstream>
#include <string>

#include "firmware_sim/devices/hid_pen.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/temp_folder.hpp"

namespace limn::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Standard output of `limn-input -` that is given these messages.
std::string output_for(const std::vector<std::vector<std::uint8_t>>& messages) {
  const TempFolder folder;
  const std::string out = (folder.path() / "out").string();
  int ends[2];
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[1], STDIN_FILENO);
    if (std::freopen(out.c_str(), "w", stdout) == nullptr) ::_exit(126);
    ::execl(LIMN_INPUT_BINARY, "limn-input", "-", static_cast<char*>(nullptr));
    ::_exit(127);
  }
  ::close(ends[1]);
  for (const auto& message : messages) {
    EXPECT_EQ(::write(ends[0], message.data(), message.size()),
              static_cast<ssize_t>(message.size()));
  }
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  return read_file(out);
}

TEST(LimnInput, PrintsSamplesAndStrokesOfAPenOnASocket) {
  using firmware::HidPen;
  const auto descriptor = HidPen::report_descriptor();
  std::vector<std::vector<std::uint8_t>> messages = {{descriptor.begin(), descriptor.end()}};
  HidPen pen;
  constexpr int kReports = 20;
  constexpr int kTouching = 12;  // the first ones
  for (int i = 0; i < kReports; ++i) {
    firmware::PenPose pose;
    pose.time = HidPen::kReportPeriod * i;
    pose.proximity =
        i < kTouching ? firmware::Proximity::kTouching : firmware::Proximity::kHovering;
    pose.x_mm = 50 + i;
    pose.y_mm = 40;
    pose.pressure = i < kTouching ? 0.5 : 0;
    std::array<std::uint8_t, HidPen::kReportBytes> report{};
    ASSERT_TRUE(pen.scan(pose, report));
    messages.emplace_back(report.begin(), report.end());
  }
  const std::string text = output_for(messages);
  // The pen lands without having hovered: it is in range first all the same.
  EXPECT_THAT(text, StartsWith("0.000000 0 in_range 50."));
  EXPECT_THAT(text, HasSubstr("\n0.000000 0 in_contact 50."));
  EXPECT_THAT(text, HasSubstr(" 0 in_range 69."));
  EXPECT_THAT(text, HasSubstr("\nstroke of 12 samples\n"));
}

}  // namespace
}  // namespace limn::test
