#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "input/trace/line_source.hpp"
#include "input/trace/trace.hpp"
#include "tests/support/alloc_guard.hpp"

namespace limn::test {
namespace {

constexpr std::size_t kTraceBytes = std::size_t{16} * 1024 * 1024;  // 40 times the buffer

/// `head`, then `unit` over and over until kTraceBytes are given.
class GeneratedBytes final : public ByteSource {
 public:
  GeneratedBytes(std::string head, std::string unit)
      : piece_(std::move(head)), unit_(std::move(unit)) {}

  Expected<std::size_t> read(std::span<char> out) override {
    std::size_t filled = 0;
    while (filled < out.size()) {
      if (given_ == piece_.size()) {
        if (total_ >= kTraceBytes) break;
        piece_ = unit_;
        given_ = 0;
      }
      const std::size_t count = std::min(out.size() - filled, piece_.size() - given_);
      std::memcpy(out.data() + filled, piece_.data() + given_, count);
      given_ += count;
      filled += count;
      total_ += count;
    }
    return filled;
  }

 private:
  std::string piece_;
  std::string unit_;
  std::size_t given_ = 0;
  std::size_t total_ = 0;
};

/// Reads all, and counts the heap allocations after the first few events.
void expect_no_allocation(std::string head, std::string unit, bool salvage = false) {
  TraceOptions options;
  options.salvage = salvage;
  auto reader =
      open_trace(std::make_unique<GeneratedBytes>(std::move(head), std::move(unit)), options);
  ASSERT_TRUE(reader);
  constexpr int kWarmUp = 10;
  for (int i = 0; i < kWarmUp; ++i) ASSERT_TRUE((*reader)->next());
  const AllocGuard guard;
  std::size_t events = 0;
  for (;;) {
    const auto event = (*reader)->next();
    ASSERT_TRUE(event);
    if (std::holds_alternative<TraceEnd>(*event)) break;
    ++events;
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_GT(events, 1000U);
}

TEST(TraceMemory, TheLineBufferIsBounded) {
  LineSource lines(std::make_unique<GeneratedBytes>("", std::string(300'000, 'x') + "\nshort\n"));
  for (;;) {
    const auto line = lines.next();
    ASSERT_TRUE(line);
    if (!line->has_value()) break;
  }
  EXPECT_LE(lines.buffer_bytes(), LineSource::kMaxBufferBytes);
}

TEST(TraceMemory, HidRecorderReportsCostNone) {
  expect_no_allocation(
      "R: 1 c0\n",
      "E: 1.000000 10 10 e0 12 34 56 78 9a bc 00 11\nD: 1\n# comment\n"
      "E: 1.000000 4 01 02 03 04\nD: 0\n#limn a note of more than sixteen bytes\n");
}

TEST(TraceMemory, SalvageCostsNoneWhereNothingIsDamaged) {
  expect_no_allocation("R: 1 c0\n", "E: 1.000000 4 01 02 03 04\n", true);
}

TEST(TraceMemory, UsbhidDumpReportsCostNone) {
  expect_no_allocation("", "001:006:000:STREAM             1568360147.000001\n 09 80 86\n\n");
}

TEST(TraceMemory, EvemuFramesCostNone) {
  expect_no_allocation("# EVEMU 1.2\n",
                       "E: 1.000000 0003 0000 23122\t# EV_ABS / ABS_X\n"
                       "E: 1.000000 0003 0001 123\nE: 1.000000 0000 0000 0000\n");
}

TEST(TraceMemory, StrokeCsvSamplesCostNone) {
  expect_no_allocation("t,x,y,p,alt,az\n", "1.000000,163.935000,3.655000,0.01953,56.0,33.0\n");
}

}  // namespace
}  // namespace limn::test
