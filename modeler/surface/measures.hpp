#pragma once

#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

/// An integral and an estimate of its error: what halving the cells once more still changed. Not a
/// bound, though for smooth shapes the truth is much nearer.
struct Measure {
  double value = 0;
  double error = 0;
};

// By Gauss-Legendre quadrature in each span, whose cells are halved until the estimate of all
// together is below `relative` of the value, or a bounded number of cells is reached: `error`
// tells. Precondition: relative > 0.

/// Length, in mm.
Measure arc_length(const BsplineCurve<2>& curve, double relative = 1e-10);
Measure arc_length(const BsplineCurve<3>& curve, double relative = 1e-10);

/// Length between two parameters of the domain, low <= high.
Measure arc_length(const BsplineCurve<3>& curve, double low, double high, double relative);

/// Area, in mm^2.
Measure area(const BsplineSurface& surface, double relative = 1e-8);

/// Volume between the surface and the origin, the integral of S . (S_u x S_v) / 3, in mm^3: summed
/// over the faces of a closed body, whose normals point outwards, that of the body.
Measure volume(const BsplineSurface& surface, double relative = 1e-8);

}  // namespace limn
