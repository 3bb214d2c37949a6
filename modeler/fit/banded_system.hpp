#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::fit_detail {

/// Symmetric positive definite system of the normal equations of a cubic spline fit:
///
///     A X = B,    A of n x n blocks of kBlock x kBlock, B of n kBlock rows and kRight columns.
///
/// Block (i, j) is non-zero only for |i - j| <= 3, or cyclically so for a periodic spline: then the
/// last three block columns are a border around a banded matrix. Cholesky, O(n kBlock^3) time and
/// O(n kBlock^2) memory in both cases; never dense.
template <int kBlock, int kRight>
class BandedSystem {
 public:
  static constexpr int kReach = 3;                     ///< block columns beside the diagonal
  static constexpr int kBand = (kReach + 1) * kBlock;  ///< stored entries of a row

  /// A zero system of n block rows. Precondition: n >= 1, for a cyclic one n > kReach.
  void reset(int n, bool cyclic) {
    rows_ = n * kBlock;
    border_ = cyclic ? kReach * kBlock : 0;
    inner_ = rows_ - border_;
    band_.assign(static_cast<std::size_t>(inner_) * kBand, 0.0);
    border_rows_.assign(static_cast<std::size_t>(border_) * static_cast<std::size_t>(rows_), 0.0);
    right_.assign(static_cast<std::size_t>(rows_) * kRight, 0.0);
  }

  /// The stored entry (row, column) of the lower triangle, scalars counted.
  double& at(int row, int column) noexcept {
    if (row < column) std::swap(row, column);
    return row < inner_ ? band(row, column) : border(row - inner_, column);
  }
  double& right(int row, int column) noexcept {
    return right_[static_cast<std::size_t>(row) * kRight + static_cast<std::size_t>(column)];
  }

  /// Solves in place; right() holds the answer. False where A is not numerically positive definite.
  bool solve() noexcept {
    if (!factor_band() || (border_ > 0 && !factor_border())) return false;
    back_substitute();
    return true;
  }

 private:
  double& band(int row, int column) noexcept {
    return band_[static_cast<std::size_t>(row) * kBand +
                 static_cast<std::size_t>(kBand - 1 - (row - column))];
  }
  double& border(int row, int column) noexcept {
    return border_rows_[static_cast<std::size_t>(row) * static_cast<std::size_t>(rows_) +
                        static_cast<std::size_t>(column)];
  }

  /// Cholesky of the banded part, diagonal kept as its reciprocal, and forward substitution.
  bool factor_band() noexcept {
    for (int r = 0; r < inner_; ++r) {
      const int low = std::max(0, r - kBand + 1);
      for (int c = low; c < r; ++c) {
        double sum = band(r, c);
        for (int k = std::max(low, c - kBand + 1); k < c; ++k) sum -= band(r, k) * band(c, k);
        band(r, c) = sum * band(c, c);
      }
      double diagonal = band(r, r);
      for (int k = low; k < r; ++k) diagonal -= band(r, k) * band(r, k);
      if (!(diagonal > 0)) return false;
      band(r, r) = 1.0 / std::sqrt(diagonal);
      for (int q = 0; q < kRight; ++q) {
        double sum = right(r, q);
        for (int k = low; k < r; ++k) sum -= band(r, k) * right(k, q);
        right(r, q) = sum * band(r, r);
      }
    }
    return true;
  }

  /// The same for the dense rows below it.
  bool factor_border() noexcept {
    for (int b = 0; b < border_; ++b) {
      for (int c = 0; c < inner_; ++c) {
        double sum = border(b, c);
        for (int k = std::max(0, c - kBand + 1); k < c; ++k) sum -= border(b, k) * band(c, k);
        border(b, c) = sum * band(c, c);
      }
      for (int c = 0; c <= b; ++c) {
        double sum = border(b, inner_ + c);
        for (int k = 0; k < inner_ + c; ++k) sum -= border(b, k) * border(c, k);
        if (c == b && !(sum > 0)) return false;
        border(b, inner_ + c) = c == b ? 1.0 / std::sqrt(sum) : sum * border(c, inner_ + c);
      }
      for (int q = 0; q < kRight; ++q) {
        double sum = right(inner_ + b, q);
        for (int k = 0; k < inner_ + b; ++k) sum -= border(b, k) * right(k, q);
        right(inner_ + b, q) = sum * border(b, inner_ + b);
      }
    }
    return true;
  }

  void back_substitute() noexcept {
    for (int q = 0; q < kRight; ++q) {
      for (int b = border_ - 1; b >= 0; --b) {
        const double x = right(inner_ + b, q) * border(b, inner_ + b);
        right(inner_ + b, q) = x;
        for (int k = 0; k < inner_ + b; ++k) right(k, q) -= border(b, k) * x;
      }
      for (int r = inner_ - 1; r >= 0; --r) {
        const double x = right(r, q) * band(r, r);
        right(r, q) = x;
        for (int k = std::max(0, r - kBand + 1); k < r; ++k) right(k, q) -= band(r, k) * x;
      }
    }
  }

  int rows_ = 0;
  int border_ = 0;
  int inner_ = 0;
  std::vector<double> band_;         // inner_ rows of kBand entries, the diagonal last
  std::vector<double> border_rows_;  // border_ rows of rows_ entries
  std::vector<double> right_;
};

}  // namespace limn::fit_detail
