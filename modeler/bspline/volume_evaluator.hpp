#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "modeler/bspline/basis_table.hpp"
#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

/// In space: what deforms space.
using BsplineVolume = TensorSpline<3, 3>;

/// A point of a volume with its tangents.
struct VolumeJet {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d du = Eigen::Vector3d::Zero();
  Eigen::Vector3d dv = Eigen::Vector3d::Zero();
  Eigen::Vector3d dw = Eigen::Vector3d::Zero();
};

/// A volume prepared for many evaluations, as SurfaceEvaluator is of surfaces: differs from
/// TensorSpline's own evaluation by rounding, gives the same bits on every processor, leaves
/// degrees above BasisTable::kMostDegree to the other. Parameters are brought into the domain as by
/// KnotVector::clamp().
///
/// Holds a copy of the volume, which shares its control points. Immutable after construction, so
/// any number of threads may read one.
class VolumeEvaluator {
 public:
  /// O(spans p^3) a direction.
  explicit VolumeEvaluator(BsplineVolume volume);

  const BsplineVolume& volume() const noexcept { return volume_; }

  VolumeJet jet(const Eigen::Vector3d& at) const noexcept;

  /// out[i] = the jet at at[i] = (u, v, w). Precondition: equal sizes. Does not allocate.
  void jets(std::span<const Eigen::Vector3d> at, std::span<VolumeJet> out) const noexcept;

  /// out[i + us.size() (j + vs.size() k)] = at (us[i], vs[j], ws[k]): the sums along w once a plane
  /// of the grid, those along v once a line. Allocates O(parameters + control points of a plane).
  /// Precondition: out.size() == us.size() * vs.size() * ws.size().
  void grid(std::span<const double> us, std::span<const double> vs, std::span<const double> ws,
            std::span<VolumeJet> out) const;

 private:
  BsplineVolume volume_;
  std::array<BasisTable, 3> tables_;
  bool usable_;  ///< all tables
};

}  // namespace limn
