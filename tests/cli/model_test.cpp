// `limn make`, `limn convert` and `limn info`: models into files and from one to another.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/run_limn.hpp"

namespace limn::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

std::string in(const TempFolder& folder, const char* name) {
  return (folder.path() / name).string();
}

/// Rows of `limn info --format json`.
nlohmann::json info(const std::string& path) {
  const CommandRun run = run_limn({"info", path, "--format", "json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return nlohmann::json::parse(run.out);
}

TEST(Make, WritesEachShape) {
  struct Shape {
    const char* kind;
    const char* part;
    std::size_t faces;
  };
  const TempFolder folder;
  for (const Shape& shape :
       {Shape{"box", "solid", 6}, Shape{"cone", "solid", 3}, Shape{"cylinder", "solid", 3},
        Shape{"disc", "shell", 1}, Shape{"plane", "shell", 1}, Shape{"sphere", "solid", 1},
        Shape{"torus", "solid", 1}}) {
    const std::string out = in(folder, "m.limn.json");
    const CommandRun run = run_limn({"make", shape.kind, "-o", out});
    ASSERT_EQ(run.exit_code, 0) << shape.kind << run.err;
    EXPECT_THAT(run.err, HasSubstr("read back within 0 mm")) << shape.kind;
    const auto rows = info(out);
    ASSERT_EQ(rows.size(), shape.faces + 1) << shape.kind;
    EXPECT_EQ(rows.back().at("kind"), shape.part) << shape.kind;
    EXPECT_THAT(names_in(folder), ElementsAre("m.limn.json"));
  }
}

TEST(Make, TakesSizesAndRefusesWrongOnes) {
  const TempFolder folder;
  const std::string out = in(folder, "b.limn.json");
  ASSERT_EQ(run_limn({"make", "box", "--size", "1,2,3", "-o", out}).exit_code, 0);
  EXPECT_EQ(info(out).back().at("bounds_mm"), "1 x 2 x 3");
  ASSERT_EQ(run_limn({"make", "cone", "--size", "5,0,8", "-o", out}).exit_code, 0);
  EXPECT_EQ(info(out).back().at("kind"), "solid") << "with a tip";

  const CommandRun count = run_limn({"make", "box", "--size", "1,2", "-o", out});
  EXPECT_EQ(count.exit_code, 2);
  EXPECT_EQ(count.err, "limn: a box has 3 sizes, not 2; give that many, in mm\n");
  EXPECT_EQ(run_limn({"make", "box", "--size", "1,2,-3", "-o", out}).exit_code, 1);
  EXPECT_EQ(run_limn({"make", "box", "--size", "1,2,nan", "-o", out}).exit_code, 1);
  const CommandRun kind = run_limn({"make", "teapot", "-o", out});
  EXPECT_EQ(kind.exit_code, 2);
  EXPECT_THAT(kind.err, HasSubstr("sphere"));
}

TEST(ConvertModel, GoesThroughStepAndIgesAndBack) {
  const TempFolder folder;
  const std::string first = in(folder, "t.limn.json");
  ASSERT_EQ(run_limn({"make", "torus", "-o", first}).exit_code, 0);
  std::string from = first;
  for (const char* name : {"a.step", "b.iges", "c.stp", "d.igs", "e.limn.json"}) {
    const std::string to = in(folder, name);
    const CommandRun run = run_limn({"convert", from, "-o", to});
    ASSERT_EQ(run.exit_code, 0) << name << run.err;
    EXPECT_THAT(run.err, StartsWith(to + ": 1 faces, 0 curves, read back within"));
    from = to;
  }
  const auto rows = info(from);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].at("rational"), true);
  EXPECT_EQ(rows[0].at("degree"), "2 x 2");
}

TEST(ConvertModel, SaysWhatIsWrong) {
  const TempFolder folder;
  const std::string out = in(folder, "o.step");
  const auto expect = [&](const std::vector<std::string>& arguments, int code, const char* text) {
    const CommandRun run = run_limn(arguments);
    EXPECT_EQ(run.exit_code, code) << run.err;
    EXPECT_THAT(run.err, HasSubstr(text));
    EXPECT_THAT(run.out, IsEmpty());
  };
  expect({"convert", in(folder, "no.step"), "-o", out}, 1, "no.step: cannot");
  expect({"convert", in(folder, "no.igs"), "-o", out}, 1, "no.igs: cannot");
  expect({"convert", in(folder, "no.obj"), "-o", out}, 2, "no extension of a model");
  expect({"info", in(folder, "no.limn.json")}, 1, "cannot");
  const std::string text = in(folder, "t.step");
  std::ofstream(text) << "hello";
  expect({"convert", text, "-o", out}, 1, "no STEP file");
  const std::string json = in(folder, "t.limn.json");
  std::ofstream(json) << "{\"limn_model\":9}";
  expect({"info", json}, 1, "/limn_model");
  const std::string iges = in(folder, "t.igs");
  std::ofstream(iges) << "hello\n";
  expect({"info", iges}, 1, "t.igs: ");
  EXPECT_THAT(names_in(folder), ElementsAre("t.igs", "t.limn.json", "t.step")) << "nothing half";
}

TEST(ConvertModel, AnEmptyModelIsOne) {
  const TempFolder folder;
  const std::string empty = in(folder, "e.limn.json");
  std::ofstream(empty) << "{\"limn_model\":1,\"bodies\":[],\"curves\":[]}";
  const std::string copy = in(folder, "c.limn.json");
  const CommandRun run = run_limn({"convert", empty, "-o", copy});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(info(copy).empty());
}

}  // namespace
}  // namespace limn::test
