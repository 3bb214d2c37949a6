#pragma once

#include <Eigen/Core>

#include "modeler/base/tolerance.hpp"
#include "modeler/bspline/jet.hpp"

namespace limn {

/// Points of two surfaces that are found by Newton's iteration are the same within this, mm; curves
/// that are shorter are places.
inline constexpr double kNearCrossing = 10 * kGeometric;

/// Parameters on two surfaces: (u, v) on the first, then (u, v) on the second.
using CrossingPlace = Eigen::Vector4d;

/// Both surfaces at one place: what Newton's iterations on S_1 = S_2 are made of.
struct CrossingJets {
  SurfaceJet first;
  SurfaceJet second;

  /// S_2 - S_1, mm.
  Eigen::Vector3d gap() const { return second.point - first.point; }
  /// Of S_1 - S_2 by the four parameters.
  Eigen::Matrix<double, 3, 4> jacobian() const {
    Eigen::Matrix<double, 3, 4> out;
    out << first.du, first.dv, -second.du, -second.dv;
    return out;
  }
};

}  // namespace limn
