#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_limn.hpp"
#include "tests/support/recordings.hpp"

namespace limn::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsSupersetOf;

/// The names of all that --list has of a kind.
std::vector<std::string> listed(const std::string& kind) {
  std::vector<std::string> names;
  const CommandRun run = run_limn({"simulate", "pen", "--list", "--format", "json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const json& entry : json::parse(run.out)) {
    if (entry["kind"] != kind) continue;
    names.push_back(entry["name"]);
    EXPECT_NE(entry["description"], "") << names.back();
  }
  return names;
}

std::vector<std::string> drawings() { return listed("drawing"); }

TEST(Simulate, ListsDevicesDrawingsMotionsAndFaults) {
  EXPECT_THAT(listed("device"), IsSupersetOf({"pen", "intuos", "huion", "xppen", "bluetooth-pen",
                                              "fast-pen", "spacenavigator", "spacemouse"}));
  EXPECT_THAT(drawings(), IsSupersetOf({"signature", "spiral", "teapot", "star"}));
  EXPECT_THAT(listed("motion"), IsSupersetOf({"push", "twist", "orbit"}));
  EXPECT_THAT(listed("fault"), IsSupersetOf({"drop", "unplug", "stuck-tip", "hostile-descriptor"}));
  EXPECT_EQ(listed("fault").size(), 17U);
}

TEST(Simulate, OffersTheNearestNames) {
  const auto refused = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "simulate");
    arguments.insert(arguments.end(), {"-o", "-"});
    const CommandRun run = run_limn(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << "not one line: " << run.err;
    return run.err;
  };
  EXPECT_EQ(refused({"spacemous"}),
            "limn: there is no simulated device 'spacemous'; did you mean spacemouse?\n");
  EXPECT_EQ(refused({"pen", "--drawing", "spirl"}),
            "limn: there is no drawing 'spirl'; did you mean spiral?\n");
  EXPECT_EQ(refused({"spacemouse", "--motion", "orbt"}),
            "limn: there is no motion 'orbt'; did you mean orbit?\n");
  EXPECT_EQ(refused({"pen", "--fault", "unplugg,at=2"}),
            "limn: there is no fault 'unplugg'; did you mean unplug?\n");
  EXPECT_THAT(refused({"pen", "--fault", "drop,p=2"}), HasSubstr("above 0 and at most 1"));
  EXPECT_THAT(refused({"pen", "--motion", "orbit"}), HasSubstr("is a pen"));
  EXPECT_THAT(refused({"spacemouse", "--drawing", "star"}), HasSubstr("is a 3D mouse"));
}

TEST(Simulate, EveryPenIsRecordedInItsFullModeAndDecodes) {
  for (const std::string& name : listed("device")) {
    if (name.starts_with("space")) continue;
    const CommandRun trace = run_limn({"simulate", name, "--drawing", "circle", "-o", "-"});
    ASSERT_EQ(trace.exit_code, 0) << trace.err;
    const CommandRun run = run_limn({"decode", "-", "--format", "jsonl"}, trace.out);
    ASSERT_EQ(run.exit_code, 0) << name << ": " << run.err;
    EXPECT_THAT(run.out, HasSubstr("\"state\":\"in_contact\"")) << name;
    EXPECT_THAT(run.err, testing::Not(HasSubstr("lost"))) << name;
  }
}

TEST(Simulate, EveryDeviceAndMovementGivesTheSameBytesAgain) {
  for (const std::string& name : listed("device")) {
    const bool mouse = name.starts_with("space");
    const auto simulate = [&] {
      return run_limn({"simulate", name, mouse ? "--motion" : "--drawing",
                       mouse ? "twist" : "circle", "--fault", "drop", "--fault", "unplug", "-o",
                       "-"})
          .out;
    };
    const std::string trace = simulate();
    EXPECT_THAT(trace, HasSubstr("\nE: ")) << name;
    EXPECT_THAT(trace, HasSubstr("#limn gone\n")) << name;
    EXPECT_EQ(trace, simulate()) << name;
  }
}

TEST(Simulate, AFaultIsToldByTheSummary) {
  const CommandRun trace =
      run_limn({"simulate", "pen", "--drawing", "star", "--fault", "unplug,at=0.5", "-o", "-"});
  ASSERT_EQ(trace.exit_code, 0) << trace.err;
  const CommandRun run = run_limn({"decode", "-"}, trace.out);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("1 reset"));
}

TEST(Simulate, ASeedGivesTheSameBytesAndAnotherOthers) {
  const auto simulate = [](const char* seed) {
    return run_limn({"simulate", "pen", "--drawing", "star", "--seed", seed, "-o", "-"}).out;
  };
  EXPECT_EQ(simulate("7"), simulate("7"));
  EXPECT_NE(simulate("7"), simulate("8"));
}

TEST(Simulate, EveryDrawingBecomesCurvesWithinTolerance) {
  for (const std::string& name : drawings()) {
    const CommandRun trace = run_limn({"simulate", "pen", "--drawing", name, "-o", "-"});
    ASSERT_EQ(trace.exit_code, 0) << trace.err;
    const CommandRun run = run_limn({"sketch", "-", "-o", "-"}, trace.out);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json sketch = json::parse(run.out);
    EXPECT_FALSE(sketch["strokes"].empty()) << name;
    for (const json& stroke : sketch["strokes"]) {
      EXPECT_LE(stroke["deviation_max_mm"], sketch["tolerance_mm"]) << name;
    }
  }
}

}  // namespace
}  // namespace limn::test
