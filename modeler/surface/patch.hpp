#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "modeler/bspline/bernstein.hpp"
#include "modeler/bspline/jet.hpp"
#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

/// A box of a surface's parameters, [low, high] in (u, v).
struct ParameterBox {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();

  Eigen::Vector2d center() const noexcept { return low + 0.5 * (high - low); }
  Eigen::Vector2d half() const noexcept { return 0.5 * (high - low); }
};

/// A part of a surface within one span of each direction, in Bézier form.
///
///     name   symbol  note
///     box            the part's parameters
///     spans          of KnotVector::find_span(), u and v
///     net            w x, w y, w z, w of each control point (w = 1 where polynomial), u fastest
struct Patch {
  ParameterBox box;
  std::array<int, 2> spans = {0, 0};
  BezierShape shape;
  std::vector<double> net;

  /// Whether the Bernstein coefficients of the denominator are, so that hulls hold.
  bool has_positive_weights() const noexcept;

  /// Whether there is a parameter between the ends of `direction`.
  bool can_halve(int direction) const noexcept {
    const double middle = box.center()[direction];
    return middle > box.low[direction] && middle < box.high[direction];
  }

  /// Cuts it in the middle of `direction`: *this becomes the part before, the result is the other.
  Patch halve(int direction);
};

/// The Bézier patches of a surface.
class PatchGrid {
 public:
  explicit PatchGrid(const BsplineSurface& surface);

  /// The spans of a direction that are not empty, ascending.
  const std::vector<int>& spans(int direction) const noexcept {
    return spans_[static_cast<std::size_t>(direction)];
  }
  /// Precondition: each is in spans().
  Patch patch(const std::array<int, 2>& spans) const;

 private:
  BsplineSurface surface_;
  std::array<std::vector<int>, 2> spans_;
  /// Of span degree + i at i, empty where the span is.
  std::array<std::vector<std::vector<double>>, 2> extractions_;
};

/// What is certain about a patch: it lies in two boxes, and its derivatives near those in its
/// middle. With n the normal in the middle,
///
///     |n . (S(u,v) - jet.point)| <= off.point,   |n x (S(u,v) - jet.point)| <= along.point,
///     |n . (S_u(u,v) - jet.du)| <= off.du,   ..   for all (u,v) of `box`.
///
/// From the hulls of Bernstein coefficients of S and its derivatives, for rational ones of
/// numerators that subtract the middle first, so that the bounds shrink with the patch. The parts
/// off the tangent plane tell how the surface bends, those along it only how its parameters do.
struct PatchBound {
  ParameterBox box;
  std::array<int, 2> spans = {0, 0};
  SurfaceJet jet;  ///< at box.center()

  struct Reach {
    double point = 0;
    double du = 0;
    double dv = 0;
    double duu = 0;
    double duv = 0;
    double dvv = 0;
  };
  Reach along;
  Reach off;
  double reach = 0;  ///< |S(u,v) - jet.point|

  Eigen::Vector3d low;  ///< of the box along x, y, z, widened by what rounding may cost
  Eigen::Vector3d high;

  /// The box along the tangent plane: coordinates frame^T (S - jet.point) lie in
  /// [frame_low, frame_high]. Columns of frame: along S_u, in the tangent plane, normal.
  Eigen::Matrix3d frame;
  Eigen::Vector3d frame_low;
  Eigen::Vector3d frame_high;

  /// In x = (u - middle) / h, h the half sides of the box, and tangent coordinates, the middle's
  /// Jacobian is J = [S_u h_u, S_v h_v]: `flatten` is its inverse and least_stretch its smaller
  /// singular value (0 at poles and degenerate edges, where flatten is zero, too).
  Eigen::Matrix2d flatten;
  double least_stretch = 0;
  /// Frobenius norm of J(x) - J on the box, the part in the tangent plane and the whole.
  double turn_along = 0;
  double turn = 0;
  /// Frobenius norms of the second derivatives in x: in the middle, and of what they may change by.
  double second_along = 0;
  double second_off = 0;
  double second_reach_along = 0;
  double second_reach_off = 0;

  /// Below 1 the patch is the graph of a function over its tangent plane; infinite at poles.
  double bending() const noexcept;
};

/// `jet` is the surface's at patch.box.center(). Precondition: patch.has_positive_weights().
PatchBound bound_of(const Patch& patch, const SurfaceJet& jet);

}  // namespace limn
