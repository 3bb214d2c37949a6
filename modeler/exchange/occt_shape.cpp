#include "modeler/exchange/occt_shape.hpp"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom2dConvert.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "modeler/bspline/refine.hpp"
#include "modeler/model/sewing.hpp"

namespace limn::exchange_detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Below it Open CASCADE takes places for the same, mm.
const double kLeastTolerance = Precision::Confusion();

gp_Pnt occt_point(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }
gp_Pnt2d occt_point(const Vector2d& p) { return {p.x(), p.y()}; }
Vector3d limn_point(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }
Vector2d limn_point(const gp_Pnt2d& p) { return {p.X(), p.Y()}; }

/// Knots without repetition, and how often each occurs.
struct DistinctKnots {
  explicit DistinctKnots(const KnotVector& knots)
      : values(1, static_cast<int>(knots.breakpoints().size())),
        multiplicities(1, values.Length()) {
    int i = 0;
    for (const double u : knots.breakpoints()) {
      values.SetValue(++i, u);
      multiplicities.SetValue(i, knots.multiplicity(u));
    }
  }
  TColStd_Array1OfReal values;
  TColStd_Array1OfInteger multiplicities;
};

/// Clamped in all directions, which Open CASCADE needs, with nothing that it does not have.
template <int kDirections, int kDimension>
Expected<TensorSpline<kDirections, kDimension>> clamped(
    TensorSpline<kDirections, kDimension> spline) {
  for (int d = 0; d < kDirections; ++d) {
    const KnotVector& knots = spline.knots(d);
    if (knots.degree() < 1) {
      return fail(ErrorCode::kOutOfRange, "", "a spline of degree 0 has no place in the format",
                  "raise its degree");
    }
    auto part = segment(spline, d, knots.domain_begin(), knots.domain_end());
    if (!part) return part;
    spline = *std::move(part);
    for (const double u : spline.knots(d).breakpoints()) {
      const bool is_end = u == spline.knots(d).domain_begin() || u == spline.knots(d).domain_end();
      if (!is_end && spline.knots(d).multiplicity(u) > spline.knots(d).degree()) {
        return fail(ErrorCode::kOutOfRange, "", "a spline breaks inside", "split it there");
      }
    }
  }
  return spline;
}

Expected<Handle(Geom_BSplineCurve)> occt_curve(const BsplineCurve<3>& any) {
  const auto curve = clamped(any);
  if (!curve) return tl::unexpected(curve.error());
  const int count = static_cast<int>(curve->control_points().size());
  TColgp_Array1OfPnt points(1, count);
  TColStd_Array1OfReal weights(1, count);
  for (int i = 0; i < count; ++i) {
    points.SetValue(i + 1, occt_point(curve->control_points()[static_cast<std::size_t>(i)]));
    weights.SetValue(i + 1, curve->weight(static_cast<std::size_t>(i)));
  }
  const DistinctKnots knots(curve->knots());
  const int degree = curve->knots().degree();
  if (!curve->is_rational()) {
    return Handle(Geom_BSplineCurve)(
        new Geom_BSplineCurve(points, knots.values, knots.multiplicities, degree));
  }
  return Handle(Geom_BSplineCurve)(
      new Geom_BSplineCurve(points, weights, knots.values, knots.multiplicities, degree));
}

Expected<Handle(Geom2d_BSplineCurve)> occt_curve(const BsplineCurve<2>& any) {
  const auto curve = clamped(any);
  if (!curve) return tl::unexpected(curve.error());
  const int count = static_cast<int>(curve->control_points().size());
  TColgp_Array1OfPnt2d points(1, count);
  TColStd_Array1OfReal weights(1, count);
  for (int i = 0; i < count; ++i) {
    points.SetValue(i + 1, occt_point(curve->control_points()[static_cast<std::size_t>(i)]));
    weights.SetValue(i + 1, curve->weight(static_cast<std::size_t>(i)));
  }
  const DistinctKnots knots(curve->knots());
  const int degree = curve->knots().degree();
  if (!curve->is_rational()) {
    return Handle(Geom2d_BSplineCurve)(
        new Geom2d_BSplineCurve(points, knots.values, knots.multiplicities, degree));
  }
  return Handle(Geom2d_BSplineCurve)(
      new Geom2d_BSplineCurve(points, weights, knots.values, knots.multiplicities, degree));
}

