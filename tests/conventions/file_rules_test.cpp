#include "tests/conventions/file_rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <sstream>

#include "tests/support/recordings.hpp"

namespace limn::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const fs::path kRoot = LIMN_SOURCE_DIR;

TEST(Files, FollowTheRules) {
  for (const auto& file : source_files(kRoot)) {
    EXPECT_THAT(file_violations(file), IsEmpty());
    EXPECT_THAT(library_violations(file), IsEmpty());
  }
}

TEST(Files, TheRulesAreFelt) {
  EXPECT_THAT(file_violations({"input/base/a.hpp", "int a;\n"}),
              ElementsAre(HasSubstr("no #pragma once")));
  EXPECT_THAT(file_violations({"input/base/string_utils.cpp", ""}),
              ElementsAre(HasSubstr("\"utils\" names nothing")));
  EXPECT_THAT(file_violations({"input/base/utilisation.cpp", ""}), IsEmpty());
  EXPECT_THAT(file_violations({"input/base/a.cpp", std::string(701, '\n')}),
              ElementsAre(HasSubstr("700 lines")));
}

TEST(Files, LibrariesNeitherThrowNorPrint) {
  const auto in_library = [](const std::string& text) {
    return library_violations({"modeler/fit/a.cpp", text});
  };
  EXPECT_THAT(in_library("throw 1;"), ElementsAre(HasSubstr("throw")));
  EXPECT_THAT(in_library("std::cout << 1;"), ElementsAre(HasSubstr("std::cout")));
  EXPECT_THAT(in_library("std::printf(\"a\");"), ElementsAre(HasSubstr("printf")));
  EXPECT_THAT(in_library("std::snprintf(b, 3, \"a\");"), IsEmpty());
  EXPECT_THAT(in_library("std::exit (1);"), ElementsAre(HasSubstr("exit")));
  EXPECT_THAT(in_library("const double exit = 1; use(exit, path.exit(2));"), IsEmpty());
  EXPECT_THAT(in_library("// never throw\nconst char* s = \"exit\"; /* abort */"), IsEmpty());
  EXPECT_THAT(in_library("int n = 1'000; throw 'x';"), ElementsAre(HasSubstr("throw")));
  EXPECT_THAT(in_library("auto s = R\"(\" throw )\"; int i;"), IsEmpty());
  EXPECT_THAT(library_violations({"modeler/app/a.cpp", "std::exit(1);"}), IsEmpty());
}

TEST(Files, DecodingUsesNoMathematicalLibrary) {
  EXPECT_THAT(library_violations({"drivers/devices/a.cpp", "std::atan2(y, x)"}),
              ElementsAre(HasSubstr("std::atan2")));
  EXPECT_THAT(library_violations({"drivers/devices/a.cpp", "std::sqrt(x)"}), IsEmpty());
  EXPECT_THAT(library_violations({"modeler/fit/a.cpp", "std::atan2(y, x)"}), IsEmpty());
}

TEST(Folders, TheTopLevelHasOnlyTheFive) {
  std::set<std::string> found;
  for (const auto& entry : fs::directory_iterator(kRoot)) {
    const auto name = entry.path().filename().string();
    // Hidden folders belong to tools, build to the build.
    if (entry.is_directory() && !name.starts_with('.') && name != "build") found.insert(name);
  }
  EXPECT_THAT(found, testing::UnorderedElementsAreArray(kTopFolders));
}

// Data of tests explains itself by an ORIGIN.md; a mirror of the source tree needs no word.
bool needs_readme(const std::string& folder) {
  return !folder.starts_with("tests/unit/") && !folder.starts_with("tests/property/") &&
         !folder.starts_with("tests/golden/") && !folder.starts_with("tests/fuzz/") &&
         !folder.starts_with("tests/conventions/") && !folder.ends_with("/pictures");
}

TEST(Folders, EachSaysInAPageWhatItIsFor) {
  constexpr std::ptrdiff_t kPage = 80;  // lines
  for (const auto& folder : source_folders(kRoot)) {
    if (!needs_readme(folder) || fs::is_empty(kRoot / folder)) continue;
    const fs::path readme = kRoot / folder / "README.md";
    if (!fs::exists(readme)) {
      ADD_FAILURE() << folder << " has no README.md";
      continue;
    }
    const std::string text = read_file(readme);
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), kPage) << readme;
  }
}

TEST(Folders, EachOfGoldenFilesNamesTheirOrigin) {
  for (const auto& folder : source_folders(kRoot)) {
    if (!folder.starts_with("tests/golden/")) continue;
    EXPECT_TRUE(fs::exists(kRoot / folder / "ORIGIN.md")) << folder << " has no ORIGIN.md";
  }
}

TEST(Build, GlobsNoSources) {
  std::vector<fs::path> files = {kRoot / "CMakeLists.txt", kRoot / "limn.cmake"};
  for (const auto& folder : source_folders(kRoot))
    for (const auto& entry : fs::directory_iterator(kRoot / folder))
      if (entry.path().filename() == "CMakeLists.txt" || entry.path().extension() == ".cmake")
        files.push_back(entry.path());
  ASSERT_GT(files.size(), 10U);
  for (const auto& file : files)
    EXPECT_THAT(read_file(file), testing::Not(testing::ContainsRegex("GLOB(_RECURSE)?[ \n]")))
        << file;
}

TEST(Format, IsThatOfClangFormat) {
  constexpr const char* kTool = "clang-format-14";
  if (std::system((std::string(kTool) + " --version >/dev/null 2>&1").c_str()) != 0)
    GTEST_SKIP() << kTool << " is not installed (apt install " << kTool << ")";
  std::string command = "cd '" + kRoot.string() + "' && " + kTool + " --dry-run -Werror 2>&1";
  for (const auto& file : source_files(kRoot)) command += " " + file.path;
  FILE* const pipe = popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string output;
  for (int c = 0; (c = std::fgetc(pipe)) != EOF;) output += static_cast<char>(c);
  const int status = pclose(pipe);
  std::set<std::string> unformatted;  // complaints read "FILE:LINE:COLUMN: error: .."
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);)
    if (line.find(": error: ") != std::string::npos)
      unformatted.insert(line.substr(0, line.find(':')));
  EXPECT_THAT(unformatted, IsEmpty()) << "format them by: " << kTool << " -i FILE...";
  EXPECT_TRUE(status == 0 || !unformatted.empty()) << output;
}

}  // namespace
}  // namespace limn::test
