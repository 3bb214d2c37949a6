#pragma once

#include <memory>
#include <optional>
#include <span>

#include "tests/peers/peer_surface.hpp"

namespace limn::peers {

#ifdef LIMN_PEER_SISL

/// A SISLSurf. Made once; calls copy nothing beyond their result. One thread.
///
/// Constructors throw std::runtime_error where the library refuses the data; a question that it
/// answers with an error status has the answer nullopt, or an empty one. Tolerances are distances.
/// SISL has neither area, volume nor tessellation of a surface.
class SislSurface {
 public:
  explicit SislSurface(const PeerSurface& surface);
  SislSurface(SislSurface&&) noexcept;
  SislSurface& operator=(SislSurface&&) noexcept;
  ~SislSurface();

  PeerSurface data() const;
  int control_point_count() const noexcept;

  /// s1421, which computes a normal, too; the spans of the last call are its hint for the next.
  PeerJet jet(double u, double v) const;
  /// s1424. Precondition: i, j >= 0.
  PeerPoint derivative(double u, double v, int i, int j) const;
  /// s1506; normals are S_u x S_v, not of unit length.
  void grid(std::span<const double> u, std::span<const double> v, PeerGrid& out) const;

  /// s1954, boundary included.
  std::optional<PeerParameters> closest(const PeerPoint& point, double tolerance) const;
  /// s1775, started at `guess`.
  std::optional<PeerParameters> closest_near(const PeerPoint& point, PeerParameters guess,
                                             double tolerance) const;
  /// s1856, which meets the whole line, and the least t >= 0 of its points.
  std::optional<PeerHit> first_hit(const PeerRay& ray, double tolerance) const;

  /// A new surface by s1025, with knots at ascending values inside the domain; a repeated value is
  /// inserted that many times.
  SislSurface with_knots(std::span<const double> u, std::span<const double> v) const;
  /// A new surface by s1387. Precondition: no degree falls.
  SislSurface with_degrees(int u, int v) const;

  /// s1859 for the topology, then s1310, which marches each branch; its places at the knots of the
  /// marched curve. A branch that could not be marched has the places of s1859.
  std::optional<PeerIntersection> intersection_with(const SislSurface& other,
                                                    double tolerance) const;

 private:
  struct Impl;
  explicit SislSurface(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
};

/// A SISLCurve. As SislSurface.
class SislCurve {
 public:
  explicit SislCurve(const PeerCurve& curve);
  SislCurve(SislCurve&&) noexcept;
  SislCurve& operator=(SislCurve&&) noexcept;
  ~SislCurve();

  /// s1221 for polynomial curves and rational ones.
  PeerCurveJet jet(double t) const;

  /// s1857: isolated points. Precondition: the same dimension.
  std::vector<PeerCurvePair> intersections_with(const SislCurve& other, double tolerance) const;
  /// s1850: isolated points. Precondition: dimension 3.
  std::vector<double> plane_crossings(const PeerPoint& point, const PeerPoint& normal,
                                      double tolerance) const;
  /// s1240.
  double length(double tolerance) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

#endif  // LIMN_PEER_SISL

}  // namespace limn::peers
