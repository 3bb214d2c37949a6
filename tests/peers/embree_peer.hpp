#pragma once

#include <memory>
#include <optional>

#include "tests/peers/peer_surface.hpp"

namespace limn::peers {

#ifdef LIMN_PEER_EMBREE

/// origin + t direction = (1 - a - b) P0 + a P1 + b P2, with the corners of that triangle.
struct PeerMeshHit {
  double t = 0.0;
  int triangle = 0;
  double a = 0.0, b = 0.0;
};

/// An Embree scene of one triangle mesh, made once with its best hierarchy
/// (RTC_BUILD_QUALITY_HIGH). Embree computes in single precision.
///
/// The constructor throws std::runtime_error where Embree has no device.
class EmbreeMesh {
 public:
  explicit EmbreeMesh(const PeerMesh& mesh);
  EmbreeMesh(EmbreeMesh&&) noexcept;
  EmbreeMesh& operator=(EmbreeMesh&&) noexcept;
  ~EmbreeMesh();

  /// rtcIntersect1: the least t >= 0.
  std::optional<PeerMeshHit> first_hit(const PeerRay& ray) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

#endif  // LIMN_PEER_EMBREE

}  // namespace limn::peers
