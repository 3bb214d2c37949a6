#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/cli/run_limn.hpp"
#include "tests/cli/sample_traces.hpp"

namespace limn::test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class PlotCommand : public testing::Test {
 protected:
  std::string place(const char* name) const { return (folder_.path() / name).string(); }
  CommandRun plot(const std::string& input, const char* output,
                  std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"plot", "-", "-o", place(output)});
    return run_limn(options, input);
  }
  TempFolder folder_;
};

TEST_F(PlotCommand, DrawsAPensChannels) {
  const CommandRun run = plot(small_pen_line(), "pen.svg");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string svg = contents(place("pen.svg"));
  EXPECT_THAT(svg, HasSubstr(">position, mm</text>"));
  EXPECT_THAT(svg, HasSubstr(">in contact</text>"));
  EXPECT_THAT(svg, HasSubstr("class=\"shade\""));
  EXPECT_THAT(svg, Not(HasSubstr("tilt"))) << "the pen has none";
  EXPECT_THAT(svg, Not(HasSubstr("reports lost")));
}

TEST_F(PlotCommand, DrawsA3dMouseAndItsWay) {
  const CommandRun made = run_limn({"simulate", "spacenavigator", "--motion", "push", "-o", "-"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  for (const char* name : {"mouse.svg", "mouse.png", "mouse.pdf"}) {
    const CommandRun run = plot(made.out, name, {"--dead-zone", "0.1"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  const std::string svg = contents(place("mouse.svg"));
  for (const char* text :
       {"translation, of full deflection", "velocity, mm/s", "angular velocity, rad/s",
        "path from above", "dead zone", "a button pressed", "046d:c626"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
  EXPECT_THAT(contents(place("mouse.png")).substr(1, 3), "PNG");
  EXPECT_THAT(contents(place("mouse.pdf")).substr(0, 4), "%PDF");
}

TEST_F(PlotCommand, MarksWhatWasLost) {
  std::string trace = small_pen_line();
  const std::size_t behind = trace.find("\nE:", trace.size() / 2);
  trace.insert(behind + 1, "#limn lost 3\n");
  ASSERT_EQ(plot(trace, "lost.svg").exit_code, 0);
  const std::string svg = contents(place("lost.svg"));
  EXPECT_THAT(svg, HasSubstr("class=\"mark\""));
  EXPECT_THAT(svg, HasSubstr(">reports lost</text>"));
  EXPECT_THAT(svg, HasSubstr("3 lost"));
}

TEST_F(PlotCommand, SaysWhatIsWrong) {
  const CommandRun empty = plot(small_pen_header(), "empty.svg");
  EXPECT_EQ(empty.exit_code, 1);
  EXPECT_THAT(empty.err,
              HasSubstr("limn: (stream): holds no samples to plot; give a recording of a pen"));
  const CommandRun other = plot(small_pen_line(), "plot.gif");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("choose .png, .svg or .pdf"));
  EXPECT_EQ(run_limn({"plot", "-"}, small_pen_line()).exit_code, 2) << "no -o";
  EXPECT_THAT(names_in(folder_), testing::IsEmpty());
}

}  // namespace
}  // namespace limn::test
