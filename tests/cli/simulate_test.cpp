#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_limn.hpp"
#include "tests/support/recordings.hpp"

namespace limn::test {
namespace {

using nlohmann::json;
using testing::IsSupersetOf;

std::vector<std::string> drawings() {
  std::vector<std::string> names;
  const CommandRun run = run_limn({"simulate", "pen", "--list", "--format", "json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const json& entry : json::parse(run.out)) {
    if (entry["kind"] == "drawing") names.push_back(entry["name"]);
  }
  return names;
}

TEST(Simulate, ListsTheDrawings) {
  EXPECT_THAT(drawings(), IsSupersetOf({"signature", "spiral", "teapot", "star"}));
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
