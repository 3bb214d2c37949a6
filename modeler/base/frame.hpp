#pragma once

#include <Eigen/Core>

namespace limn {

/// A right-handed orthonormal frame in space; the world's by default. mm.
struct Frame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  Eigen::Vector3d z = Eigen::Vector3d::UnitZ();

  Eigen::Vector3d point(double a, double b, double c) const {
    return origin + a * x + b * y + c * z;
  }
};

}  // namespace limn
