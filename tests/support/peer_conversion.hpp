#pragma once

#include <Eigen/Core>
#include <vector>

#include "modeler/bspline/tensor_spline.hpp"
#include "tests/peers/peer_surface.hpp"

namespace limn::test {

/// limn's form of what peers are given. Precondition: the data are valid.
inline BsplineSurface limn_surface(const peers::PeerSurface& from) {
  const BsplineSurface::Knots knots = {*KnotVector::make(from.degree[0], from.knots[0]),
                                       *KnotVector::make(from.degree[1], from.knots[1])};
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < from.points.size(); i += 3) {
    points.emplace_back(from.points[i], from.points[i + 1], from.points[i + 2]);
  }
  return from.weights.empty() ? *BsplineSurface::make(knots, points)
                              : *BsplineSurface::make_rational(knots, points, from.weights);
}

template <int kDimension>
BsplineCurve<kDimension> limn_curve(const peers::PeerCurve& from) {
  using Curve = BsplineCurve<kDimension>;
  std::vector<typename Curve::Point> points;
  for (std::size_t i = 0; i < from.points.size(); i += kDimension) {
    points.emplace_back(Eigen::Map<const typename Curve::Point>(from.points.data() + i));
  }
  const typename Curve::Knots knots = {*KnotVector::make(from.degree, from.knots)};
  return from.weights.empty() ? *Curve::make(knots, points)
                              : *Curve::make_rational(knots, points, from.weights);
}

inline Eigen::Vector3d limn_point(const peers::PeerPoint& p) { return {p[0], p[1], p[2]}; }
inline peers::PeerPoint peer_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace limn::test
