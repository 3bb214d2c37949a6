#include "tests/bench/row.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limn::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(BenchRow, TheRatioIsAboveOneWhereLimnIsBetter) {
  const Row row{"a", 2.0, "ms", Peer{8.0, "b"}, std::nullopt};
  EXPECT_EQ(row.ratio(), 4.0);
  EXPECT_EQ(Row({"a", 2.0, "ms", std::nullopt, std::nullopt}).ratio(), std::nullopt);
}

TEST(BenchRow, AGoalIsOfTheCostOrOfTheRatio) {
  EXPECT_EQ(Row({"a", 2.0, "ms", std::nullopt, at_most(2.0)}).holds(), true);
  EXPECT_EQ(Row({"a", 2.1, "ms", std::nullopt, at_most(2.0)}).holds(), false);
  EXPECT_EQ(Row({"a", 2.0, "ms", Peer{8.0, "b"}, at_least_ratio(4.0)}).holds(), true);
  EXPECT_EQ(Row({"a", 2.0, "ms", Peer{7.9, "b"}, at_least_ratio(4.0)}).holds(), false);
  EXPECT_EQ(Row({"a", 2.0, "ms", std::nullopt, at_least_ratio(4.0)}).holds(), false);
  EXPECT_EQ(Row({"a", 2.0, "ms", Peer{8.0, "b"}, std::nullopt}).holds(), std::nullopt);
}

TEST(BenchRow, JsonHasTheContractsKeys) {
  EXPECT_EQ(to_json({"a", 2.0, "ms", Peer{8.0, "b"}, at_least_ratio(3.0)}),
            R"({"row":"a","limn":2.0,"peer":8.0,"peer_name":"b","unit":"ms","ratio":4.0,)"
            R"("goal":{"min":3.0},"holds":true})");
  EXPECT_EQ(to_json({"a", 2.0, "ms", std::nullopt, at_most(1.0)}),
            R"({"row":"a","limn":2.0,"unit":"ms","goal":{"max":1.0},"holds":false})");
  EXPECT_THAT(to_json({"a", 2.0, "ms", Peer{8.0, "b", true}, {}}), HasSubstr(R"("recorded":true)"));
}

TEST(BenchRow, TheTableAlignsAndMarksRecordedPeers) {
  const std::string heading = table_heading();
  const std::string line =
      to_table_line({"fit/x", 0.01234, "ms", Peer{96, "b", true}, at_most(0.01)});
  EXPECT_EQ(line.find("ms"), heading.find("unit"));
  EXPECT_EQ(line.find("<= 0.0100"), heading.find("goal"));
  EXPECT_EQ(line.find("NO"), heading.find("holds"));
  EXPECT_EQ(line.find("b (recorded)"), heading.find("peer is"));
  EXPECT_THAT(line, HasSubstr("0.0123"));
  EXPECT_THAT(line, Not(HasSubstr("96.0")));
}

}  // namespace
}  // namespace limn::bench
