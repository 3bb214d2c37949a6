#include "tests/peers/occt_peer.hpp"

#include <Adaptor3d_TopolTool.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Extrema_GenLocateExtPS.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GProp_GProps.hxx>
#include <Geom2dAPI_InterCurveCurve.hxx>
#include <Geom2dAdaptor_Curve.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <GeomAPI_ExtremaCurveCurve.hxx>
#include <GeomAPI_IntCS.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <GeomInt_LineConstructor.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_Plane.hxx>
#include <IntCurvesFace_Intersector.hxx>
#include <IntPatch_Intersection.hxx>
#include <IntPatch_RLine.hxx>
#include <IntPatch_WLine.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace limn::peers {

namespace {

gp_Pnt to_point(const PeerPoint& p) { return {p[0], p[1], p[2]}; }
PeerPoint from(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }
PeerPoint from(const gp_Pnt& p) { return from(p.XYZ()); }
PeerPoint from(const gp_Vec& v) { return from(v.XYZ()); }

/// Knots as Open CASCADE has them: each value once, with its multiplicity. Precondition: not empty.
struct DistinctKnots {
  explicit DistinctKnots(std::span<const double> all)
      : values(1, count(all)), multiplicities(1, count(all)) {
    int last = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i == 0 || all[i] != all[i - 1]) {
        values.SetValue(++last, all[i]);
        multiplicities.SetValue(last, 0);
      }
      multiplicities.ChangeValue(last) += 1;
    }
  }

  static int count(std::span<const double> all) {
    int distinct = 1;
    for (std::size_t i = 1; i < all.size(); ++i) distinct += all[i] != all[i - 1] ? 1 : 0;
    return distinct;
  }

  TColStd_Array1OfReal values;
  TColStd_Array1OfInteger multiplicities;
};

Handle(Geom_BSplineSurface) surface_of(const PeerSurface& s) {
  TColgp_Array2OfPnt points(1, s.count[0], 1, s.count[1]);
  TColStd_Array2OfReal weights(1, s.count[0], 1, s.count[1]);
  std::size_t i = 0;
  for (int v = 1; v <= s.count[1]; ++v) {
    for (int u = 1; u <= s.count[0]; ++u, ++i) {
      points.SetValue(u, v, gp_Pnt(s.points[3 * i], s.points[3 * i + 1], s.points[3 * i + 2]));
      weights.SetValue(u, v, s.weights.empty() ? 1.0 : s.weights[i]);
    }
  }
  const DistinctKnots u(s.knots[0]);
  const DistinctKnots v(s.knots[1]);
  if (s.weights.empty())
    return new Geom_BSplineSurface(points, u.values, v.values, u.multiplicities, v.multiplicities,
                                   s.degree[0], s.degree[1]);
  return new Geom_BSplineSurface(points, weights, u.values, v.values, u.multiplicities,
                                 v.multiplicities, s.degree[0], s.degree[1]);
}

/// The answer, or one made of nothing where the library throws.
template <typename Question>
auto answer(const Question& question) -> decltype(question()) {
  try {
    return question();
  } catch (const Standard_Failure&) {
    return {};
  }
}

}  // namespace

struct OcctSurface::Impl {
  explicit Impl(const Handle(Geom_BSplineSurface) & made)
      : surface(made), adaptor(new GeomAdaptor_Surface(made)) {}

  const TopoDS_Face& face() {
    if (made_face.IsNull()) made_face = BRepBuilderAPI_MakeFace(surface, Precision::Confusion());
    return made_face;
  }

  GeomAPI_ProjectPointOnSurf& projector() {
    if (made_projector == nullptr) {
      made_projector = std::make_unique<GeomAPI_ProjectPointOnSurf>();
      double u0 = 0.0, u1 = 0.0, v0 = 0.0, v1 = 0.0;
      surface->Bounds(u0, u1, v0, v1);
      made_projector->Init(surface, u0, u1, v0, v1);
      made_projector->SetExtremaFlag(Extrema_ExtFlag_MIN);
    }
    return *made_projector;
  }

