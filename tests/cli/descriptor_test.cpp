#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_limn.hpp"
#include "tests/cli/sample_traces.hpp"
#include "tests/support/recordings.hpp"

namespace limn::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(Descriptor, HexBytesAndTraceGiveTheSameExplanation) {
  const std::string header = small_pen_header();
  const std::string hex = header.substr(6, header.find('\n') - 6);
  std::string raw;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 3) {
    raw += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  const CommandRun from_hex = run_limn({"descriptor", "-", "--format", "json"}, hex);
  const CommandRun from_raw = run_limn({"descriptor", "-", "--format", "json"}, raw);
  const CommandRun from_trace = run_limn({"descriptor", "-", "--format", "json"}, header);
  ASSERT_EQ(from_hex.exit_code, 0) << from_hex.err;
  EXPECT_EQ(from_hex.out, from_raw.out);
  EXPECT_EQ(json::parse(from_hex.out).size(), json::parse(from_trace.out).size());
}

TEST(Descriptor, TextNamesReportsUsagesRangesAndUnits) {
  const CommandRun run = run_limn({"descriptor", "-"}, small_pen_header());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* word : {"Tip Switch", "In Range", "1000", "mm", "Small Pen"}) {
    EXPECT_THAT(run.out, HasSubstr(word));
  }
}

// All of them go through the parser in the unit tests; here a process each costs too much.
TEST(Descriptor, RealDescriptorsAreExplained) {
  LIMN_NEEDS_RECORDINGS();
  const auto files = recordings("traces/descriptors", ".bin");
  ASSERT_EQ(files.size(), 413u);
  for (std::size_t i = 0; i < files.size(); i += 16) {
    const auto& file = files[i];
    const CommandRun run = run_limn({"descriptor", file.string(), "--format", "json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_FALSE(json::parse(run.out).empty()) << file;
  }
}

}  // namespace
}  // namespace limn::test
