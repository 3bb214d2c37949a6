// The contract of `limn decode`: names, units, order, and which fields are absent.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/run_limn.hpp"
#include "tests/cli/sample_traces.hpp"
#include "tests/support/recordings.hpp"

namespace limn::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::vector<json> parse_lines(const std::string& text) {
  std::vector<json> objects;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) objects.push_back(json::parse(line));
  return objects;
}

TEST(Decode, JsonlHasTheContractsFields) {
  const CommandRun run = run_limn({"decode", "-", "--format", "jsonl"}, small_pen_line());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto samples = parse_lines(run.out);
  ASSERT_EQ(samples.size(), 14u);
  const json first = {{"t", 0},
                      {"device", 0},
                      {"tool", "pen"},
                      {"state", "in_range"},
                      {"x_mm", 10.0},
                      {"y_mm", 20.0},
                      {"buttons", json::array()},
                      {"lost", 0},
                      {"raw", {{"x", 100}, {"y", 200}}}};
  EXPECT_EQ(samples[0], first);
  EXPECT_EQ(samples[1]["state"], "in_contact");
  EXPECT_EQ(samples[1]["t"], 0.01);
  EXPECT_DOUBLE_EQ(samples[11]["x_mm"], 20.0);
  EXPECT_EQ(samples[12]["state"], "in_range");
  EXPECT_EQ(samples[13]["state"], "out_of_range");
  EXPECT_EQ(samples[13]["raw"]["x"], 200) << "an out-of-range report keeps its coordinates";
}

TEST(Decode, JsonIsAnArrayOfTheSameObjects) {
  const CommandRun lines = run_limn({"decode", "-", "--format", "jsonl"}, small_pen_line());
  const CommandRun array = run_limn({"decode", "-", "--format", "json"}, small_pen_line());
  ASSERT_EQ(array.exit_code, 0) << array.err;
  EXPECT_EQ(json::parse(array.out).get<std::vector<json>>(), parse_lines(lines.out));
}

TEST(Decode, CsvHasTheSameNamesAsColumns) {
  const CommandRun run = run_limn({"decode", "-", "--format", "csv"}, small_pen_line());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out,
              StartsWith("t,device,tool,state,x_mm,y_mm,pressure,tilt_x_deg,tilt_y_deg,twist_deg,"
                         "distance,buttons,serial,lost,raw.x,raw.y,raw.pressure,lost_estimated,"
                         "disturbances\n"
                         "0,0,pen,in_range,10,20,,,,,,,,0,100,200,,,\n"
                         "0.01,0,pen,in_contact,10,20,,,,,,,,0,100,200,,,\n"));
}

TEST(Decode, DisturbancesAreFieldsOfTheNextSampleAndCounted) {
  // A Graphire, whose pen enters in contact after a queue overran.
  const std::string recording =
      "N: a\nI: 3 056a 0013\n#limn lost? 64\nE: 3.0 8 02 91 40 1f 20 03 ff 01\n";
  const CommandRun lines = run_limn({"decode", "-", "--format", "jsonl"}, recording);
  ASSERT_EQ(lines.exit_code, 0) << lines.err;
  const auto samples = parse_lines(lines.out);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[0]["lost"], 64);
  EXPECT_EQ(samples[0]["lost_estimated"], true);
  EXPECT_EQ(samples[0]["disturbances"], json::array({"overrun", "repaired"}));
  EXPECT_EQ(samples[1]["lost"], 0);
  EXPECT_FALSE(samples[1].contains("disturbances"));
  EXPECT_FALSE(samples[1].contains("lost_estimated"));
  EXPECT_EQ(lines.err,
            "2 samples, at least 64 lost, 1 queue overrun, 1 repaired state transition\n");
  const CommandRun csv = run_limn({"decode", "-", "--format", "csv"}, recording);
  EXPECT_THAT(csv.out, HasSubstr(",true,overrun repaired\n"));
  const CommandRun text = run_limn({"decode", "-"}, recording);
  EXPECT_THAT(text.out, HasSubstr(" lost>=64 !overrun !repaired\n"));
}

