// `limn spnav-server` before Debian's libspnav, and before those who use it wrongly.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>  // SIGINT, SIGTERM
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/run_limn.hpp"
#include "tests/cli/running_limn.hpp"
#include "tests/support/spacenavd_rule.hpp"

#define SPNAV_CONFIG_H_
#include <spnav.h>

namespace limn::test {
namespace {

using testing::HasSubstr;

/// The reports of a hid-recorder file.
std::vector<MouseReport> reports_of(const std::string& path) {
  std::vector<MouseReport> reports;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    MouseReport report;
    unsigned size = 0;
    int read = 0;
    if (std::sscanf(line.c_str(), "E: %lf %u%n", &report.seconds, &size, &read) != 2) continue;
    std::istringstream words(line.substr(static_cast<std::size_t>(read)));
    for (std::string word; words >> word;) {
      report.bytes.push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
    }
    reports.push_back(std::move(report));
  }
  return reports;
}

/// A running `limn spnav-server`, and the first line that it says.
struct Serving {
  Serving(std::vector<std::string> arguments, const std::string& socket)
      : limn(with_socket(std::move(arguments), socket)), told(limn.line()) {}

  static std::vector<std::string> with_socket(std::vector<std::string> arguments,
                                              const std::string& socket) {
    arguments.insert(arguments.begin(), {"spnav-server", "--socket", socket});
    return arguments;
  }

  RunningLimn limn;
  std::string told;
};

class SpnavServerCommand : public testing::Test {
 protected:
  SpnavServerCommand() { ::setenv("SPNAV_SOCKET", socket_.c_str(), 1); }
  ~SpnavServerCommand() override {
    spnav_close();
    ::unsetenv("SPNAV_SOCKET");
  }
  void simulate(const std::string& motion) const {
    const CommandRun made =
        run_limn({"simulate", "spacenavigator", "--motion", motion, "-o", trace_});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }

  TempFolder folder_;
  std::string trace_ = (folder_.path() / "nav.hid").string();
  std::string socket_ = (folder_.path() / "spnav.sock").string();
};

/// All that comes until the server ends.
std::vector<SpnavTold> read_all() {
  std::vector<SpnavTold> events;
  spnav_event event{};
  while (spnav_wait_event(&event) != 0) {
    if (event.type == SPNAV_EVENT_MOTION) {
      const auto& m = event.motion;
      events.push_back({'m', {m.x, m.y, m.z, m.rx, m.ry, m.rz}, static_cast<int>(m.period)});
    } else if (event.type == SPNAV_EVENT_BUTTON) {
      events.push_back({event.button.press != 0 ? 'p' : 'r', {event.button.bnum}, 0});
    }
  }
  return events;
}

/// Its axes are called relative; limn has every report.
constexpr SpacenavdView kSpaceNavigator{.relative = true, .by_event_node = false};

bool within_one(const std::array<int, 6>& a, const std::array<int, 6>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::abs(a[i] - b[i]) > 1) return false;
  }
  return true;
}

TEST_F(SpnavServerCommand, GivesLibspnavWhatSpacenavdGives) {
  for (const char* motion : {"push", "twist", "orbit"}) {
    SCOPED_TRACE(motion);
    simulate(motion);
    const std::vector<SpnavTold> expected = by_spacenavd(reports_of(trace_), kSpaceNavigator);
    ASSERT_GT(expected.size(), 100U);
    Serving serving({"--replay", trace_}, socket_);
    EXPECT_THAT(serving.told, HasSubstr("listening on " + socket_));
    EXPECT_THAT(serving.told, HasSubstr("SPNAV_SOCKET=" + socket_));
    ASSERT_EQ(spnav_open(), 0);
    EXPECT_EQ(spnav_protocol(), 1);
    const std::vector<SpnavTold> got = read_all();
    spnav_close();
    EXPECT_EQ(serving.limn.end(0), 0);

    // Where this process slept, motions became one: with the newest deflection and all the time.
    EXPECT_GT(got.size(), expected.size() / 2);
    std::size_t next = 0;
    for (const SpnavTold& event : got) {
      int period = 0;
      bool found = false;
      while (!found && next < expected.size()) {
        const SpnavTold& one = expected[next++];
        period += one.period_ms;
        found = one.kind == event.kind && within_one(one.axes, event.axes) &&
                (event.kind != 'm' || period == event.period_ms);
        ASSERT_TRUE(found || one.kind == 'm') << "no button is left out";
      }
      ASSERT_TRUE(found) << event.kind << testing::PrintToString(event.axes) << event.period_ms;
    }
    EXPECT_EQ(next, expected.size()) << "the last one came";
    EXPECT_FALSE(std::filesystem::exists(socket_));
  }
}

