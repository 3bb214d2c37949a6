#include "input/trace/line_source.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "input/trace/trace.hpp"
#include "tests/unit/input/trace_reading.hpp"

namespace limn {
namespace {

struct OwnedLine {
  std::string text;
  std::uint64_t number;
  std::uint64_t offset;
  bool terminated;
  bool too_long;
};

std::vector<OwnedLine> lines_of(std::unique_ptr<ByteSource> bytes) {
  LineSource source(std::move(bytes));
  std::vector<OwnedLine> lines;
  for (;;) {
    const auto line = source.next();
    EXPECT_TRUE(line);
    if (!line || !line->has_value()) return lines;
    lines.push_back({std::string((*line)->text), (*line)->number, (*line)->offset,
                     (*line)->terminated, (*line)->too_long});
  }
}

TEST(LineSource, CutsAtLineEnds) {
  for (const std::size_t longest : {1U, 2U, 5U, 100U}) {
    const auto lines = lines_of(test::dribble_bytes("one\r\n\ntwo\rx\nlast", longest));
    ASSERT_EQ(lines.size(), 4U);
    EXPECT_EQ(lines[0].text, "one");
    EXPECT_EQ(lines[1].text, "");
    EXPECT_EQ(lines[2].text, "two\rx");
    EXPECT_EQ(lines[3].text, "last");
    EXPECT_EQ(lines[2].number, 3U);
    EXPECT_EQ(lines[2].offset, 6U);
    EXPECT_TRUE(lines[2].terminated);
    EXPECT_FALSE(lines[3].terminated);
  }
  EXPECT_TRUE(lines_of(memory_bytes("")).empty());
}

TEST(LineSource, LeavesOutAByteOrderMark) {
  const auto lines = lines_of(memory_bytes("\xEF\xBB\xBFt,x\n\xEF\xBB\xBFy\n"));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].text, "t,x");
  EXPECT_EQ(lines[1].text, "\xEF\xBB\xBFy");
}

TEST(LineSource, TakesTheLongestLineAndCutsLongerOnes) {
  for (const std::size_t excess : {1U, 200'000U, 3'000'000U}) {
    const std::string longest(kMaxLineBytes, 'a');
    const std::string longer(kMaxLineBytes + excess, 'b');
    const std::string text = longest + '\n' + longer + "\nafter\n" + longer;
    const auto lines = lines_of(memory_bytes(text));
    ASSERT_EQ(lines.size(), 4U);
    EXPECT_FALSE(lines[0].too_long);
    EXPECT_EQ(lines[0].text, longest);
    EXPECT_TRUE(lines[1].too_long);
    EXPECT_EQ(lines[1].text.size(), kMaxLineBytes);
    EXPECT_EQ(lines[2].text, "after");
    EXPECT_EQ(lines[2].number, 3U);
    EXPECT_EQ(lines[2].offset, longest.size() + longer.size() + 2);
    EXPECT_TRUE(lines[3].too_long);
  }
}

TEST(LineSource, PassesOnAFailureToRead) {
  class Failing final : public ByteSource {
    Expected<std::size_t> read(std::span<char>) override {
      return fail(ErrorCode::kIo, "", "broken", "mend it");
    }
  };
  LineSource source(std::make_unique<Failing>());
  const auto line = source.next();
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().what, "broken");
}

}  // namespace
}  // namespace limn
