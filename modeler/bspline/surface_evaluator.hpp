#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <utility>

#include "modeler/bspline/basis_table.hpp"
#include "modeler/bspline/jet.hpp"
#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

/// A point of a surface with its tangents and unit normal (zero where there is none).
struct SurfaceFrame {
  Eigen::Vector3d point;
  Eigen::Vector3d du;
  Eigen::Vector3d dv;
  Eigen::Vector3d normal;
};

/// A surface prepared for many evaluations: tables of its basis functions (BasisTable), and kernels
/// that treat the coordinates of a point at once. Several times as fast as TensorSpline's own
/// evaluation, from which it differs by rounding; degrees above BasisTable::kMostDegree are left to
/// that. Each function gives the same bits on every processor.
///
/// Holds a copy of the surface, which shares its control points. Immutable after construction, so
/// any number of threads may read one. Parameters are brought into the domain as by
/// KnotVector::clamp().
class SurfaceEvaluator {
 public:
  /// O(spans p^3) a direction.
  explicit SurfaceEvaluator(BsplineSurface surface);

  const BsplineSurface& surface() const noexcept { return surface_; }

  SurfaceJet jet(double u, double v) const noexcept;
  Eigen::Vector3d point(double u, double v) const noexcept { return jet(u, v).point; }

  /// The jet of one polynomial piece, which goes on outside its spans (of KnotVector::find_span()):
  /// limits from either side of a knot line.
  SurfaceJet jet_in_spans(const std::array<int, 2>& spans, double u, double v) const noexcept;

  /// out[i] = the jet at (at[i].x(), at[i].y()). Precondition: equal sizes.
  void jets(std::span<const Eigen::Vector2d> at, std::span<SurfaceJet> out) const noexcept;

  /// out[i + us.size() j] = at (us[i], vs[j]): a grid needs the basis functions and the sums along
  /// v once a line. Allocates O(us.size() + control points of a row).
  /// Precondition: out.size() == us.size() * vs.size().
  void grid(std::span<const double> us, std::span<const double> vs,
            std::span<SurfaceFrame> out) const;

 private:
  BsplineSurface surface_;
  std::array<BasisTable, 2> tables_;
  bool usable_;  ///< both tables
};

}  // namespace limn
