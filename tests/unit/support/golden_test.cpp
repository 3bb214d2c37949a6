#include "tests/support/golden.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>  // setenv is POSIX

#include "tests/support/recordings.hpp"
#include "tests/support/temp_folder.hpp"

namespace limn::test {
namespace {

using testing::HasSubstr;

/// Every test here decides itself whether golden files are rewritten.
class GoldenTest : public testing::Test {
 protected:
  GoldenTest() { unsetenv("LIMN_UPDATE_GOLDEN"); }
  ~GoldenTest() override { unsetenv("LIMN_UPDATE_GOLDEN"); }
  TempFolder folder_;
};

TEST_F(GoldenTest, AcceptsTheSameBytes) {
  folder_.write("case.txt", "one\ntwo\n");
  EXPECT_TRUE(matches_golden_in(folder_.path(), "one\ntwo\n", "case.txt"));
}

TEST_F(GoldenTest, NamesTheFirstDifferentLine) {
  folder_.write("case.txt", "one\ntwo\nthree\n");
  const auto result = matches_golden_in(folder_.path(), "one\n2\nthree\n", "case.txt");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.message(), HasSubstr("first in line 2"));
  EXPECT_THAT(result.message(), HasSubstr("golden: two"));
  EXPECT_THAT(result.message(), HasSubstr("actual: 2"));
}

TEST_F(GoldenTest, ATextThatEndsEarlyDiffers) {
  folder_.write("case.txt", "one\ntwo\n");
  const auto result = matches_golden_in(folder_.path(), "one\n", "case.txt");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.message(), HasSubstr("actual: (no such line)"));
}

TEST_F(GoldenTest, AMissingFileFailsAndSaysHowToMakeIt) {
  const auto result = matches_golden_in(folder_.path(), "text", "absent.txt");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.message(), HasSubstr("LIMN_UPDATE_GOLDEN=1"));
}

TEST_F(GoldenTest, TheVariableRewritesTheFile) {
  folder_.write("case.txt", "old\n");
  setenv("LIMN_UPDATE_GOLDEN", "1", 1);
  EXPECT_TRUE(matches_golden_in(folder_.path(), "new\n", "case.txt"));
  EXPECT_TRUE(matches_golden_in(folder_.path(), "made\n", "deeper/made.txt"));
  EXPECT_EQ(read_file(folder_.path() / "case.txt"), "new\n");
  EXPECT_EQ(read_file(folder_.path() / "deeper/made.txt"), "made\n");
}

TEST(TempFolder, GoesWithItsContent) {
  std::filesystem::path path;
  {
    const TempFolder folder;
    path = folder.path();
    folder.write("a", "content");
    EXPECT_EQ(read_file(path / "a"), "content");
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace limn::test
