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
                         "disturbances,mm_per_s.x,mm_per_s.y,mm_per_s.z,rad_per_s.x,rad_per_s.y,"
                         "rad_per_s.z,raw.1,raw.2,raw.3,raw.4,raw.5,raw.6,battery_percent\n"
                         "0,0,pen,in_range,10,20,,,,,,,,0,100,200,,,,,,,,,,,,,,,,\n"
                         "0.01,0,pen,in_contact,10,20,,,,,,,,0,100,200,,,,,,,,,,,,,,,,\n"));
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
  EXPECT_THAT(csv.out, HasSubstr(",true,overrun repaired,"));
  const CommandRun text = run_limn({"decode", "-"}, recording);
  EXPECT_THAT(text.out, HasSubstr(" lost>=64 !overrun !repaired\n"));
}

TEST(Decode, TextIsOneLineASample) {
  const CommandRun run = run_limn({"decode", "-"}, small_pen_line());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 15) << "a heading and 14 samples";
}

/// A SpaceNavigator: pushed to the right and twisted, a button, the battery of another, silence.
constexpr const char* k3dMice =
    "D: 0\nN: navigator\nI: 3 046d c626\nD: 1\nN: wireless\nI: 3 256f c62e\n"
    "D: 0\nE: 1.000000 7 01 5e 01 af 00 00 00\nE: 1.008000 7 02 00 00 00 00 51 ff\n"
    "E: 1.016000 3 03 02 00\n"
    "D: 1\nE: 1.020000 3 17 54 01\n";

TEST(Decode, A3dMouseHasVelocitiesButtonsAndCounts) {
  const CommandRun run = run_limn({"decode", "-", "--format", "jsonl"}, k3dMice);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto samples = parse_lines(run.out);
  ASSERT_EQ(samples.size(), 5U);
  EXPECT_EQ(samples[0],
            (json{{"t", 0},
                  {"device", 0},
                  {"motion", {{"mm_per_s", {100.0, -50.0, 0.0}}, {"rad_per_s", {0.0, 0.0, 0.0}}}},
                  {"buttons", json::array()},
                  {"raw", {350, 175, 0, 0, 0, 0}}}));
  EXPECT_EQ(samples[1]["motion"]["rad_per_s"], (json{0.0, 0.0, 0.5}));
  EXPECT_EQ(samples[2]["buttons"], json::array({2}));
  EXPECT_EQ(samples[3]["battery_percent"], 84);
  EXPECT_EQ(samples[3]["device"], 1);
  EXPECT_EQ(samples[4]["silence"], true);
  EXPECT_EQ(samples[4]["t"], 0.108);
  EXPECT_EQ(samples[4]["motion"]["mm_per_s"], (json{0.0, 0.0, 0.0}));
  EXPECT_EQ(samples[4]["disturbances"], json::array({"gap"}));
  EXPECT_EQ(run.err, "5 samples, at least 1 lost, 1 gap\n");
}

TEST(Decode, A3dMouseInTextAndCsv) {
  const CommandRun text = run_limn({"decode", "-"}, k3dMice);
  EXPECT_THAT(text.out, HasSubstr("  0.008000    0 3d_mouse     moving     100.000   -50.000     "
                                  "0.000 mm/s   0.00000  0.00000  0.50000 rad/s\n"));
  EXPECT_THAT(text.out, HasSubstr(" rad/s button2\n"));
  EXPECT_THAT(text.out, HasSubstr(" rad/s battery 84 %\n"));
  const CommandRun csv = run_limn({"decode", "-", "--format", "csv"}, k3dMice);
  EXPECT_THAT(csv.out, HasSubstr("\n0.016,0,3d_mouse,moving,,,,,,,,2,,0,,,,,,100,-50,0,0,0,0.5,350,"
                                 "175,0,0,0,-175,\n"));
  EXPECT_THAT(csv.out, HasSubstr(",0,0,0,0,0,0,84\n"));
  const std::string header = csv.out.substr(0, csv.out.find('\n'));
  std::istringstream rows(csv.out);
  for (std::string row; std::getline(rows, row);) {
    EXPECT_EQ(std::count(row.begin(), row.end(), ','),
              std::count(header.begin(), header.end(), ','))
        << row;
  }
}

TEST(Decode, TheHandOn3dMiceIsAnOption) {
  const auto first_of = [](std::vector<std::string> options) {
    options.insert(options.begin(), {"decode", "-", "--format", "jsonl"});
    const CommandRun run = run_limn(options, k3dMice);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return parse_lines(run.out).at(0)["motion"]["mm_per_s"];
  };
  EXPECT_EQ(first_of({"--mm-per-s", "200"}), (json{200.0, -100.0, 0.0}));
  EXPECT_EQ(first_of({"--dead-zone", "0.5"}), (json{100.0, 0.0, 0.0}));
  EXPECT_EQ(first_of({"--curve", "1"}), (json{100.0, -12.5, 0.0}));
  EXPECT_EQ(first_of({"--axes", "-y,x,x,rx,ry,rz"}), (json{50.0, 100.0, 100.0}));
  EXPECT_EQ(first_of({"--sensitivity", "1,2,0,1,1,1"}), (json{100.0, -100.0, 0.0}));
  EXPECT_EQ(first_of({"--dominant"}), (json{100.0, 0.0, 0.0}));
}

TEST(Decode, WrongOptionsOf3dMiceSayWhatIsRight) {
  const auto refused = [](const std::string& option, const std::string& value) {
    const CommandRun run = run_limn({"decode", "-", option, value}, k3dMice);
    EXPECT_EQ(run.exit_code, 2);
    return run.err;
  };
  EXPECT_THAT(refused("--mm-per-s", "0"), HasSubstr("'0' is no speed above 0, such as 100"));
  EXPECT_THAT(refused("--rad-per-s", "1e9"), HasSubstr("is no speed above 0"));
  EXPECT_THAT(refused("--dead-zone", "1"), HasSubstr("'1' is no number from 0 to 0.9"));
  EXPECT_THAT(refused("--curve", "nan"), HasSubstr("is no number from 0 to 1"));
  EXPECT_THAT(refused("--sensitivity", "1,2"), HasSubstr("is neither one factor nor six"));
  EXPECT_THAT(refused("--axes", "x,y"), HasSubstr("are not six axes, such as x,y,z,rx,ry,-rz"));
  EXPECT_THAT(refused("--axes", "x,y,z,rx,ry,r"), HasSubstr("there is no axis 'r'; did you mean"));
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