Expected<Handle(Geom_BSplineSurface)> occt_surface(const BsplineSurface& any) {
  const auto surface = clamped(any);
  if (!surface) return tl::unexpected(surface.error());
  const int rows = surface->knots(0).basis_count();
  const int columns = surface->knots(1).basis_count();
  TColgp_Array2OfPnt points(1, rows, 1, columns);
  TColStd_Array2OfReal weights(1, rows, 1, columns);
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < rows; ++i) {
      const auto at = static_cast<std::size_t>(i + rows * j);
      points.SetValue(i + 1, j + 1, occt_point(surface->control_points()[at]));
      weights.SetValue(i + 1, j + 1, surface->weight(at));
    }
  }
  const DistinctKnots u(surface->knots(0));
  const DistinctKnots v(surface->knots(1));
  const int p = surface->knots(0).degree();
  const int q = surface->knots(1).degree();
  if (!surface->is_rational()) {
    return Handle(Geom_BSplineSurface)(new Geom_BSplineSurface(
        points, u.values, v.values, u.multiplicities, v.multiplicities, p, q));
  }
  return Handle(Geom_BSplineSurface)(new Geom_BSplineSurface(
      points, weights, u.values, v.values, u.multiplicities, v.multiplicities, p, q));
}

/// Builds one body's shape.
class ShapeMaker {
 public:
  explicit ShapeMaker(const Body& body) : body_(body) {}

  Expected<TopoDS_Shape> run() {
    make_vertices();
    for (const Edge& edge : body_.edges) {
      if (auto made = add_edge(edge); !made) return tl::unexpected(made.error());
    }
    TopoDS_Shell shell;
    builder_.MakeShell(shell);
    for (const Face& face : body_.faces) {
      auto made = face_of(face);
      if (!made) return tl::unexpected(made.error());
      builder_.Add(shell, *made);
    }
    const bool closed = is_closed(body_);
    shell.Closed(closed);
    if (!closed) return TopoDS_Shape(shell);
    TopoDS_Solid solid;
    builder_.MakeSolid(solid);
    builder_.Add(solid, shell);
    return TopoDS_Shape(solid);
  }

 private:
  static bool is_pole(const Edge& edge) { return edge.curve.knots().degree() == 0; }

