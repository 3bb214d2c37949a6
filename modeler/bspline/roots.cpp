#include "modeler/bspline/roots.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "input/base/expect.hpp"

namespace limn {
namespace {

/// Intervals are not halved below this length.
constexpr double kShortest = 1e-14;
/// Roots nearer than this are one.
constexpr double kSameRoot = 1e-11;

/// Sign changes of the coefficients, those within the noise left out.
int sign_changes(std::span<const double> c, double noise) {
  int changes = 0;
  int last = 0;
  for (const double x : c) {
    const int sign = x > noise ? 1 : x < -noise ? -1 : 0;
    if (sign == 0) continue;
    if (last != 0 && sign != last) ++changes;
    last = sign;
  }
  return changes;
}

bool is_noise(std::span<const double> c, double noise) {
  return std::all_of(c.begin(), c.end(), [noise](double x) { return std::abs(x) <= noise; });
}

/// Halves c at its middle: c becomes the left part, the result is the right one.
std::vector<double> halve(std::vector<double>& c) {
  std::vector<double> line = c;
  std::vector<double> right(c.size());
  const std::size_t n = c.size();
  for (std::size_t level = 0; level < n; ++level) {
    c[level] = line[0];
    right[n - 1 - level] = line[n - 1 - level];
    for (std::size_t k = 0; k + 1 < n - level; ++k) line[k] = 0.5 * (line[k] + line[k + 1]);
  }
  return right;
}

class RootFinder {
 public:
  RootFinder(std::span<const double> whole, double noise) : whole_(whole), noise_(noise) {}

  std::vector<double> run() {
    visit({whole_.begin(), whole_.end()}, 0, 1);
    std::sort(found_.begin(), found_.end(),
              [](const Interval& a, const Interval& b) { return a.low < b.low; });
    std::vector<Interval> merged;
    for (const Interval& next : found_) {
      if (!merged.empty() && next.low - merged.back().high <= kSameRoot) {
        merged.back().high = std::max(merged.back().high, next.high);
      } else {
        merged.push_back(next);
      }
    }
    std::vector<double> roots;
    roots.reserve(merged.size());
    for (const Interval& root : merged) roots.push_back(root.low + 0.5 * (root.high - root.low));
    return roots;
  }

 private:
  /// Holds a root: a point, or a piece in which all is noise.
  struct Interval {
    double low;
    double high;
  };

  void add(double t) { found_.push_back({t, t}); }

  void visit(std::vector<double> c, double low, double high) {
    const bool low_zero = std::abs(c.front()) <= noise_;
    const bool high_zero = std::abs(c.back()) <= noise_;
    const int changes = sign_changes(c, noise_);
    const bool touches =
        std::any_of(c.begin(), c.end(), [&](double x) { return std::abs(x) <= noise_; });
    if (changes == 0 && !touches) return;
    if (changes == 0 && all_but_ends_clear(c)) {  // zero at an end only
      if (low_zero) add(low);
      if (high_zero) add(high);
      return;
    }
    if (changes == 1 && !low_zero && !high_zero) return bracket(low, high);
    if (high - low < kShortest || is_noise(c, noise_)) {
      found_.push_back({low, high});
      return;
    }
    std::vector<double> right = halve(c);
    const double middle = low + 0.5 * (high - low);
    visit(std::move(c), low, middle);
    visit(std::move(right), middle, high);
  }

  bool all_but_ends_clear(const std::vector<double>& c) const {
    for (std::size_t i = 1; i + 1 < c.size(); ++i) {
      if (std::abs(c[i]) <= noise_) return false;
    }
    return c.size() > 2 || !(std::abs(c.front()) <= noise_ && std::abs(c.back()) <= noise_);
  }

  /// One sign change, ends of opposite signs: bisection with the secant where that is better.
  void bracket(double low, double high) {
    double f_low = bernstein_value(whole_, low);
    double f_high = bernstein_value(whole_, high);
    for (int step = 0; step < 200 && high - low > std::numeric_limits<double>::epsilon() * high;
         ++step) {
      double middle = low - f_low * (high - low) / (f_high - f_low);
      if (step % 3 == 2 || !(middle > low && middle < high)) middle = low + 0.5 * (high - low);
      if (middle == low || middle == high) break;
      const double f = bernstein_value(whole_, middle);
      if (f == 0) {
        add(middle);
        return;
      }
      if ((f < 0) == (f_low < 0)) {
        low = middle;
        f_low = f;
      } else {
        high = middle;
        f_high = f;
      }
    }
    add(std::abs(f_low) < std::abs(f_high) ? low : high);
  }

  std::span<const double> whole_;
  double noise_;
  std::vector<Interval> found_;
};

}  // namespace

Roots bernstein_roots(std::span<const double> coefficients, double noise) {
  LIMN_EXPECT(!coefficients.empty() && noise >= 0);
  if (is_noise(coefficients, noise)) return {{}, true};
  return {RootFinder(coefficients, noise).run(), false};
}

double bernstein_value(std::span<const double> coefficients, double t) {
  std::vector<double> line(coefficients.begin(), coefficients.end());
  for (std::size_t left = line.size(); left > 1; --left) {
    for (std::size_t k = 0; k + 1 < left; ++k) line[k] += t * (line[k + 1] - line[k]);
  }
  return line[0];
}

std::vector<double> bernstein_product(std::span<const double> a, std::span<const double> b) {
  // In the scaled basis, binom(p, k) times a coefficient, the product is a convolution.
  const auto scale = [](std::span<const double> c, bool back) {
    std::vector<double> out(c.begin(), c.end());
    double binomial = 1;
    const auto p = static_cast<double>(c.size() - 1);
    for (std::size_t k = 0; k < c.size(); ++k) {
      out[k] = back ? out[k] / binomial : out[k] * binomial;
      binomial = binomial * (p - static_cast<double>(k)) / (static_cast<double>(k) + 1);
    }
    return out;
  };
  const std::vector<double> x = scale(a, false);
  const std::vector<double> y = scale(b, false);
  std::vector<double> out(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < y.size(); ++j) out[i + j] += x[i] * y[j];
  }
  return scale(out, true);
}

}  // namespace limn
