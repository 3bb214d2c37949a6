#pragma once

#include <Eigen/Core>
#include <vector>

#include "modeler/bspline/surface_evaluator.hpp"
#include "modeler/surface/surface_index.hpp"
#include "tests/support/rng.hpp"

namespace limn::bench {

// What surfaces over [0, 1]^2 that are about 100 mm wide are asked, the same on every machine.

/// Random parameters, `margin` away from the edges.
inline std::vector<Eigen::Vector2d> random_places(std::size_t count, double margin) {
  test::Rng rng(5);
  std::vector<Eigen::Vector2d> out(count);
  for (auto& at : out) at = {rng.uniform(margin, 1 - margin), rng.uniform(margin, 1 - margin)};
  return out;
}

/// Points up to 5 mm above and below the surface's middle, where each has a foot.
inline std::vector<Eigen::Vector3d> points_beside(const SurfaceEvaluator& surface,
                                                  std::size_t count) {
  test::Rng rng(7);
  std::vector<Eigen::Vector3d> out;
  for (const Eigen::Vector2d& at : random_places(count, 0.15)) {
    const SurfaceJet jet = surface.jet(at.x(), at.y());
    out.push_back(jet.point + rng.uniform(-5, 5) * *normal(jet));
  }
  return out;
}

/// Rays from above through points of the surface, which are at t = 1.
inline std::vector<Ray> rays_through(const SurfaceEvaluator& surface, std::size_t count) {
  test::Rng rng(9);
  std::vector<Ray> out;
  for (const Eigen::Vector2d& at : random_places(count, 0)) {
    const Eigen::Vector3d from(rng.uniform(0, 100), rng.uniform(0, 100), 80);
    out.push_back({from, surface.point(at.x(), at.y()) - from});
  }
  return out;
}

}  // namespace limn::bench