  void make_vertices() {
    std::vector<double> reach(body_.vertices.size(), kLeastTolerance);
    for (const Edge& edge : body_.edges) {
      const KnotVector& knots = edge.curve.knots();
      const Vector3d ends[] = {edge.curve.point(knots.domain_begin()),
                               edge.curve.point(knots.domain_end())};
      for (std::size_t k = 0; k < 2; ++k) {
        double& r = reach[edge.vertices[k]];
        r = std::max({r, edge.deviation + (ends[k] - body_.vertices[edge.vertices[k]]).norm()});
      }
    }
    vertices_.resize(body_.vertices.size());
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      builder_.MakeVertex(vertices_[i], occt_point(body_.vertices[i]), reach[i]);
    }
  }

  Expected<void> add_edge(const Edge& edge) {
    TopoDS_Edge made;
    if (is_pole(edge)) {
      builder_.MakeEdge(made);
      builder_.Degenerated(made, true);
    } else {
      auto curve = occt_curve(edge.curve);
      if (!curve) return tl::unexpected(curve.error());
      builder_.MakeEdge(made, *curve, std::max(edge.deviation, kLeastTolerance));
    }
    builder_.Add(made, vertices_[edge.vertices[0]].Oriented(TopAbs_FORWARD));
    builder_.Add(made, vertices_[edge.vertices[1]].Oriented(TopAbs_REVERSED));
    edges_.push_back(made);
    return {};
  }

  /// The trim's curve at the edge's own parameters.
  Expected<Handle(Geom2d_BSplineCurve)> curve_of(const Trim& trim) const {
    const KnotVector& own = trim.curve.knots();
    auto curve = occt_curve(trim.curve);
    if (!curve || is_pole(body_.edges[trim.edge])) return curve;
    const KnotVector& edge = body_.edges[trim.edge].curve.knots();
    const double per_unit =
        (edge.domain_end() - edge.domain_begin()) / (own.domain_end() - own.domain_begin());
    TColStd_Array1OfReal knots(1, (*curve)->NbKnots());
    (*curve)->Knots(knots);
    for (int i = 1; i <= knots.Length(); ++i) {
      knots(i) = edge.domain_begin() + (knots(i) - own.domain_begin()) * per_unit;
    }
    knots(1) = edge.domain_begin();
    knots(knots.Length()) = edge.domain_end();
    (*curve)->SetKnots(knots);
    return curve;
  }

  Expected<TopoDS_Face> face_of(const Face& face) {
    auto surface = occt_surface(face.surface);
    if (!surface) return tl::unexpected(surface.error());
    TopoDS_Face made;
    builder_.MakeFace(made, *surface, kLeastTolerance);
    for (const Loop& loop : face.loops) {
      TopoDS_Wire wire;
      builder_.MakeWire(wire);
      for (const Trim& trim : loop) {
        if (auto joined = join(trim, face, made); !joined) return tl::unexpected(joined.error());
        builder_.Add(wire,
                     edges_[trim.edge].Oriented(trim.reversed ? TopAbs_REVERSED : TopAbs_FORWARD));
      }
      wire.Closed(true);
      builder_.Add(made, wire);
    }
    if (face.loops.empty()) builder_.NaturalRestriction(made, true);
    if (face.reversed) made.Reverse();
    return made;
  }

  /// Puts a trim's curve on its edge; that of a seam together with its other use.
  Expected<void> join(const Trim& trim, const Face& face, const TopoDS_Face& made) {
    const Trim* other = nullptr;
    for (const Loop& loop : face.loops) {
      for (const Trim& t : loop) {
        if (&t != &trim && t.edge == trim.edge) other = &t;
      }
    }
    if (other != nullptr && trim.reversed) return {};  // done with the one that runs forward
    const TopoDS_Edge& edge = edges_[trim.edge];
    const double tolerance = std::max(body_.edges[trim.edge].deviation, kLeastTolerance);
    auto curve = curve_of(trim);
    if (!curve) return tl::unexpected(curve.error());
    if (other == nullptr) {
      builder_.UpdateEdge(edge, *curve, made, tolerance);
    } else {
      auto back = curve_of(*other);
      if (!back) return tl::unexpected(back.error());
      builder_.UpdateEdge(edge, *curve, *back, made, tolerance);
    }
    if (is_pole(body_.edges[trim.edge])) {
      builder_.Range(edge, made, (*curve)->FirstParameter(), (*curve)->LastParameter());
    }
    return {};
  }

  const Body& body_;
  BRep_Builder builder_;
  std::vector<TopoDS_Vertex> vertices_;
  std::vector<TopoDS_Edge> edges_;
};

// Reading. What limn does not take goes the way of Open CASCADE's own errors.

template <class T>
T must(Expected<T> made) {
  if (!made) throw Standard_Failure((made.error().at + ": " + made.error().what).c_str());
  return *std::move(made);
}

KnotVector limn_knots(int degree, const TColStd_Array1OfReal& flat) {
  return must(KnotVector::make(degree, std::vector<double>(flat.begin(), flat.end())));
}

/// Precondition: not periodic.
template <int kDimension, class Curve>
BsplineCurve<kDimension> limn_curve(const Curve& curve) {
  std::vector<Eigen::Matrix<double, kDimension, 1>> points;
  std::vector<double> weights;
  for (int i = 1; i <= curve.NbPoles(); ++i) {
    points.push_back(limn_point(curve.Pole(i)));
    weights.push_back(curve.Weight(i));
  }
  const KnotVector knots = limn_knots(curve.Degree(), curve.KnotSequence());
  if (!curve.IsRational()) return must(BsplineCurve<kDimension>::make(knots, points));
  return must(BsplineCurve<kDimension>::make_rational({knots}, points, weights));
}

