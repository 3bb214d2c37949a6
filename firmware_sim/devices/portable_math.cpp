#include "firmware_sim/devices/portable_math.hpp"

#include <bit>
#include <cstdint>

namespace limn::firmware {
namespace {

constexpr double kLn2 = 0.693147180559945309417;

/// The Maclaurin series of sine for |x| <= pi/2 (the first term left out is below 2e-15).
double sin_near_zero(double x) noexcept {
  const double square = x * x;
  double sum = 0;
  for (int n = 19; n >= 3; n -= 2) sum = (sum + 1) * -square / (n * (n - 1));
  return x * (sum + 1);
}

}  // namespace

double portable_sin(double x) noexcept {
  // To -pi/2..pi/2, where sin(x) = sin(r) for even multiples of pi and -sin(r) for odd ones.
  const double turns = x / kPi;
  const auto half_turns = static_cast<std::int64_t>(turns + (turns < 0 ? -0.5 : 0.5));
  const double s = sin_near_zero(x - static_cast<double>(half_turns) * kPi);
  return half_turns % 2 == 0 ? s : -s;
}

double portable_cos(double x) noexcept { return portable_sin(x + kPi / 2); }

double portable_log(double x) noexcept {
  // x = m 2^e with m in 0.75..1.5; log m = 2 artanh((m - 1) / (m + 1)), argument at most 1/5.
  const auto bits = std::bit_cast<std::uint64_t>(x);
  auto exponent = static_cast<std::int64_t>(bits >> 52) - 1023;
  auto mantissa = std::bit_cast<double>((bits & 0xFFFFFFFFFFFFFU) | std::uint64_t{1023} << 52);
  if (mantissa > 1.5) {
    mantissa *= 0.5;
    ++exponent;
  }
  const double z = (mantissa - 1) / (mantissa + 1);
  const double square = z * z;
  double sum = 0;
  for (int n = 21; n >= 1; n -= 2) sum = sum * square + 1.0 / n;
  return 2 * z * sum + static_cast<double>(exponent) * kLn2;
}

double portable_cbrt(double x) noexcept {
  // Scaled to 1..8, where Newton's steps from 1.5 converge to full precision in six.
  double scale = 1;
  while (x > 8) {
    x *= 0.125;
    scale *= 2;
  }
  while (x < 1) {
    x *= 8;
    scale *= 0.5;
  }
  double root = 1.5;
  for (int i = 0; i < 6; ++i) root -= (root - x / (root * root)) / 3;
  return root * scale;
}

}  // namespace limn::firmware
