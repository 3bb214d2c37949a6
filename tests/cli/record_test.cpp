// What `limn record` leaves on the disk when something ends it early: SIGKILL, a disk that fills.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/live_tablet.hpp"
#include "tests/cli/sample_traces.hpp"
#include "tests/cli/simulated_usb.hpp"
#include "tests/support/recordings.hpp"

namespace limn::test {
namespace {

using nlohmann::json;
using testing::EndsWith;
using testing::HasSubstr;

/// A USB pen that sends so many reports at once, more than one piece of the file, and then none;
/// umockdev keeps reports apart only on USB.
class HidPen {
 public:
  static constexpr int kReports = 3000;

  HidPen() {
    usb_.report_descriptor = small_pen_descriptor();
    usb_.give_descriptor();
    std::string played = small_pen_header();
    for (int i = 0; i < kReports; ++i) {
      const int x = i % 1000;
      const std::uint8_t flags = i == 0 ? 2 : 3;  // it comes near before it touches
      const SimulatedUsb::Bytes report = {1, flags, low(x), high(x), 100, 0};
      usb_.send(report, 64);
      char line[64];
      std::snprintf(line, sizeof line, "E: %d.000000 6 01 %02x %02x %02x 64 00\n", i, flags,
                    report[2], report[3]);
      played += line;
    }
    played_ = folder_.write("played.hid", played).string();
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  /// All that it sends, as a recording.
  const std::string& played() const { return played_; }

  /// Records it, `before` being a shell's commands ahead.
  CommandRun record(const std::string& file, const std::string& before) const {
    return usb_.limn("record --backend usb -o " + file, before);
  }

 private:
  static std::uint8_t low(int value) { return static_cast<std::uint8_t>(value & 0xFF); }
  static std::uint8_t high(int value) { return static_cast<std::uint8_t>(value >> 8); }

  TempFolder folder_;
  SimulatedUsb usb_;
  std::string played_;
};

/// What `limn decode` prints of the samples of a recording, times left out.
std::vector<json> samples_in(const CommandRun& decoded) {
  std::vector<json> samples;
  std::istringstream lines(decoded.out);
  for (std::string line; std::getline(lines, line);) {
    samples.push_back(json::parse(line));
    samples.back().erase("t");
  }
  return samples;
}

/// Those of a recording that is whole.
std::vector<json> samples_of(const std::string& file) {
  const CommandRun decoded = run_limn({"decode", file, "--format", "jsonl"});
  EXPECT_EQ(decoded.exit_code, 0) << decoded.err;
  return samples_in(decoded);
}

void expect_beginning_of(const std::vector<json>& all, const std::vector<json>& samples) {
  ASSERT_LE(samples.size(), all.size());
  for (std::size_t i = 0; i < samples.size(); ++i) ASSERT_EQ(samples[i], all[i]) << i;
}

/// The samples of a LiveTablet's recording stand where its steps led.
void expect_steps(const std::vector<json>& samples) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(samples[i]["raw"]["x"], 1000 + 100 * i);
    ASSERT_EQ(samples[i]["state"], i < 2 ? "in_range" : "in_contact") << i;
  }
}

/// Waits two seconds; or until the file has not grown for one: what is not synced never shows.
constexpr const char* kTwoSeconds = "sleep 2";
std::string until_still(const std::string& file) {
  const std::string size = "$(wc -c <" + file + ")";
  return "was=; for i in $(seq 30); do now=" + size +
         "; [ \"$now\" != \"$was\" ] || break; was=$now; sleep 1; done";
}

/// A shell script that runs "$@", does `when` once the first report is in the file, and ends it by
/// SIGKILL.
std::string kill_script(const TempFolder& folder, const std::string& file,
                        const std::string& when) {
  return folder
      .write("kill", "\"$@\" &\nuntil grep -q '^E: ' " + file +
                         " 2>/dev/null; do sleep 0.02; done\n" + when +
                         "\nkill -KILL $!\nwait $!\n")
      .string();
}

/// The last line of a recording cut short, down to its first byte: strict reading names the line
/// behind all samples before it, and --salvage reads them without an error.
void expect_torn_line_is_tolerated(const std::string& whole, const std::vector<json>& samples) {
  ASSERT_THAT(whole, EndsWith("\n"));
  const std::size_t line = whole.rfind('\n', whole.size() - 2) + 1;
  const auto number = std::to_string(std::count(whole.begin(), whole.end(), '\n'));
  for (const std::size_t length : {1, 5, 14, int(whole.size() - line) - 3}) {
    SCOPED_TRACE(whole.substr(line, length));
    const std::string torn = whole.substr(0, line + length);
    const CommandRun strict = run_limn({"decode", "-", "--format", "jsonl"}, torn);
    EXPECT_EQ(strict.exit_code, 1);
    EXPECT_THAT(strict.err, HasSubstr("line " + number + ": "));
    EXPECT_THAT(strict.err, HasSubstr("add --salvage to skip the damaged part\n"));
    const CommandRun salvaged = run_limn({"decode", "-", "--salvage", "--format", "jsonl"}, torn);
    EXPECT_EQ(salvaged.exit_code, 0) << salvaged.err;
    EXPECT_THAT(salvaged.err, HasSubstr(", 1 damaged part\n"));
    for (const CommandRun& run : {strict, salvaged}) {
      const auto before = samples_in(run);
      EXPECT_EQ(before.size(), samples.size() - 1);
      expect_beginning_of(samples, before);
    }
  }
}

class Record : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_umockdev()) GTEST_SKIP() << "umockdev is not installed";
  }
};