BsplineSurface limn_surface(const Geom_BSplineSurface& surface) {
  std::vector<Vector3d> points;
  std::vector<double> weights;
  for (int j = 1; j <= surface.NbVPoles(); ++j) {
    for (int i = 1; i <= surface.NbUPoles(); ++i) {
      points.push_back(limn_point(surface.Pole(i, j)));
      weights.push_back(surface.Weight(i, j));
    }
  }
  const BsplineSurface::Knots knots = {limn_knots(surface.UDegree(), surface.UKnotSequence()),
                                       limn_knots(surface.VDegree(), surface.VKnotSequence())};
  if (!surface.IsURational() && !surface.IsVRational()) {
    return must(BsplineSurface::make(knots, points));
  }
  return must(BsplineSurface::make_rational(knots, points, weights));
}

/// Whether all of a shape keeps its parameters when it is made a B-spline: it is one already, or
/// straight. Others must be converted together with the curves on them, which Open CASCADE does,
/// though not well with poles: so not without need.
bool keeps_parameters(const TopoDS_Shape& shape) {
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
    const GeomAbs_SurfaceType type = BRepAdaptor_Surface(TopoDS::Face(at.Current())).GetType();
    if (type != GeomAbs_BSplineSurface && type != GeomAbs_BezierSurface && type != GeomAbs_Plane) {
      return false;
    }
  }
  for (TopExp_Explorer at(shape, TopAbs_EDGE); at.More(); at.Next()) {
    const TopoDS_Edge& edge = TopoDS::Edge(at.Current());
    if (BRep_Tool::Degenerated(edge)) continue;
    const GeomAbs_CurveType type = BRepAdaptor_Curve(edge).GetType();
    if (type != GeomAbs_BSplineCurve && type != GeomAbs_BezierCurve && type != GeomAbs_Line) {
      return false;
    }
  }
  return true;
}

TopoDS_Shape as_splines(const TopoDS_Shape& shape) {
  return keeps_parameters(shape) ? shape : BRepBuilderAPI_NurbsConvert(shape).Shape();
}

/// A face's surface as a B-spline that is open and has all of the face in its domain.
Handle(Geom_BSplineSurface) open_surface(const TopoDS_Face& face) {
  Handle(Geom_BSplineSurface) out =
      Handle(Geom_BSplineSurface)::DownCast(BRep_Tool::Surface(face)->Copy());
  double box[4];
  BRepTools::UVBounds(face, box[0], box[1], box[2], box[3]);
  if (out.IsNull()) {
    out = GeomConvert::SurfaceToBSplineSurface(new Geom_RectangularTrimmedSurface(
        BRep_Tool::Surface(face), box[0], box[1], box[2], box[3]));
  }
  double u0 = 0;
  double u1 = 0;
  double v0 = 0;
  double v1 = 0;
  out->Bounds(u0, u1, v0, v1);
  // A face across the seam: the seam is moved to where the face begins.
  constexpr double kSameKnot = 1e-9;
  if (out->IsUPeriodic()) {
    if (box[0] < u0 - kSameKnot || box[1] > u1 + kSameKnot) {
      const double at = u0 + std::fmod(std::fmod(box[0] - u0, u1 - u0) + (u1 - u0), u1 - u0);
      out->InsertUKnot(at, 1, kSameKnot, false);
      int low = 0;
      int high = 0;
      out->LocateU(at, kSameKnot, low, high);
      out->SetUOrigin(low);
    }
    out->SetUNotPeriodic();
  }
  if (out->IsVPeriodic()) {
    if (box[2] < v0 - kSameKnot || box[3] > v1 + kSameKnot) {
      const double at = v0 + std::fmod(std::fmod(box[2] - v0, v1 - v0) + (v1 - v0), v1 - v0);
      out->InsertVKnot(at, 1, kSameKnot, false);
      int low = 0;
      int high = 0;
      out->LocateV(at, kSameKnot, low, high);
      out->SetVOrigin(low);
    }
    out->SetVNotPeriodic();
  }
  return out;
}

