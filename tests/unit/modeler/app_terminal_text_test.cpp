#include <gtest/gtest.h>

#include "modeler/app/terminal_text.hpp"

namespace limn::app {
namespace {

TEST(Printable, LeavesOutWhatATerminalObeys) {
  EXPECT_EQ(printable("Pen \x1b[31mred\a\x7f\n"), "Pen  [31mred   ");
  EXPECT_EQ(printable("\xC2\x9B"
                      "2J"),
            " 2J")
      << "a control sequence in one character";
  EXPECT_EQ(printable("Stift f\xC3\xBCr \xE7\xAC\x94 \xF0\x9F\x96\x8A"),
            "Stift f\xC3\xBCr \xE7\xAC\x94 \xF0\x9F\x96\x8A");
  EXPECT_EQ(printable("\x9B"
                      "2J \xE7\xAC \xFF \xC0\x9B"),
            "?2J ?? ? ??")
      << "no UTF-8";
  EXPECT_EQ(printable(""), "");
}

TEST(Shortened, CutsBetweenCharacters) {
  EXPECT_EQ(shortened("eight ab", 8), "eight ab");
  EXPECT_EQ(shortened("nine abcd", 8), "nine a..");
  EXPECT_EQ(shortened("f\xC3\xBC\xC3\xBC\xC3\xBC\xC3\xBC", 8), "f\xC3\xBC\xC3\xBC..");
  EXPECT_EQ(shortened("\xE7\xAC\x94\xE7\xAC\x94\xE7\xAC\x94", 4), "..");
}

}  // namespace
}  // namespace limn::app