  IntCurvesFace_Intersector& intersector() {
    if (made_intersector == nullptr)
      made_intersector =
          std::make_unique<IntCurvesFace_Intersector>(face(), Precision::Confusion());
    return *made_intersector;
  }

  Handle(Geom_BSplineSurface) surface;
  Handle(GeomAdaptor_Surface) adaptor;

 private:
  TopoDS_Face made_face;
  std::unique_ptr<GeomAPI_ProjectPointOnSurf> made_projector;
  std::unique_ptr<IntCurvesFace_Intersector> made_intersector;
};

OcctSurface::OcctSurface(const PeerSurface& surface) {
  try {
    impl_ = std::make_unique<Impl>(surface_of(surface));
  } catch (const Standard_Failure& failure) {
    throw std::runtime_error(std::string("Open CASCADE refuses the surface: ") +
                             failure.GetMessageString());
  }
}

OcctSurface::OcctSurface(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
OcctSurface::OcctSurface(OcctSurface&&) noexcept = default;
OcctSurface& OcctSurface::operator=(OcctSurface&&) noexcept = default;
OcctSurface::~OcctSurface() = default;

PeerSurface OcctSurface::data() const {
  const auto& s = *impl_->surface;
  PeerSurface out;
  out.degree = {s.UDegree(), s.VDegree()};
  out.count = {s.NbUPoles(), s.NbVPoles()};
  out.knots[0].assign(s.UKnotSequence().begin(), s.UKnotSequence().end());
  out.knots[1].assign(s.VKnotSequence().begin(), s.VKnotSequence().end());
  const bool is_rational = s.IsURational() || s.IsVRational();
  for (int v = 1; v <= s.NbVPoles(); ++v) {
    for (int u = 1; u <= s.NbUPoles(); ++u) {
      const PeerPoint point = from(s.Pole(u, v));
      out.points.insert(out.points.end(), point.begin(), point.end());
      if (is_rational) out.weights.push_back(s.Weight(u, v));
    }
  }
  return out;
}

int OcctSurface::control_point_count() const noexcept {
  return impl_->surface->NbUPoles() * impl_->surface->NbVPoles();
}

namespace {

PeerJet second_order_jet(const auto& surface, double u, double v) {
  gp_Pnt point;
  gp_Vec du, dv, duu, dvv, duv;
  surface.D2(u, v, point, du, dv, duu, dvv, duv);
  return {from(point), from(du), from(dv), from(duu), from(duv), from(dvv)};
}

}  // namespace

PeerJet OcctSurface::jet(double u, double v) const {
  return second_order_jet(*impl_->surface, u, v);
}

PeerJet OcctSurface::jet_by_adaptor(double u, double v) const {
  return second_order_jet(*impl_->adaptor, u, v);
}

PeerPoint OcctSurface::derivative(double u, double v, int i, int j) const {
  return from(impl_->surface->DN(u, v, i, j));
}

void OcctSurface::grid(std::span<const double> u, std::span<const double> v, PeerGrid& out) const {
  const std::size_t count = u.size() * v.size();
  out.jets.resize(9 * count);
  out.normals.resize(3 * count);
  double* jet = out.jets.data();
  double* normal = out.normals.data();
  const auto write = [](const gp_XYZ& xyz, double*& to) {
    *to++ = xyz.X();
    *to++ = xyz.Y();
    *to++ = xyz.Z();
  };
  const GeomAdaptor_Surface& surface = *impl_->adaptor;
  for (const double y : v) {
    for (const double x : u) {
      gp_Pnt point;
      gp_Vec du, dv;
      surface.D1(x, y, point, du, dv);
      gp_Vec across = du.Crossed(dv);
      const double length = across.Magnitude();
      if (length > 0.0) across /= length;
      write(point.XYZ(), jet);
      write(du.XYZ(), jet);
      write(dv.XYZ(), jet);
      write(across.XYZ(), normal);
    }
  }
}

std::optional<PeerParameters> OcctSurface::closest(const PeerPoint& point) const {
  return answer([&]() -> std::optional<PeerParameters> {
    auto& projector = impl_->projector();
    projector.Perform(to_point(point));
    if (!projector.IsDone() || projector.NbPoints() == 0) return std::nullopt;
    PeerParameters place;
    projector.LowerDistanceParameters(place.u, place.v);
    return place;
  });
}

std::optional<PeerParameters> OcctSurface::closest_near(const PeerPoint& point,
                                                        PeerParameters guess) const {
  return answer([&]() -> std::optional<PeerParameters> {
    Extrema_GenLocateExtPS search(*impl_->adaptor);
    search.Perform(to_point(point), guess.u, guess.v);
    if (!search.IsDone()) return std::nullopt;
    PeerParameters place;
    search.Point().Parameter(place.u, place.v);
    return place;
  });
}

std::optional<PeerHit> OcctSurface::first_hit(const PeerRay& ray) const {
  return answer([&]() -> std::optional<PeerHit> {
    const gp_Vec direction(ray.direction[0], ray.direction[1], ray.direction[2]);
    auto& intersector = impl_->intersector();
    intersector.Perform(gp_Lin(to_point(ray.origin), gp_Dir(direction)), 0.0, RealLast());
    int first = 0;
    for (int i = 1; intersector.IsDone() && i <= intersector.NbPnt(); ++i)
      if (first == 0 || intersector.WParameter(i) < intersector.WParameter(first)) first = i;
    if (first == 0) return std::nullopt;
    return PeerHit{intersector.WParameter(first) / direction.Magnitude(),
                   intersector.UParameter(first), intersector.VParameter(first)};
  });
}

OcctSurface OcctSurface::with_knots(std::span<const double> u, std::span<const double> v) const {
  Handle(Geom_BSplineSurface) copy = Handle(Geom_BSplineSurface)::DownCast(impl_->surface->Copy());
  if (!u.empty()) {
    const DistinctKnots knots(u);
    copy->InsertUKnots(knots.values, knots.multiplicities);
  }
  if (!v.empty()) {
    const DistinctKnots knots(v);
    copy->InsertVKnots(knots.values, knots.multiplicities);
  }
  return OcctSurface(std::make_unique<Impl>(copy));
}

OcctSurface OcctSurface::with_degrees(int u, int v) const {
  Handle(Geom_BSplineSurface) copy = Handle(Geom_BSplineSurface)::DownCast(impl_->surface->Copy());
  copy->IncreaseDegree(u, v);
  return OcctSurface(std::make_unique<Impl>(copy));
}

namespace {

PeerSurfacePair pair_of(const auto& place) {
  PeerSurfacePair out;
  place.Parameters(out.first.u, out.first.v, out.second.u, out.second.v);
  return out;
}

/// A walk's places from `first` to `last`, counted from 1.
PeerBranch branch_of(const IntPatch_PointLine& line, int first, int last) {
  PeerBranch out;
  for (int i = first; i <= last; ++i) out.places.push_back(pair_of(line.Point(i)));
  // A walk that comes back repeats its first place.
  out.is_closed =
      last - first > 1 && line.Point(first).IsSame(line.Point(last), Precision::Confusion());
  return out;
}

/// The parts of a line that lie on both surfaces: it may leave them and come back.
void append_branches(GeomInt_LineConstructor& parts, const Handle(IntPatch_Line) & line,
                     std::vector<PeerBranch>& out) {
  const Handle(IntPatch_WLine) walk = Handle(IntPatch_WLine)::DownCast(line);
  const Handle(IntPatch_RLine) on_boundary = Handle(IntPatch_RLine)::DownCast(line);
  if (!on_boundary.IsNull()) {
    if (on_boundary->HasPolygon()) {
      out.push_back(branch_of(*on_boundary, 1, on_boundary->NbPnts()));
      return;
    }
    PeerBranch& branch = out.emplace_back();
    for (int i = 1; i <= on_boundary->NbVertex(); ++i)
      branch.places.push_back(pair_of(on_boundary->Vertex(i)));
  }
  if (walk.IsNull()) return;
  parts.Perform(line);
  int begun = 0, ended = 0;  // a part goes on where the one before it ended
  for (int i = 1; parts.IsDone() && i <= parts.NbParts(); ++i) {
    double first = 0.0, last = 0.0;
    parts.Part(i, first, last);
    if (begun == 0 || static_cast<int>(first) != ended) {
      if (begun != 0) out.push_back(branch_of(*walk, begun, ended));
      begun = static_cast<int>(first);
    }
    ended = static_cast<int>(last);
  }
  if (begun != 0) out.push_back(branch_of(*walk, begun, ended));
}

}  // namespace

std::optional<PeerIntersection> OcctSurface::intersection_with(const OcctSurface& other,
                                                               double tolerance) const {
  constexpr double kDeflection = 0.01;  // what GeomInt_IntSS sets for two B-splines
  return answer([&]() -> std::optional<PeerIntersection> {
    const Handle(GeomAdaptor_Surface)& first = impl_->adaptor;
    const Handle(GeomAdaptor_Surface)& second = other.impl_->adaptor;
    const Handle(Adaptor3d_TopolTool) first_domain = new Adaptor3d_TopolTool(first);
    const Handle(Adaptor3d_TopolTool) second_domain = new Adaptor3d_TopolTool(second);
    IntPatch_Intersection search;
    search.SetTolerances(
        tolerance, tolerance,
        IntPatch_Intersection::DefineUVMaxStep(first, first_domain, second, second_domain),
        kDeflection);
    search.Perform(first, first_domain, second, second_domain, tolerance, tolerance);
    if (!search.IsDone()) return std::nullopt;
    PeerIntersection out;
    GeomInt_LineConstructor parts;
    parts.Load(first_domain, second_domain, first, second);
    for (int i = 1; i <= search.NbLines(); ++i)
      append_branches(parts, search.Line(i), out.branches);
    for (int i = 1; i <= search.NbPnts(); ++i) out.points.push_back(pair_of(search.Point(i)));
    return out;
  });
}

std::optional<double> OcctSurface::area(double relative_tolerance) const {
  return answer([&]() -> std::optional<double> {
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(impl_->face(), properties, relative_tolerance);
    return properties.Mass();
  });
}

std::optional<double> OcctSurface::volume(double relative_tolerance) const {
  return answer([&]() -> std::optional<double> {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(impl_->face(), properties, relative_tolerance);
    return properties.Mass();
  });
}

namespace {

Handle(Poly_Triangulation) triangulation_of(const TopoDS_Face& face) {
  TopLoc_Location nowhere;
  return BRep_Tool::Triangulation(face, nowhere);
}

}  // namespace

std::size_t OcctSurface::tessellate(double chord, double angle_rad) const {
  return answer([&] {
    constexpr bool kRelative = false;
    constexpr bool kParallel = false;
    BRepTools::Clean(impl_->face());
    BRepMesh_IncrementalMesh(impl_->face(), chord, kRelative, angle_rad, kParallel);
    const auto made = triangulation_of(impl_->face());
    return made.IsNull() ? std::size_t{0} : static_cast<std::size_t>(made->NbTriangles());
  });
}

PeerMesh OcctSurface::mesh() const {
  PeerMesh out;
  const auto made = triangulation_of(impl_->face());
  if (made.IsNull()) return out;
  for (int i = 1; i <= made->NbNodes(); ++i) {
    const PeerPoint position = from(made->Node(i));
    out.positions.insert(out.positions.end(), position.begin(), position.end());
    if (!made->HasUVNodes()) continue;
    const gp_Pnt2d place = made->UVNode(i);
    out.parameters.insert(out.parameters.end(), {place.X(), place.Y()});
  }
  for (int i = 1; i <= made->NbTriangles(); ++i) {
    int a = 0, b = 0, c = 0;
    made->Triangle(i).Get(a, b, c);
    out.triangles.insert(out.triangles.end(), {a - 1, b - 1, c - 1});
  }
  return out;
}

struct OcctCurve::Impl {
  explicit Impl(const PeerCurve& c);

  Handle(Geom_BSplineCurve) in_space;    // one of them
  Handle(Geom2d_BSplineCurve) in_plane;  // is null
};

OcctCurve::Impl::Impl(const PeerCurve& c) {
  const DistinctKnots knots(c.knots);
  TColStd_Array1OfReal weights(1, c.count);
  for (int i = 1; i <= c.count; ++i)
    weights.SetValue(i, c.weights.empty() ? 1.0 : c.weights[static_cast<std::size_t>(i - 1)]);
  const auto coordinate = [&c](int point, int axis) {
    return c.points[static_cast<std::size_t>(c.dimension * (point - 1) + axis)];
  };
  // Weights that are all alike make a polynomial.
  if (c.dimension == 2) {
    TColgp_Array1OfPnt2d points(1, c.count);
    for (int i = 1; i <= c.count; ++i)
      points.SetValue(i, gp_Pnt2d(coordinate(i, 0), coordinate(i, 1)));
    in_plane =
        new Geom2d_BSplineCurve(points, weights, knots.values, knots.multiplicities, c.degree);
  } else {
    TColgp_Array1OfPnt points(1, c.count);
    for (int i = 1; i <= c.count; ++i)
      points.SetValue(i, gp_Pnt(coordinate(i, 0), coordinate(i, 1), coordinate(i, 2)));
    in_space = new Geom_BSplineCurve(points, weights, knots.values, knots.multiplicities, c.degree);
  }
}

OcctCurve::OcctCurve(const PeerCurve& curve) {
  try {
    impl_ = std::make_unique<Impl>(curve);
  } catch (const Standard_Failure& failure) {
    throw std::runtime_error(std::string("Open CASCADE refuses the curve: ") +
                             failure.GetMessageString());
  }
}

OcctCurve::OcctCurve(OcctCurve&&) noexcept = default;
OcctCurve& OcctCurve::operator=(OcctCurve&&) noexcept = default;
OcctCurve::~OcctCurve() = default;

PeerCurveJet OcctCurve::jet(double t) const {
  if (impl_->in_space.IsNull()) {
    gp_Pnt2d point;
    gp_Vec2d first, second;
    impl_->in_plane->D2(t, point, first, second);
    return {
        {point.X(), point.Y(), 0.0}, {first.X(), first.Y(), 0.0}, {second.X(), second.Y(), 0.0}};
  }
  gp_Pnt point;
  gp_Vec first, second;
  impl_->in_space->D2(t, point, first, second);
  return {from(point), from(first), from(second)};
}

std::vector<PeerCurvePair> OcctCurve::intersections_with(const OcctCurve& other,
                                                         double tolerance) const {
  return answer([&] {
    std::vector<PeerCurvePair> out;
    if (impl_->in_space.IsNull()) {
      Geom2dAPI_InterCurveCurve search(impl_->in_plane, other.impl_->in_plane, tolerance);
      const auto& found = search.Intersector();
      for (int i = 1; i <= search.NbPoints(); ++i)
        out.push_back({found.Point(i).ParamOnFirst(), found.Point(i).ParamOnSecond()});
      return out;
    }
    const GeomAPI_ExtremaCurveCurve search(impl_->in_space, other.impl_->in_space);
    for (int i = 1; i <= search.NbExtrema(); ++i) {
      if (search.Distance(i) > tolerance) continue;
      PeerCurvePair& pair = out.emplace_back();
      search.Parameters(i, pair.first, pair.second);
    }
    return out;
  });
}

std::vector<double> OcctCurve::plane_crossings(const PeerPoint& point,
                                               const PeerPoint& normal) const {
  return answer([&] {
    const Handle(Geom_Plane) plane =
        new Geom_Plane(to_point(point), gp_Dir(normal[0], normal[1], normal[2]));
    const GeomAPI_IntCS search(impl_->in_space, plane);
    std::vector<double> out;
    for (int i = 1; search.IsDone() && i <= search.NbPoints(); ++i) {
      double u = 0.0, v = 0.0, t = 0.0;
      search.Parameters(i, u, v, t);
      out.push_back(t);
    }
    return out;
  });
}

double OcctCurve::length(double tolerance) const {
  return answer([&] {
    if (impl_->in_space.IsNull())
      return GCPnts_AbscissaPoint::Length(Geom2dAdaptor_Curve(impl_->in_plane), tolerance);
    return GCPnts_AbscissaPoint::Length(GeomAdaptor_Curve(impl_->in_space), tolerance);
  });
}

}  // namespace limn::peers