/// Reads the faces of one solid or shell.
class BodyReader {
 public:
  BodyReader(const TopoDS_Shape& shape, std::string name, std::vector<std::string>& skipped)
      : skipped_(skipped) {
    body_.name = std::move(name);
    TopExp::MapShapes(shape, TopAbs_VERTEX, vertices_);
    TopExp::MapShapes(shape, TopAbs_EDGE, edges_);
    for (int i = 1; i <= vertices_.Extent(); ++i) {
      body_.vertices.push_back(limn_point(BRep_Tool::Pnt(TopoDS::Vertex(vertices_(i)))));
    }
    for (int i = 1; i <= edges_.Extent(); ++i) add_edge(TopoDS::Edge(edges_(i)));
    for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
      add_face(TopoDS::Face(at.Current()));
    }
  }

  Body take() { return std::move(body_); }

 private:
  std::size_t vertex_of(const TopoDS_Vertex& vertex) {
    const int found = vertices_.FindIndex(vertex);
    return found > 0 ? static_cast<std::size_t>(found - 1) : 0;
  }

  void add_edge(const TopoDS_Edge& oriented) {
    const TopoDS_Edge edge = TopoDS::Edge(oriented.Oriented(TopAbs_FORWARD));
    Edge made;
    TopoDS_Vertex first;
    TopoDS_Vertex last;
    TopExp::Vertices(edge, first, last);
    made.vertices = {vertex_of(first), vertex_of(last)};
    double low = 0;
    double high = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, low, high);
    if (BRep_Tool::Degenerated(edge) || curve.IsNull()) {
      made.curve = must(BsplineCurve<3>::make(KnotVector(), {body_.vertices[made.vertices[0]]}));
    } else {
      made.curve = space_curve(curve, low, high);
    }
    body_.edges.push_back(std::move(made));
  }

 public:
  static BsplineCurve<3> space_curve(const Handle(Geom_Curve) & curve, double low, double high) {
    Handle(Geom_BSplineCurve) spline =
        GeomConvert::CurveToBSplineCurve(new Geom_TrimmedCurve(curve, low, high));
    if (spline->IsPeriodic()) spline->SetNotPeriodic();
    return limn_curve<3>(*spline);
  }

 private:
  void add_face(const TopoDS_Face& oriented) {
    const TopoDS_Face face = TopoDS::Face(oriented.Oriented(TopAbs_FORWARD));
    Face made;
    made.reversed = oriented.Orientation() == TopAbs_REVERSED;
    try {
      made.surface = limn_surface(*open_surface(face));
      const TopoDS_Wire outer = BRepTools::OuterWire(face);
      if (!outer.IsNull()) made.loops.push_back(loop_of(outer, face, made.surface));
      for (TopExp_Explorer at(face, TopAbs_WIRE); at.More(); at.Next()) {
        if (at.Current().IsSame(outer)) continue;
        made.loops.push_back(loop_of(TopoDS::Wire(at.Current()), face, made.surface));
      }
    } catch (const Standard_Failure& failure) {
      skipped_.push_back(std::string("face: ") + failure.GetMessageString());
      return;
    }
    body_.faces.push_back(std::move(made));
  }

  Loop loop_of(const TopoDS_Wire& wire, const TopoDS_Face& face, const BsplineSurface& surface) {
    Loop any_order;
    for (TopoDS_Iterator at(wire); at.More(); at.Next()) {
      const TopoDS_Edge& edge = TopoDS::Edge(at.Value());
      double low = 0;
      double high = 0;
      const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, low, high);
      if (curve.IsNull()) throw Standard_Failure("an edge without a curve on its surface");
      Handle(Geom2d_BSplineCurve) spline =
          Geom2dConvert::CurveToBSplineCurve(new Geom2d_TrimmedCurve(curve, low, high));
      if (spline->IsPeriodic()) spline->SetNotPeriodic();
      Trim trim;
      trim.edge = static_cast<std::size_t>(edges_.FindIndex(edge) - 1);
      trim.reversed = edge.Orientation() == TopAbs_REVERSED;
      trim.curve = limn_curve<2>(*spline);
      measure(trim, surface);
      any_order.push_back(std::move(trim));
    }
    return in_order(std::move(any_order));
  }

  /// Each trim followed by the one that begins nearest to its end: a wire's edges may be in any
  /// order.
  static Loop in_order(Loop trims) {
    const auto end_of = [](const Trim& trim, bool first) {
      const KnotVector& knots = trim.curve.knots();
      return trim.curve.point(first != trim.reversed ? knots.domain_begin() : knots.domain_end());
    };
    for (std::size_t i = 0; i + 2 < trims.size(); ++i) {
      const Vector2d here = end_of(trims[i], false);
      const auto next = trims.begin() + static_cast<std::ptrdiff_t>(i) + 1;
      std::iter_swap(next, std::min_element(next, trims.end(), [&](const Trim& a, const Trim& b) {
                       return (end_of(a, true) - here).norm() < (end_of(b, true) - here).norm();
                     }));
    }
    return trims;
  }

  /// Raises the edge's deviation to what the trim is off, at some places of each span.
  void measure(const Trim& trim, const BsplineSurface& surface) {
    Edge& edge = body_.edges[trim.edge];
    const KnotVector& own = trim.curve.knots();
    const KnotVector& on_edge = edge.curve.knots();
    const double scale =
        (on_edge.domain_end() - on_edge.domain_begin()) / (own.domain_end() - own.domain_begin());
    const auto measure_at = [&](double t) {
      const Vector2d uv = trim.curve.point(t);
      const Vector3d there =
          edge.curve.point(on_edge.domain_begin() + (t - own.domain_begin()) * scale);
      edge.deviation = std::max(edge.deviation, (surface.point({uv.x(), uv.y()}) - there).norm());
    };
    const std::vector<double> breaks = own.breakpoints();
    constexpr int kPlaces = 8;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
      for (int k = 0; k <= kPlaces; ++k) {
        measure_at(breaks[i] + (breaks[i + 1] - breaks[i]) * k / kPlaces);
      }
    }
  }

  Body body_;
  TopTools_IndexedMapOfShape vertices_;
  TopTools_IndexedMapOfShape edges_;
  std::vector<std::string>& skipped_;
};

}  // namespace

