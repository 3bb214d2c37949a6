#include "input/trace/text.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace limn::text {
namespace {

TEST(Text, SecondsAreExactToTheNanosecond) {
  EXPECT_EQ(parse_seconds("0.000000"), Timestamp(0));
  EXPECT_EQ(parse_seconds("000012.345678"), Timestamp(12'345'678'000));
  EXPECT_EQ(parse_seconds("1369413757.964832"), Timestamp(1'369'413'757'964'832'000));
  EXPECT_EQ(parse_seconds("3"), Timestamp(3'000'000'000));
  EXPECT_EQ(parse_seconds("3.5"), Timestamp(3'500'000'000));
  EXPECT_EQ(parse_seconds("3.000000001"), Timestamp(3'000'000'001));
  EXPECT_EQ(parse_seconds("3.0000000019"), Timestamp(3'000'000'001));
}

TEST(Text, SecondsAreNothingElse) {
  for (const char* word : {"", ".", ".5", "1.", "-1.0", "+1", "1.0e3", "1,5", "1.5.5", "x", "1.x",
                           "9223372036.0", "99999999999999999999999"}) {
    EXPECT_FALSE(parse_seconds(word)) << word;
  }
}

TEST(Text, HexBytesHaveTwoDigits) {
  std::array<std::uint8_t, 4> out{};
  EXPECT_EQ(parse_hex_bytes(" 00 fF  A5\t", out).count, 3U);
  EXPECT_EQ(out, (std::array<std::uint8_t, 4>{0x00, 0xFF, 0xA5, 0}));
  EXPECT_EQ(parse_hex_bytes("", out).count, 0U);
  for (const char* bad : {"0", "012", "0g", "0x", "--"}) {
    EXPECT_EQ(parse_hex_bytes(std::string("01 ") + bad + " 02", out).bad, bad);
  }
}

TEST(Text, HexBytesBeyondTheRoomAreCountedNotStored) {
  std::array<std::uint8_t, 2> out{};
  EXPECT_EQ(parse_hex_bytes("01 02 03 04", out).count, 4U);
  EXPECT_EQ(out, (std::array<std::uint8_t, 2>{1, 2}));
}

TEST(Text, ProseIsWhatNoTornRecordCanBe) {
  EXPECT_TRUE(is_prose("   - land a second finger far enough from the first"));
  EXPECT_TRUE(is_prose("Starting dumping interrupt transfer stream"));
  EXPECT_FALSE(is_prose(" 05 0d a1 01 c0"));
  EXPECT_FALSE(is_prose("E 0.12 3 01"));
  EXPECT_FALSE(is_prose("001:STREAM             1543544521.564910"));
  EXPECT_FALSE(is_prose("some text \x01 and a control character"));
}

TEST(Text, QuotesAreShortAndPrintable) {
  EXPECT_EQ(quoted("abc"), "\"abc\"");
  EXPECT_EQ(quoted("a\nb\x01"), "\"a?b?\"");
  EXPECT_EQ(quoted("0123456789012345678901234567"), "\"012345678901234567890123..\"");
}

}  // namespace
}  // namespace limn::text
