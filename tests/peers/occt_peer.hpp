#pragma once

#include <memory>
#include <optional>
#include <span>

#include "tests/peers/peer_surface.hpp"

namespace limn::peers {

#ifdef LIMN_PEER_OCCT

/// A Geom_BSplineSurface and what Open CASCADE keeps beside it to answer questions.
///
/// Made once; calls copy nothing beyond their result. What only some questions need (face, ray
/// intersector, projector) is made by the first of them: ask once before timing. One thread.
/// Every constructor throws std::runtime_error where the library refuses the data; a question that
/// it cannot answer has the answer nullopt, or an empty one.
class OcctSurface {
 public:
  explicit OcctSurface(const PeerSurface& surface);
  OcctSurface(OcctSurface&&) noexcept;
  OcctSurface& operator=(OcctSurface&&) noexcept;
  ~OcctSurface();

  /// Its data, as the library has them now.
  PeerSurface data() const;
  int control_point_count() const noexcept;

  /// By Geom_BSplineSurface::D2, which keeps nothing from call to call: the faster of the two at
  /// random parameters (340 ns against 490 for 103 x 103 control points, bicubic).
  PeerJet jet(double u, double v) const;
  /// By GeomAdaptor_Surface::D2, which keeps the polynomial of the span that it is in: the faster
  /// where neighbours follow each other (160 ns against 360 along rows).
  PeerJet jet_by_adaptor(double u, double v) const;
  /// By Geom_BSplineSurface::DN. Precondition: i, j >= 0, i + j > 0.
  PeerPoint derivative(double u, double v, int i, int j) const;
  /// GeomAdaptor_Surface::D1, v in the outer loop; unit normals, zero where there is none.
  void grid(std::span<const double> u, std::span<const double> v, PeerGrid& out) const;

  /// GeomAPI_ProjectPointOnSurf with Extrema_ExtFlag_MIN. It finds places where the line to the
  /// point is normal to the surface: nullopt, or a farther place, if the closest one is on the
  /// boundary.
  std::optional<PeerParameters> closest(const PeerPoint& point) const;
  /// Extrema_GenLocateExtPS, started at `guess`.
  std::optional<PeerParameters> closest_near(const PeerPoint& point, PeerParameters guess) const;
  /// IntCurvesFace_Intersector: its answer with the least t >= 0.
  std::optional<PeerHit> first_hit(const PeerRay& ray) const;

  /// A copy with knots inserted by InsertUKnots and InsertVKnots, at ascending values inside the
  /// domain; a repeated value is inserted that many times.
  OcctSurface with_knots(std::span<const double> u, std::span<const double> v) const;
  /// A copy by IncreaseDegree.
  OcctSurface with_degrees(int u, int v) const;

  /// IntPatch_Intersection and GeomInt_LineConstructor as GeomAPI_IntSS has them, but the places
  /// that were walked instead of curves through them. Branches along a boundary may have their two
  /// ends alone.
  std::optional<PeerIntersection> intersection_with(const OcctSurface& other,
                                                    double tolerance) const;

  /// BRepGProp with that relative tolerance. The volume is that between the surface and the
  /// origin, which is the volume inside a closed surface; positive if S_u x S_v points outwards.
  std::optional<double> area(double relative_tolerance) const;
  std::optional<double> volume(double relative_tolerance) const;

  /// BRepMesh_IncrementalMesh, serial, afresh each time; the number of triangles.
  std::size_t tessellate(double chord, double angle_rad) const;
  /// What the last call of tessellate() made.
  PeerMesh mesh() const;

 private:
  struct Impl;
  explicit OcctSurface(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
};

/// A Geom_BSplineCurve or, in the plane, a Geom2d_BSplineCurve. As OcctSurface.
class OcctCurve {
 public:
  explicit OcctCurve(const PeerCurve& curve);
  OcctCurve(OcctCurve&&) noexcept;
  OcctCurve& operator=(OcctCurve&&) noexcept;
  ~OcctCurve();

  PeerCurveJet jet(double t) const;

  /// In the plane Geom2dAPI_InterCurveCurve; in space those extrema of GeomAPI_ExtremaCurveCurve
  /// that are no longer than the tolerance. Precondition: the same dimension.
  std::vector<PeerCurvePair> intersections_with(const OcctCurve& other, double tolerance) const;
  /// GeomAPI_IntCS. Precondition: dimension 3.
  std::vector<double> plane_crossings(const PeerPoint& point, const PeerPoint& normal) const;
  /// GCPnts_AbscissaPoint::Length with that tolerance.
  double length(double tolerance) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

#endif  // LIMN_PEER_OCCT

}  // namespace limn::peers