class RecordHid : public Record {
 protected:
  void SetUp() override {
    if (LIMN_HAS_LIBUSB == 0) GTEST_SKIP() << "this build has no libusb";
    Record::SetUp();
  }
};

TEST_F(RecordHid, SigkillCostsNoReportThatIsASecondOld) {
  const HidPen pen;
  const TempFolder folder;
  const std::string file = folder.path() / "mine.hid";
  const CommandRun run =
      pen.record(file, "set -- sh " + kill_script(folder, file, until_still(file)) + " \"$@\"");
  ASSERT_EQ(run.exit_code, 128 + SIGKILL) << run.err;
  const auto samples = samples_of(file);
  EXPECT_EQ(samples.size(), std::size_t{HidPen::kReports});
  expect_beginning_of(samples_of(pen.played()), samples);
  expect_torn_line_is_tolerated(read_file(file), samples);
}

TEST_F(Record, SigkillCostsNoFrameThatIsASecondOld) {
  constexpr int kSteps = 190;      // 3.8 s
  constexpr int kSurelySent = 30;  // of 100 within 2 s, on the slowest machine
  const LiveTablet tablet({}, kSteps);
  const TempFolder folder;
  const std::string file = folder.path() / "mine.evemu";
  const CommandRun run =
      tablet.limn(std::string("record ") + SimulatedTablet::kEvent + " -o " + file,
                  "sh " + kill_script(folder, file, kTwoSeconds));
  ASSERT_EQ(run.exit_code, 128 + SIGKILL) << run.err;
  const auto samples = samples_of(file);
  EXPECT_GE(samples.size(), std::size_t{kSurelySent});
  expect_steps(samples);
  expect_torn_line_is_tolerated(read_file(file), samples);
}

/// The error of a file that may not grow on.
std::string too_large(const std::string& file) {
  return "limn: " + file +
         ": cannot write: File too large; raise the limit of file sizes (ulimit -f) or choose "
         "another disk; what was recorded before stands\n";
}

TEST_F(RecordHid, ADiskThatFillsWithinAPieceKeepsItsWholeReports) {
  constexpr std::size_t kBytes = 16 * 512;  // as dash counts
  const HidPen pen;
  const TempFolder folder;
  const std::string file = folder.path() / "mine.hid";
  const CommandRun run = pen.record(file, "ulimit -f 16");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.err, too_large(file));
  const std::string text = read_file(file);
  EXPECT_LE(text.size(), kBytes);
  EXPECT_GT(text.size(), kBytes - std::string("E: 0.000000 6 01 03 00 00 64 00\n").size());
  EXPECT_THAT(text, EndsWith(" 64 00\n"));
  const auto samples = samples_of(file);
  EXPECT_GT(samples.size(), 200u);
  expect_beginning_of(samples_of(pen.played()), samples);
}

TEST_F(Record, ADiskThatFillsBetweenFramesKeepsThemWhole) {
  constexpr std::size_t kBytes = 8 * 512;
  const LiveTablet tablet({}, 150);
  const TempFolder folder;
  const std::string file = folder.path() / "mine.evemu";
  const CommandRun run =
      tablet.limn(std::string("record ") + SimulatedTablet::kEvent + " -o " + file,
                  "sh -c 'ulimit -f 8; exec \"$@\"' sh");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.err, too_large(file));
  const std::string text = read_file(file);
  EXPECT_LE(text.size(), kBytes);
  EXPECT_THAT(text, EndsWith(" 0000 0000 0\n")) << "SYN_REPORT";
  const auto samples = samples_of(file);
  EXPECT_GT(samples.size(), 20u);
  expect_steps(samples);
}

}  // namespace
}  // namespace limn::test