TEST(Decode, TextIsOneLineASample) {
  const CommandRun run = run_limn({"decode", "-"}, small_pen_line());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 15) << "a heading and 14 samples";
}

TEST(Decode, ARecordingWithoutSamplesIsAnEmptyArray) {
  const CommandRun run = run_limn({"decode", "-", "--format", "json"}, small_pen_header());
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out), json::array());
}

TEST(Decode, StrokeCsvHasNoRawCounts) {
  const CommandRun run = run_limn({"decode", "-", "--format", "jsonl"},
                                  "t,x,y,p,alt,az\n0.5,10.25,20,0.25,90,0\n0.6,11,20,0.5,90,0\n");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto samples = parse_lines(run.out);
  ASSERT_GE(samples.size(), 2u);
  EXPECT_EQ(samples[0]["t"], 0);
  EXPECT_EQ(samples[0]["x_mm"], 10.25);
  EXPECT_EQ(samples[0]["pressure"], 0.25);
  EXPECT_FALSE(samples[0].contains("raw"));
}

TEST(Decode, UsbhidDumpTakesDescriptorAndIdFromOutside) {
  const TempFolder folder;
  const auto descriptor =
      folder.write("rd.txt", small_pen_header().substr(6, small_pen_header().find('\n') - 6));
  const std::string dump =
      "001:002:000:STREAM             9.500000\n 01 03 64 00 C8 00\n\n"
      "001:002:000:STREAM             9.600000\n 01 00 64 00 C8 00\n\n";
  const CommandRun without = run_limn({"decode", "-"}, dump);
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_THAT(without.err, HasSubstr("--descriptor"));
  const CommandRun with = run_limn({"decode", "-", "--descriptor", descriptor.string(), "--id",
                                    "1209:0001", "--format", "jsonl"},
                                   dump);
  ASSERT_EQ(with.exit_code, 0) << with.err;
  EXPECT_EQ(parse_lines(with.out).at(0)["state"], "in_range") << "inserted before contact";
  EXPECT_EQ(parse_lines(with.out).at(1)["state"], "in_contact");
}

TEST(Decode, SalvageSkipsDamageAndCountsIt) {
  std::string trace = small_pen_line();
  trace.insert(trace.find("E: 5.030"), std::string("E: 5.0\0\0garbage\n", 16));
  const CommandRun strict = run_limn({"decode", "-"}, trace);
  EXPECT_EQ(strict.exit_code, 1);
  EXPECT_THAT(strict.err, HasSubstr("--salvage"));
  const CommandRun salvaged = run_limn({"decode", "-", "--salvage", "--format", "jsonl"}, trace);
  EXPECT_EQ(salvaged.exit_code, 0) << salvaged.err;
  EXPECT_EQ(parse_lines(salvaged.out).size(), 14u);
  EXPECT_THAT(salvaged.err, HasSubstr("damaged"));
}

TEST(Decode, EveryRecordingOfAPenGivesLegalStates) {
  LIMN_NEEDS_RECORDINGS();
  const std::map<std::string, std::vector<std::string>> kLegal = {
      {"out_of_range", {"out_of_range", "in_range", "in_range_erasing"}},
      {"in_range", {"in_range", "in_contact", "out_of_range"}},
      {"in_contact", {"in_contact", "in_range"}},
      {"in_range_erasing", {"in_range_erasing", "erasing", "out_of_range"}},
      {"erasing", {"erasing", "in_range_erasing"}}};
  for (const auto& path : recordings("traces/pens", ".hid")) {
    const CommandRun run = run_limn({"decode", path.string(), "--format", "jsonl"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    std::map<int, std::string> state;
    for (const json& sample : parse_lines(run.out)) {
      auto& before = state.try_emplace(sample["device"], "out_of_range").first->second;
      EXPECT_THAT(kLegal.at(before), testing::Contains(sample["state"])) << path << sample;
      before = sample["state"];
    }
  }
}

}  // namespace
}  // namespace limn::test
