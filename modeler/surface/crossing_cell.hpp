#pragma once

#include <Eigen/Core>

#include "modeler/surface/crossing_jets.hpp"
#include "modeler/surface/surface_index.hpp"

namespace limn {

/// Parts of two surfaces, in coordinates x of -1 to 1 over both of their boxes, and
/// G(x) = S_1 - S_2 on them.
///
/// Let M be the Jacobian of G in the middle, M_k what is left of it without column k, and T a bound
/// of how much the Jacobian differs from M in the box (Frobenius norms). If |M_k^-1| T < 1, then
/// for each value of x_k there is one place at most where G is 0: the others follow from it by a
/// contraction.
///
/// Keeps references to what it is made from.
class CrossingCell {
 public:
  CrossingCell(const SurfaceIndex& first, const PatchBound& a, const SurfaceIndex& second,
               const PatchBound& b);

  /// Whether that product is so small that excludes() is sharp.
  bool is_transversal() const noexcept;
  /// k, the coordinate of which the crossing is a function.
  int axis() const noexcept { return axis_; }

  CrossingPlace place(const Eigen::Vector4d& x) const { return center_ + x.cwiseProduct(half_); }
  Eigen::Vector4d local(const CrossingPlace& place) const {
    return (place - center_).cwiseQuotient(half_);
  }

  /// Where G is 0 at x_axis = c, by Newton's iteration in which the others stay within -2 to 2: for
  /// a transversal cell, the only place that its box may have. Whether it converged.
  bool solve(double c, Eigen::Vector4d& x) const;

  /// Whether no crossing in the box has x_axis within `reach` of c. `x` is that of solve(), or any.
  bool excludes(double c, double reach, const Eigen::Vector4d& x) const;

 private:
  using Jacobian = Eigen::Matrix<double, 3, 4>;

  CrossingJets jets(const Eigen::Vector4d& x) const;
  Jacobian jacobian(const CrossingJets& at) const { return at.jacobian() * half_.asDiagonal(); }

  const SurfaceIndex& first_;
  const SurfaceIndex& second_;
  const PatchBound& a_;
  const PatchBound& b_;
  CrossingPlace center_;
  CrossingPlace half_;
  int axis_ = 0;
  double contraction_;
  double turn_;         ///< T
  double rounding_;     ///< of G and of its derivatives
  double most_second_;  ///< of the second derivatives, in the same norm
};

}  // namespace limn
