#include "input/trace/noted_string.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limn {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(NotedString, ReadsWhatItWrites) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, NotedString::kMostBytes}) {
    NotedString string{200, {}};
    for (std::size_t i = 0; i < size; ++i) string.bytes.push_back(static_cast<std::uint8_t>(i));
    const auto read = noted_string(note_of(string));
    ASSERT_TRUE(read) << size;
    EXPECT_EQ(read->index, 200);
    EXPECT_EQ(read->bytes, string.bytes);
  }
  EXPECT_EQ(note_of({201, {0x0E, 0x03, 0xFF}}), "string 201 0e 03 ff");
}

TEST(NotedString, TakesAnEmptyAnswerAndAnyBlanks) {
  EXPECT_THAT(noted_string("string 7")->bytes, IsEmpty());
  EXPECT_THAT(noted_string("string  100\t0E 03 ")->bytes, ElementsAre(0x0E, 0x03));
}

TEST(NotedString, IsNothingElse) {
  for (const char* note : {"", "string", "strings 1", "lost 3", "string 256", "string -1 00",
                           "string x", "string 1 0", "string 1 000", "string 1 0g"}) {
    EXPECT_FALSE(noted_string(note)) << note;
  }
  std::string long_note = note_of({1, std::vector<std::uint8_t>(NotedString::kMostBytes)});
  EXPECT_FALSE(noted_string(long_note + " 00"));
}

}  // namespace
}  // namespace limn
