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
    band_.assign(static_cast<std::size_t>(inner_ + kBand - 1) * kBand, 0.0);
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
  double& band(int row, int column) noexcept { return band_row(row)[kBand - 1 - (row - column)]; }
  /// Entries of columns row - kBand + 1 .. row; valid from row 1 - kBand on.
  double* band_row(int row) noexcept {
    return band_.data() + static_cast<std::ptrdiff_t>(row + kBand - 1) * kBand;
  }
  double& border(int row, int column) noexcept {
    return border_rows_[static_cast<std::size_t>(row) * static_cast<std::size_t>(rows_) +
                        static_cast<std::size_t>(column)];
  }

  /// Cholesky of the banded part, diagonal kept as its reciprocal, and forward substitution. Rows
  /// of zeros in front make all loops the same length.
  bool factor_band() noexcept {
    for (int r = 0; r < inner_; ++r) {
      double* row = band_row(r);
      double diagonal = row[kBand - 1];
      for (int c = 0; c < kBand - 1; ++c) {
        const double* other = band_row(r - kBand + 1 + c) + (kBand - 1 - c);
        double sum = row[c];
        for (int k = 0; k < c; ++k) sum -= row[k] * other[k];
        row[c] = sum * other[c];
        diagonal -= row[c] * row[c];
      }
      if (!(diagonal > 0)) return false;
      row[kBand - 1] = 1.0 / std::sqrt(diagonal);
      const int low = std::max(0, r - kBand + 1);
      for (int q = 0; q < kRight; ++q) {
        double sum = right(r, q);
        for (int k = low; k < r; ++k) sum -= band(r, k) * right(k, q);
        right(r, q) = sum * row[kBand - 1];
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
  std::vector<double> band_;         // kBand - 1 rows of zeros, inner_ rows, the diagonal last
  std::vector<double> border_rows_;  // border_ rows of rows_ entries
  std::vector<double> right_;
};

}  // namespace limn::fit_detail
