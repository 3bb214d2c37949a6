#pragma once

#include <span>
#include <utility>

#include "modeler/bspline/basis_table.hpp"
#include "modeler/bspline/jet.hpp"
#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

namespace bspline_detail {

/// A curve of any dimension as CurveEvaluator has it.
class PreparedCurve {
 public:
  explicit PreparedCurve(SplineData curve);
  /// Of each u the point and three derivatives, dimension() doubles each.
  void jets(std::span<const double> us, double* out) const noexcept;

 private:
  SplineData curve_;
  BasisTable table_;
};

}  // namespace bspline_detail

/// A curve prepared for many evaluations, as SurfaceEvaluator is of surfaces: differs from
/// TensorSpline's own evaluation by rounding, gives the same bits on every processor, leaves
/// degrees above BasisTable::kMostDegree to the other. Parameters are brought into the domain as by
/// KnotVector::clamp().
///
/// Holds a copy of the curve, which shares its control points. Immutable after construction, so any
/// number of threads may read one. Evaluation does not allocate.
template <int kDimension>
class CurveEvaluator {
 public:
  /// O(spans p^3).
  explicit CurveEvaluator(BsplineCurve<kDimension> curve)
      : curve_(std::move(curve)), prepared_(curve_.data()) {}

  const BsplineCurve<kDimension>& curve() const noexcept { return curve_; }

  CurveJet<kDimension> jet(double u) const noexcept {
    CurveJet<kDimension> out;
    jets({&u, 1}, {&out, 1});
    return out;
  }

  /// out[i] = the jet at us[i]. Precondition: equal sizes.
  void jets(std::span<const double> us, std::span<CurveJet<kDimension>> out) const noexcept {
    static_assert(sizeof(CurveJet<kDimension>) == 4 * kDimension * sizeof(double));
    LIMN_EXPECT(us.size() == out.size());
    if (!us.empty()) prepared_.jets(us, out.front().point.data());
  }

 private:
  BsplineCurve<kDimension> curve_;
  bspline_detail::PreparedCurve prepared_;
};

}  // namespace limn
