// What README.md shows is what happens: its program is a file that is compiled here, its console
// sessions are run. LIMN_UPDATE_GOLDEN=1 puts the present text and output into README.md.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/examples/readme_blocks.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/temp_folder.hpp"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

const fs::path kReadme = fs::path(LIMN_SOURCE_DIR) / "README.md";
const fs::path kProgram = fs::path(LIMN_SOURCE_DIR) / "tests/examples/sketch_a_recording.cpp";

bool update_wanted() {
  const char* value = std::getenv("LIMN_UPDATE_GOLDEN");
  return value != nullptr && std::string_view(value) == "1";
}

/// Standard output and error of a shell command that runs in `folder` with the built limn in PATH.
std::string output_of(const std::string& command, const fs::path& folder) {
  const std::string path = fs::path(LIMN_BINARY).parent_path().string();
  const std::string line =
      "cd '" + folder.string() + "' && PATH='" + path + "':\"$PATH\" && { " + command + "; } 2>&1";
  FILE* const pipe = popen(line.c_str(), "r");
  std::string output;
  for (int c = 0; pipe != nullptr && (c = std::fgetc(pipe)) != EOF;) output += static_cast<char>(c);
  if (pipe == nullptr || pclose(pipe) != 0) ADD_FAILURE() << command << " fails:\n" << output;
  return output;
}

/// Checks each block of `language`, in order, against what `make` gives for its present content, or
/// puts that in its place.
template <class Make>
void check_blocks(const std::string& language, const Make& make) {
  const std::string readme = read_file(kReadme);
  std::string right;
  std::size_t copied = 0;
  int checked = 0;
  for (const auto& block : fenced_blocks(readme)) {
    if (block.language != language) continue;
    const std::string present = readme.substr(block.begin, block.end - block.begin);
    const std::string made = make(present);
    if (!update_wanted()) {
      EXPECT_EQ(present, made) << "bring README.md up to date by LIMN_UPDATE_GOLDEN=1";
    }
    right += readme.substr(copied, block.begin - copied) + made;
    copied = block.end;
    ++checked;
  }
  EXPECT_GT(checked, 0) << "README.md has no block of " << language;
  if (update_wanted()) std::ofstream(kReadme, std::ios::binary) << right << readme.substr(copied);
}

TEST(Readme, ShowsTheProgramThatIsCompiled) {
  check_blocks("cpp", [](const std::string&) { return read_file(kProgram); });
}

TEST(Readme, ItsSessionsPrintWhatTheyShow) {
  const TempFolder folder;
  check_blocks("console", [&folder](const std::string& present) {
    std::string session;
    for (const auto& step : console_steps(present))
      session += "$ " + step.command + "\n" + output_of(step.command, folder.path());
    return session;
  });
}

TEST(Readme, NamesFilesThatExist) {
  std::string prose = read_file(kReadme);
  for (const auto& block : fenced_blocks(prose))
    std::fill(prose.begin() + static_cast<std::ptrdiff_t>(block.begin),
              prose.begin() + static_cast<std::ptrdiff_t>(block.end), ' ');
  int links = 0;
  for (auto at = prose.find("]("); at != std::string::npos; at = prose.find("](", at + 1)) {
    const std::string target = prose.substr(at + 2, prose.find(')', at) - at - 2);
    if (target.starts_with("http")) continue;
    EXPECT_TRUE(fs::exists(fs::path(LIMN_SOURCE_DIR) / target)) << target;
    ++links;
  }
  EXPECT_GT(links, 3);
}

TEST(Examples, TheProgramDrawsARecording) {
  const TempFolder folder;
  output_of("limn simulate pen --drawing star -o star.hid", folder.path());
  const std::string said =
      output_of(std::string("'") + EXAMPLE_BINARY + "' star.hid star.svg", folder.path());
  EXPECT_NE(said.find("control points, within 0."), std::string::npos) << said;
  EXPECT_NE(read_file(folder.path() / "star.svg").find("</svg>"), std::string::npos);
}

TEST(ReadmeBlocks, AreFound) {
  const std::string text = "a\n```cpp\nint i;\n```\nb\n```\nplain\n```\n";
  const auto blocks = fenced_blocks(text);
  ASSERT_EQ(blocks.size(), 2U);
  EXPECT_EQ(blocks[0].language, "cpp");
  EXPECT_EQ(text.substr(blocks[0].begin, blocks[0].end - blocks[0].begin), "int i;\n");
  EXPECT_EQ(blocks[1].language, "");
}

TEST(ReadmeBlocks, HoldConsoleSteps) {
  const auto steps = console_steps("$ ls\na\nb\n$ true\n$ echo c\nc\n");
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps[0].command, "ls");
  EXPECT_EQ(steps[0].output, "a\nb\n");
  EXPECT_EQ(steps[1].output, "");
  EXPECT_EQ(steps[2].output, "c\n");
}

}  // namespace
}  // namespace limn::test
