#pragma once

#include "input/base/error.hpp"

namespace limn {

class SplineData;

/// Whether the denominator of a rational spline, w(u) = sum_i N_i(u) w_i, is positive on the whole
/// domain. Positive weights prove it; a weight may be 0 or less as long as w is not. The spans with
/// such weights are cut in halves until the Bernstein coefficients of w are positive (w is then
/// above the smallest), or a corner is not.
/// Errors, kNumeric: w is not positive at a stated parameter, or what is left to prove is smaller
/// than limn goes (w touches 0). Precondition: spline.is_rational().
Expected<void> prove_positive_denominator(const SplineData& spline);

}  // namespace limn
