#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

/// A box along axes of its own: low <= axes (x - middle) <= high, in mm.
struct OrientedBox {
  Eigen::Vector3d middle;
  Eigen::Matrix3d axes;  ///< orthonormal rows
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

/// A node of a hierarchy of boxes: up to eight children, whose boxes have axes in common, which lie
/// along the surface below the node where that is nearly flat. For all points x of child i,
///
///     low[d][i] <= (A (x - c))[d] <= high[d][i],    |A y| <= |y| for every y.
///
/// Rounded outwards to floats, which halves what a query reads: the numbers are exact bounds, not
/// approximations.
struct alignas(32) BoxNode {
  static constexpr std::size_t kWidth = 8;

  std::array<std::array<float, 4>, 3> columns{};  ///< of A; the last value is 0
  std::array<float, 4> center{};                  ///< c, and 0
  std::array<std::array<float, kWidth>, 3> low{};
  std::array<std::array<float, kWidth>, 3> high{};  ///< below `low` where there is no child
  std::array<std::int32_t, kWidth> child{};         ///< a node, or leaf ~child if below 0

  bool has_child(std::size_t i) const noexcept { return low[0][i] <= high[0][i]; }
  /// The box of child i. Precondition: has_child(i).
  Eigen::AlignedBox<double, 3> child_box(std::size_t i) const;

  /// out[i] = a lower bound of the square of the distance from p to child i, infinite where there
  /// is none. Returns which of them are below `most`, bit i for child i.
  unsigned square_distances(const Eigen::Vector3d& p, double most, double* out) const noexcept;
  /// The same bounds, and the child that seems nearest: by its bound and a part of the square of
  /// the distance to its middle.
  std::size_t nearest_child(const Eigen::Vector3d& p, double* out) const noexcept;

  /// Which children a ray meets, bit i for child i: origin + t direction, 0 <= t <= most, is in
  /// child i for no t below first[i].
  unsigned passages(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double most,
                    double* first) const noexcept;
};

/// Sorts `order`, numbers of `leaves`, and puts them below nodes, the root first; child ~i is leaf
/// order[i] of `leaves`. Empty for fewer than two leaves. O(n log n), deterministic.
std::vector<BoxNode> make_box_tree(std::span<const OrientedBox> leaves,
                                   std::vector<std::int32_t>& order);

}  // namespace limn