TEST_F(SpnavServerCommand, TakesOptionsOf3dMice) {
  simulate("push");
  Serving serving({"--replay", trace_, "--sensitivity", "0,0,0,0,0,0", "--speed", "20"}, socket_);
  ASSERT_EQ(spnav_open(), 0);
  for (const SpnavTold& event : read_all()) EXPECT_NE(event.kind, 'm');
  EXPECT_EQ(serving.limn.end(0), 0);
}

TEST_F(SpnavServerCommand, ASignalTakesTheSocketAway) {
  simulate("push");
  for (const int signal : {SIGINT, SIGTERM}) {
    Serving serving({"--replay", trace_}, socket_);
    EXPECT_TRUE(std::filesystem::is_socket(socket_));
    EXPECT_EQ(serving.limn.end(signal), 128 + signal);
    EXPECT_FALSE(std::filesystem::exists(socket_));
  }
}

TEST_F(SpnavServerCommand, ASignalAmidAReplayTellsRestAndReleases) {
  std::ofstream(trace_) << "D: 0\nN: SpaceNavigator\nI: 3 046d c626\n"
                           "E: 0.000000 3 03 01 00\n"
                           "E: 0.010000 7 01 5e 01 00 00 00 00\n"
                           "E: 0.020000 7 01 5e 01 00 00 00 00\n"
                           "E: 600.000000 3 03 00 00\n";
  Serving serving({"--replay", trace_}, socket_);
  ASSERT_EQ(spnav_open(), 0);
  spnav_event event{};
  bool pressed = false;
  while (!pressed || event.type != SPNAV_EVENT_MOTION) {
    ASSERT_NE(spnav_wait_event(&event), 0);
    pressed |= event.type == SPNAV_EVENT_BUTTON && event.button.press != 0;
  }
  ASSERT_GT(event.motion.x, 400);
  EXPECT_EQ(serving.limn.end(SIGINT), 0);
  const std::vector<SpnavTold> rest = read_all();
  ASSERT_GE(rest.size(), 2U);
  EXPECT_EQ(rest[rest.size() - 2].kind, 'm');
  EXPECT_EQ(rest[rest.size() - 2].axes, (std::array<int, 6>{}));
  EXPECT_EQ(rest.back().kind, 'r');
}

TEST_F(SpnavServerCommand, ARecordingWithout3dMouseIsAnError) {
  const CommandRun made = run_limn({"simulate", "pen", "--drawing", "star", "-o", trace_});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  Serving serving({"--replay", trace_, "--speed", "1000"}, socket_);
  ASSERT_EQ(spnav_open(), 0);
  EXPECT_THAT(read_all(), testing::IsEmpty());
  EXPECT_THAT(serving.limn.line(), HasSubstr(" samples"));
  EXPECT_THAT(serving.limn.line(), HasSubstr("holds no 3D mouse; give a recording of a 3D mouse"));
  EXPECT_EQ(serving.limn.end(0), 1);
}

TEST_F(SpnavServerCommand, AFileOfSpacenavdsIsNoMouse) {
  std::ofstream(folder_.path() / "stale.sock") << "";
  ::setenv("SPNAV_SOCKET", (folder_.path() / "stale.sock").c_str(), 1);
  // Ids that no device has: it waits, and does not say that spacenavd has it.
  Serving serving({"ffff:ffff"}, socket_);
  if (serving.told.find("waited for") == std::string::npos) {
    EXPECT_THAT(serving.told, HasSubstr("no device ffff:ffff is here; plug it in")) << "no udev";
    return;
  }
  EXPECT_EQ(serving.told, "limn: no device ffff:ffff is here yet; it is waited for\n");
  EXPECT_THAT(serving.limn.line(), HasSubstr("listening on " + socket_));
  EXPECT_EQ(serving.limn.end(SIGTERM), 0);
}

