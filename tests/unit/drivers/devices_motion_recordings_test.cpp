// What real 3D mice sent, as other people noted it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "drivers/devices/evdev_motion_decoder.hpp"
#include "drivers/devices/motion_decoder.hpp"
#include "tests/support/recordings.hpp"

namespace limn {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;
using Counts = std::array<std::int32_t, kMotionAxes>;

constexpr std::uint16_t kLogitech = 0x046D;
constexpr std::uint16_t kNavigator = 0xC626;

std::string note(const char* name) {
  return test::read_file(test::shared_folder() / "traces/3d-mice" / name);
}

/// The hexadecimal numbers of two digits in the lines that do not begin with #, behind a "]".
std::vector<Bytes> hexadecimal_lines(const std::string& text) {
  std::vector<Bytes> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    const auto bracket = line.find(']');
    std::istringstream words(bracket == std::string::npos ? line : line.substr(bracket + 1));
    Bytes& bytes = lines.emplace_back();
    for (std::string word; words >> word;) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
    }
  }
  return lines;
}

TEST(MotionRecordings, ASpaceMouseCompactsReportsDecode) {
  LIMN_NEEDS_RECORDINGS();
  auto decoder = MotionDecoder::make(0x256F, 0xC635, {});
  ASSERT_TRUE(decoder);
  MotionSample last;
  Timestamp time{};
  int reports = 0;
  for (const Bytes& bytes : hexadecimal_lines(note("spacemouse_compact_reports.txt"))) {
    const auto decoded = decoder->decode(Report{0, time += 8ms, bytes});
    EXPECT_EQ(decoded.kind, ReportClass::kMotion);
    ASSERT_EQ(decoded.samples.size(), 1U);
    last = decoded.samples[0];
    ++reports;
  }
  EXPECT_EQ(reports, 6);
  EXPECT_EQ(last.raw, (Counts{0x0D, 0, 0x125, 0x1D, 0, 0x1B}));
  EXPECT_DOUBLE_EQ(last.deflection[2], -293.0 / 350) << "pressed down";
}

TEST(MotionRecordings, ASpaceNavigatorsBytesDecode) {
  LIMN_NEEDS_RECORDINGS();
  Bytes stream;
  for (const Bytes& line : hexadecimal_lines(note("spacenavigator_tap_hidraw.hex"))) {
    stream.insert(stream.end(), line.begin(), line.end());
  }
  auto decoder = MotionDecoder::make(kLogitech, kNavigator, {});
  ASSERT_TRUE(decoder);
  constexpr std::size_t kReport = 7;
  int translations = 0;
  int rotations = 0;
  Timestamp time{};
  for (std::size_t at = 0; at + kReport <= stream.size(); at += kReport) {
    const std::span<const std::uint8_t> bytes(stream.data() + at, kReport);
    const auto decoded = decoder->decode(Report{0, time += 8ms, bytes});
    ASSERT_EQ(decoded.kind, ReportClass::kMotion) << "report " << at / kReport;
    const MotionSample& sample = decoded.samples.back();
    EXPECT_EQ(sample.translation_told, translations == rotations) << "by turns";
    ++(sample.translation_told ? translations : rotations);
    for (const double axis : sample.deflection) EXPECT_LE(std::abs(axis), 1.5);
  }
  EXPECT_GE(translations, 20);
  EXPECT_NEAR(translations, rotations, 1);
}

TEST(MotionRecordings, ASpaceNavigatorsEventNodeDecodes) {
  LIMN_NEEDS_RECORDINGS();
  TraceDevice device;
  device.vendor = kLogitech;
  device.product = kNavigator;
  EvdevMotionDecoder decoder(device);
  std::istringstream in(note("spacenavigator_evtest.txt"));
  std::vector<EvdevEvent> frame;
  std::vector<Counts> samples;
  for (std::string line; std::getline(in, line);) {
    double seconds = 0;
    unsigned type = 0;
    unsigned code = 0;
    int value = 0;
    if (std::sscanf(line.c_str(), "Event: time %lf, type %u (%*[^)]), code %u (%*[^)]), value %d",
                    &seconds, &type, &code, &value) == 4) {
      frame.push_back(
          {{}, static_cast<std::uint16_t>(type), static_cast<std::uint16_t>(code), value});
    } else if (std::sscanf(line.c_str(), "Event: time %lf, --", &seconds) == 1 && !frame.empty()) {
      const Timestamp time(static_cast<std::int64_t>(std::llround(seconds * 1e6)) * 1000);
      for (const MotionSample& one : decoder.decode(EvdevFrame{0, time, frame})) {
        samples.push_back(one.raw);
      }
      frame.clear();
    }
  }
  EXPECT_EQ(samples, (std::vector<Counts>{
                         {0, 0, 0, -4, 0, 0}, {0, -10, 0, -4, 0, 0}, {0, -10, 0, -30, 0, 0}}));
}

}  // namespace
}  // namespace limn
