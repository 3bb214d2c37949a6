#pragma once

/// The few transcendental functions that the hand needs, from + - * / and sqrt alone: every IEEE
/// machine gives the same bits, which no two C libraries promise. Absolute error below 1e-12 in the
/// ranges named.
namespace limn::firmware {

inline constexpr double kPi = 3.14159265358979323846;

/// sin(x), |x| <= 1e3.
double portable_sin(double x) noexcept;

/// cos(x), |x| <= 1e3.
double portable_cos(double x) noexcept;

/// Natural logarithm of x, 1e-300 <= x <= 1e300.
double portable_log(double x) noexcept;

/// Cube root of x, 1e-9 <= x <= 1e9; relative error below 1e-12.
double portable_cbrt(double x) noexcept;

}  // namespace limn::firmware
