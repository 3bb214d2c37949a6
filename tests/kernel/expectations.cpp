#include "tests/kernel/expectations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace limn::test {
namespace {

constexpr std::uint64_t kSeed = 7;

/// Whether Linux's side of a pen tells the same of both.
bool same_state(const PenSample& a, const PenSample& b, int counts) {
  const double degree = std::numbers::pi / 180 * (counts + 0.01);
  return a.state == b.state && a.buttons == b.buttons && std::abs(a.raw.x - b.raw.x) <= counts &&
         std::abs(a.raw.y - b.raw.y) <= counts &&
         std::abs(a.raw.pressure - b.raw.pressure) <= counts &&
         std::abs(a.tilt_x_rad - b.tilt_x_rad) <= degree &&
         std::abs(a.tilt_y_rad - b.tilt_y_rad) <= degree;
}

/// What is left where only changes are told, of a pen in range.
std::vector<PenSample> changes_of(const std::vector<PenSample>& samples) {
  std::vector<PenSample> changes;
  for (const PenSample& sample : samples) {
    if (sample.state == PenState::kOutOfRange) continue;
    if (changes.empty() || !same_state(changes.back(), sample, 0)) changes.push_back(sample);
  }
  return changes;
}

}  // namespace

Held::Held(std::string_view device_name, std::string_view movement)
    : name(device_name),
      made(firmware::make_simulated_device(device_name, movement, kSeed)),
      device(made->bus()) {}

Taken expected_from(std::string_view name, std::string_view movement, std::size_t enough,
                    Setup setup) {
  const auto made = firmware::make_simulated_device(name, movement, kSeed);
  return expected_of(made->bus(), enough, setup);
}

void expect_reports(const Taken& taken, const Taken& expected, std::size_t enough) {
  EXPECT_EQ(taken.report_count, enough);
  for (const auto& [interface, reports] : taken.reports) {
    const auto found = expected.reports.find(interface);
    ASSERT_NE(found, expected.reports.end()) << "interface " << interface << " is silent";
    ASSERT_LE(reports.size(), found->second.size());
    const auto [differ, other] =
        std::mismatch(reports.begin(), reports.end(), found->second.begin());
    if (differ == reports.end()) continue;
    ADD_FAILURE() << "report " << differ - reports.begin() << " of " << reports.size()
                  << " of interface " << interface << " is " << testing::PrintToString(*differ)
                  << " for " << testing::PrintToString(*other);
  }
}

void expect_motions(const Taken& taken, const Taken& expected) {
  auto got = motions_of(taken.trace);
  const auto all = motions_of(expected.trace);
  // A recording that ends in mid-motion ends that, too.
  if (!got.empty() && got.back().silence) got.pop_back();
  EXPECT_EQ(got.size(), taken.report_count);
  ASSERT_LE(got.size(), all.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    SCOPED_TRACE("motion " + std::to_string(i));
    const MotionSample& a = got[i];
    const MotionSample& b = all[i];
    ASSERT_EQ(a.raw, b.raw);
    ASSERT_EQ(a.deflection, b.deflection);
    ASSERT_EQ(a.buttons, b.buttons);
    ASSERT_EQ(a.battery_percent, b.battery_percent);
    ASSERT_EQ(a.lost, b.lost);
    ASSERT_EQ(a.disturbances, b.disturbances);
    const auto marks = [](const MotionSample& one) {
      return std::array{one.translation_told, one.rotation_told, one.rests_exactly,
                        one.changes_only,     one.silence,       one.lost_estimated};
    };
    ASSERT_EQ(marks(a), marks(b));
  }
}

void expect_changes(const Taken& kernel, const Taken& expected, std::size_t at_least) {
  const auto got = changes_of(samples_of(kernel.trace));
  const auto all = changes_of(samples_of(expected.trace));
  EXPECT_GE(got.size(), at_least);
  ASSERT_LE(got.size(), all.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    ASSERT_TRUE(same_state(got[i], all[i], 1))
        << "change " << i << ": " << name(got[i].state) << " " << got[i].raw.x << ", "
        << got[i].raw.y << ", " << got[i].raw.pressure << ", tilt " << got[i].tilt_x_rad << ", "
        << got[i].tilt_y_rad << " for " << name(all[i].state) << " " << all[i].raw.x << ", "
        << all[i].raw.y << ", " << all[i].raw.pressure << ", tilt " << all[i].tilt_x_rad << ", "
        << all[i].tilt_y_rad;
  }
}

}  // namespace limn::test