TEST_F(SpnavServerCommand, LeavesAnotherServersSocketAlone) {
  simulate("push");
  Serving serving({"--replay", trace_}, socket_);
  const CommandRun second = run_limn({"spnav-server", "--replay", trace_, "--socket", socket_});
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_EQ(second.err, "limn: " + socket_ +
                            ": another server (spacenavd?) answers there; stop it, or name another "
                            "place by --socket PATH\n");
  EXPECT_EQ(spnav_open(), 0);
}

/// limn's words as somebody's who may not write to /run, and the folder a place where he may.
class NotRoot {
 public:
  explicit NotRoot(const std::filesystem::path& folder) {
    if (::access("/run", W_OK) != 0) return;
    std::filesystem::permissions(folder, std::filesystem::perms::all);
    before_ = "setpriv --reuid=65534 --regid=65534 --clear-groups ";
  }
  /// "" or what he is kept from.
  std::string trouble() const {
    const CommandRun run = run_shell(before_ + "test -x \"$0\" && ! " + before_ + "test -w /run");
    return run.exit_code == 0 ? "" : "nobody else can run limn here: " + run.err;
  }
  std::string limn(const std::string& words) const {
    return before_ + "\"$0\" spnav-server " + words;
  }

 private:
  std::string before_;
};

TEST_F(SpnavServerCommand, ListensInTheUsersRuntimeFolderWhereRunIsNotTheirs) {
  const NotRoot user(folder_.path());
  if (const std::string trouble = user.trouble(); !trouble.empty()) GTEST_SKIP() << trouble;
  simulate("push");
  RunningProgram limn({"/bin/sh", "-c",
                       "XDG_RUNTIME_DIR='" + folder_.path().string() + "' exec " +
                           user.limn("--replay '" + trace_ + "'"),
                       LIMN_BINARY});
  EXPECT_EQ(limn.line(), "listening on " + socket_ + ", for programs started with SPNAV_SOCKET=" +
                             socket_ + "; Ctrl-C ends it\n");
  namespace fs = std::filesystem;
  EXPECT_EQ(fs::status(socket_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(limn.end(SIGTERM), 128 + SIGTERM);
  EXPECT_FALSE(fs::exists(socket_));
}

TEST_F(SpnavServerCommand, AsksForASocketWhereThereIsNoPlaceForOne) {
  const NotRoot user(folder_.path());
  if (const std::string trouble = user.trouble(); !trouble.empty()) GTEST_SKIP() << trouble;
  simulate("push");
  for (const char* folder : {"unset XDG_RUNTIME_DIR", "export XDG_RUNTIME_DIR=relative"}) {
    const CommandRun run =
        run_shell(std::string(folder) + "; " + user.limn("--replay '" + trace_ + "'"));
    EXPECT_EQ(run.exit_code, 1) << folder;
    EXPECT_EQ(run.err,
              "limn: /run may not be written and XDG_RUNTIME_DIR is not set; say where to listen: "
              "--socket PATH\n");
  }
}

TEST_F(SpnavServerCommand, SaysWhatIsWrong) {
  const CommandRun of_spacenavd =
      run_limn({"spnav-server", "--backend", "spnav", "--socket", socket_});
  EXPECT_EQ(of_spacenavd.exit_code, 2);
  EXPECT_THAT(of_spacenavd.err, HasSubstr("what spacenavd serves needs no other server"));
  EXPECT_EQ(run_limn({"spnav-server", "--speed", "2"}).exit_code, 2);
  for (const char* speed : {"--mm-per-s", "--rad-per-s"}) {  // would change nothing
    EXPECT_EQ(run_limn({"spnav-server", speed, "50", "--replay", trace_}).exit_code, 2);
  }
  EXPECT_EQ(run_limn({"spnav-server", "046d:c626", "--replay", trace_}).exit_code, 2);
  const CommandRun missing =
      run_limn({"spnav-server", "--replay", "/nowhere.hid", "--socket", socket_});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("/nowhere.hid"));
  EXPECT_FALSE(std::filesystem::exists(socket_));
}

}  // namespace
}  // namespace limn::test
