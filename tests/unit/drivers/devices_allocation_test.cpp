// The input path allocates nothing after start: a decoder of every family, of a descriptor and of
// kernel frames.

#include <gtest/gtest.h>

#include "drivers/devices/evdev_pen_decoder.hpp"
#include "tests/support/alloc_guard.hpp"
#include "tests/support/rng.hpp"
#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

std::vector<test::ReportBytes> many_reports(test::Rng& rng) {
  std::vector<test::ReportBytes> reports;
  for (int i = 0; i < 400; ++i) {
    reports.push_back(rng.bytes(static_cast<std::size_t>(rng.integer(0, 120))));
    if (!reports.back().empty() && rng.chance(0.9)) {
      constexpr std::array<std::uint8_t, 11> kIds = {0x01, 0x02, 0x03, 0x04, 0x07, 0x08,
                                                     0x09, 0x0A, 0x10, 0x11, 0x80};
      reports.back()[0] = kIds[static_cast<std::size_t>(rng.integer(0, 10))];
    }
  }
  return reports;
}

TEST(Allocation, DecodingAReportOfAnyFamilyAllocatesNothing) {
  test::Rng rng(1);
  const auto reports = many_reports(rng);
  std::size_t samples = 0;
  for (const PenSpec& spec : pen_specs()) {
    auto decoder = PenDecoder::make(test::identity_of(spec), {});
    ASSERT_TRUE(decoder);
    const test::AllocGuard guard;
    Timestamp time{};
    for (const auto& bytes : reports) {
      time += std::chrono::milliseconds(20);
      decoder->decode(Report{0, time, bytes}, [&samples](const PenSample&) { ++samples; });
      samples += decoder->advance(0, time + kLeavingTimeout / 2).size();
    }
    ASSERT_EQ(guard.count(), 0U) << spec.name;
  }
  EXPECT_GT(samples, 5000U);
}

TEST(Allocation, DecodingAKernelFrameAllocatesNothing) {
  TraceDevice device;
  device.axes = {{0, 0, 1000, 0, 0, 10}, {1, 0, 1000, 0, 0, 10}, {0x18, 0, 255, 0, 0, 0}};
  auto decoder = EvdevPenDecoder::make(device);
  ASSERT_TRUE(decoder);
  std::size_t samples = 0;
  const test::AllocGuard guard;
  for (int i = 0; i < 100; ++i) {
    const std::array<EvdevEvent, 4> events = {
        {{{}, 3, 0, i}, {{}, 3, 1, i}, {{}, 1, 0x140, 1}, {{}, 1, 0x14A, i % 2}}};
    samples += decoder->decode(EvdevFrame{0, {}, events}).size();
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_GE(samples, 100U);
}

}  // namespace
}  // namespace limn
