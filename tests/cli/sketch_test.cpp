// The contract of `limn sketch`: the table, and files by extension.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_limn.hpp"
#include "tests/cli/sample_traces.hpp"
#include "tests/support/recordings.hpp"

namespace limn::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Sketch, WritesEachFileByItsExtension) {
  const TempFolder folder;
  const std::string trace = folder.write("line.hid", small_pen_line()).string();
  std::vector<std::string> arguments = {"sketch", trace};
  for (const char* extension : {"svg", "pdf", "png", "step", "json"}) {
    arguments.insert(arguments.end(), {"-o", (folder.path() / "out.").string() + extension});
  }
  const CommandRun run = run_limn(arguments);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(names_in(folder),
              ElementsAre("line.hid", "out.json", "out.pdf", "out.png", "out.step", "out.svg"));
  EXPECT_THAT(read_file(folder.path() / "out.svg"), HasSubstr("<svg"));
  EXPECT_THAT(read_file(folder.path() / "out.pdf"), StartsWith("%PDF-"));
  EXPECT_THAT(read_file(folder.path() / "out.png"), StartsWith("\x89PNG"));
  EXPECT_THAT(read_file(folder.path() / "out.step"), StartsWith("ISO-10303-21;"));
}

TEST(Sketch, JsonKeepsTheContract) {
  const CommandRun run =
      run_limn({"sketch", "-", "--tolerance", "0.05", "-o", "-"}, small_pen_line());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json sketch = json::parse(run.out);
  EXPECT_EQ(sketch["tolerance_mm"], 0.05);
  ASSERT_EQ(sketch["strokes"].size(), 1u);
  const json& stroke = sketch["strokes"][0];
  EXPECT_EQ(stroke["samples"], 11);
  EXPECT_DOUBLE_EQ(stroke["t0"], 0.01);
  EXPECT_DOUBLE_EQ(stroke["t1"], 0.06);
  EXPECT_EQ(stroke["degree"], 3);
  EXPECT_EQ(stroke["closed"], false);
  EXPECT_EQ(stroke["corners"], json::array());
  EXPECT_EQ(stroke["control_points"].size(), 4u) << "a straight line needs one span";
  EXPECT_EQ(stroke["knots"].size(), 8u);
  EXPECT_NEAR(stroke["control_points"][0][0], 10.0, 0.05);
  EXPECT_NEAR(stroke["control_points"][3][0], 20.0, 0.05);
  EXPECT_LE(stroke["deviation_max_mm"], 0.05);
  EXPECT_LE(stroke["deviation_rms_mm"], stroke["deviation_max_mm"]);
}

TEST(Sketch, TableHasARowAStroke) {
  const CommandRun text = run_limn({"sketch", "-"}, small_pen_line());
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_EQ(std::count(text.out.begin(), text.out.end(), '\n'), 2);
  const CommandRun lines = run_limn({"sketch", "-", "--format", "jsonl"}, small_pen_line());
  const json row = json::parse(lines.out);
  EXPECT_EQ(row["samples"], 11);
  EXPECT_NEAR(row["length_mm"], 10.0, 1e-9);
  EXPECT_NEAR(row["duration_s"], 0.05, 1e-9);
  EXPECT_EQ(row["control_points"], 4);
  EXPECT_EQ(row["corners"], 0);
}

TEST(Sketch, NoContactIsNoError) {
  const CommandRun run = run_limn({"sketch", "-", "-o", "-"}, small_pen_header());
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["strokes"], json::array());
  const TempFolder folder;
  const CommandRun files =
      run_limn({"sketch", "-", "-o", folder.path() / "e.svg", "-o", folder.path() / "e.step", "-o",
                folder.path() / "e.png", "-o", folder.path() / "e.pdf"},
               small_pen_header());
  EXPECT_EQ(files.exit_code, 0) << files.err;
  EXPECT_EQ(names_in(folder).size(), 4u);
}

TEST(Sketch, TabletMiceMakeNoStrokes) {
  LIMN_NEEDS_RECORDINGS();
  for (const char* name : {"Wacom_Intuos2_4x5_056a_0041.hid", "Wacom_Intuos3_6x8_056a_00B1.hid"}) {
    const auto path = shared_folder() / "traces/pens" / name;
    const CommandRun run = run_limn({"sketch", path.string(), "-o", "-"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(json::parse(run.out)["strokes"], json::array()) << name;
  }
}

TEST(Sketch, SameInputSameBytes) {
  const TempFolder folder;
  for (const char* extension : {"svg", "pdf", "png", "step", "json"}) {
    const std::string first = (folder.path() / "a.").string() + extension;
    const std::string second = (folder.path() / "b.").string() + extension;
    ASSERT_EQ(run_limn({"sketch", "-", "-o", first}, small_pen_line()).exit_code, 0);
    ASSERT_EQ(run_limn({"sketch", "-", "-o", second}, small_pen_line()).exit_code, 0);
    EXPECT_EQ(read_file(first), read_file(second)) << extension;
  }
}

}  // namespace
}  // namespace limn::test