Expected<TopoDS_Shape> shape_of(const Body& body) { return ShapeMaker(body).run(); }

Expected<TopoDS_Shape> shape_of(const NamedCurve& curve) {
  auto made = occt_curve(curve.curve);
  if (!made) return tl::unexpected(made.error());
  return TopoDS_Shape(BRepBuilderAPI_MakeEdge(*made).Edge());
}

void add_shape(const TopoDS_Shape& shape, Model& model, std::vector<std::string>& skipped) {
  const auto add_bodies = [&](TopAbs_ShapeEnum kind, TopAbs_ShapeEnum not_in) {
    for (TopExp_Explorer at(shape, kind, not_in); at.More(); at.Next()) {
      BodyReader reader(as_splines(at.Current()), "body " + std::to_string(model.bodies.size() + 1),
                        skipped);
      Body body = reader.take();
      if (!body.faces.empty()) model.bodies.push_back(std::move(body));
    }
  };
  add_bodies(TopAbs_SOLID, TopAbs_SHAPE);
  add_bodies(TopAbs_SHELL, TopAbs_SOLID);
  add_bodies(TopAbs_FACE, TopAbs_SHELL);
  for (TopExp_Explorer at(shape, TopAbs_EDGE, TopAbs_FACE); at.More(); at.Next()) {
    double low = 0;
    double high = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(TopoDS::Edge(at.Current()), low, high);
    if (curve.IsNull()) continue;
    model.curves.push_back({"curve " + std::to_string(model.curves.size() + 1),
                            BodyReader::space_curve(curve, low, high)});
  }
}

}  // namespace limn::exchange_detail
