// SISL is under the AGPL: tests and limn-bench link it where it is installed, limn never does.

#include "tests/peers/sisl_peer.hpp"

#include <sisl.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <stdexcept>

/// AddressSanitizer asks for it. s1859 of SISL 4.6 copies overlapping memory by memcpy; the places
/// that it finds are checked by whoever uses them.
extern "C" const char* __asan_default_suppressions();
extern "C" const char* __asan_default_suppressions() { return "interceptor_via_fun:sh1839"; }

namespace limn::peers {

namespace {

constexpr double kUnused = 1e-9;  // "computational resolution", which SISL takes and ignores
constexpr int kPolynomial = 1, kRational = 2;  // kinds
constexpr int kCopy = 1;

struct FreeSurface {
  void operator()(SISLSurf* surface) const noexcept { freeSurf(surface); }
};
struct FreeCurve {
  void operator()(SISLCurve* curve) const noexcept { freeCurve(curve); }
};
using Surface = std::unique_ptr<SISLSurf, FreeSurface>;
using Curve = std::unique_ptr<SISLCurve, FreeCurve>;

/// What SISL's intersections give: isolated points and curves.
struct Found {
  Found() = default;
  Found(const Found&) = delete;
  Found& operator=(const Found&) = delete;
  ~Found() {
    std::free(first);
    std::free(second);
    if (curves != nullptr) freeIntcrvlist(curves, curve_count);
  }

  int status = 0;
  int point_count = 0;
  double* first = nullptr;   // parameters in the first object
  double* second = nullptr;  // and in the second
  int curve_count = 0;
  SISLIntcurve** curves = nullptr;
};

// SISL's functions take what they only read as pointers to non-const.
double* unconst(const PeerPoint& point) { return const_cast<double*>(point.data()); }

/// (w x, w y, .., w), or the points as they are.
std::vector<double> homogeneous(const std::vector<double>& points,
                                const std::vector<double>& weights, std::size_t dimension) {
  if (weights.empty()) return points;
  std::vector<double> out;
  out.reserve(points.size() + weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    for (std::size_t k = 0; k < dimension; ++k)
      out.push_back(points[dimension * i + k] * weights[i]);
    out.push_back(weights[i]);
  }
  return out;
}

PeerPoint point_of(const double* values, int dimension) {
  PeerPoint out = {};
  std::copy_n(values, dimension, out.begin());
  return out;
}

}  // namespace

struct SislSurface::Impl {
  explicit Impl(SISLSurf* made) : surface(made) {
    if (surface == nullptr) throw std::runtime_error("SISL refuses the surface");
  }

  Surface surface;
  int hint_u = 0, hint_v = 0;  // spans of the last evaluation
};

SislSurface::SislSurface(const PeerSurface& s) {
  const auto coefficients = homogeneous(s.points, s.weights, 3);
  impl_ = std::make_unique<Impl>(newSurf(s.count[0], s.count[1], s.degree[0] + 1, s.degree[1] + 1,
                                         const_cast<double*>(s.knots[0].data()),
                                         const_cast<double*>(s.knots[1].data()),
                                         const_cast<double*>(coefficients.data()),
                                         s.weights.empty() ? kPolynomial : kRational, 3, kCopy));
}

SislSurface::SislSurface(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
SislSurface::SislSurface(SislSurface&&) noexcept = default;
SislSurface& SislSurface::operator=(SislSurface&&) noexcept = default;
SislSurface::~SislSurface() = default;

PeerSurface SislSurface::data() const {
  const SISLSurf& s = *impl_->surface;
  PeerSurface out;
  out.degree = {s.ik1 - 1, s.ik2 - 1};
  out.count = {s.in1, s.in2};
  out.knots[0].assign(s.et1, s.et1 + s.in1 + s.ik1);
  out.knots[1].assign(s.et2, s.et2 + s.in2 + s.ik2);
  const std::ptrdiff_t count = control_point_count();
  out.points.assign(s.ecoef, s.ecoef + 3 * count);  // Cartesian, whatever the kind
  if (s.ikind == kRational)
    for (std::ptrdiff_t i = 0; i < count; ++i) out.weights.push_back(s.rcoef[4 * i + 3]);
  return out;
}

int SislSurface::control_point_count() const noexcept {
  return impl_->surface->in1 * impl_->surface->in2;
}

PeerJet SislSurface::jet(double u, double v) const {
  constexpr int kSecond = 2;
  double at[2] = {u, v};
  std::array<double, 18> values = {};
  double normal[3];
  int status = 0;
  s1421(impl_->surface.get(), kSecond, at, &impl_->hint_u, &impl_->hint_v, values.data(), normal,
        &status);
  return std::bit_cast<PeerJet>(values);
}

PeerPoint SislSurface::derivative(double u, double v, int i, int j) const {
  double at[2] = {u, v};
  std::vector<double> values(static_cast<std::size_t>(3 * (i + 1) * (j + 1)));
  int status = 0;
  s1424(impl_->surface.get(), i, j, at, &impl_->hint_u, &impl_->hint_v, values.data(), &status);
  return point_of(values.data() + values.size() - 3, 3);  // all (k, l) up to (i, j), k fastest
}

void SislSurface::grid(std::span<const double> u, std::span<const double> v, PeerGrid& out) const {
  constexpr int kFirst = 1;
  const std::size_t count = u.size() * v.size();
  out.jets.resize(9 * count);
  out.normals.resize(3 * count);
  int status = 0;
  s1506(impl_->surface.get(), kFirst, static_cast<int>(u.size()), const_cast<double*>(u.data()),
        static_cast<int>(v.size()), const_cast<double*>(v.data()), out.jets.data(),
        out.normals.data(), &status);
}

std::optional<PeerParameters> SislSurface::closest(const PeerPoint& point, double tolerance) const {
  Found found;
  s1954(impl_->surface.get(), unconst(point), 3, kUnused, tolerance, &found.point_count,
        &found.first, &found.curve_count, &found.curves, &found.status);
  if (found.status < 0) return std::nullopt;
  if (found.point_count > 0) return PeerParameters{found.first[0], found.first[1]};
  if (found.curve_count > 0)  // a whole curve of closest places, as from the axis of a cylinder
    return PeerParameters{found.curves[0]->epar1[0], found.curves[0]->epar1[1]};
  return std::nullopt;
}

std::optional<PeerParameters> SislSurface::closest_near(const PeerPoint& point,
                                                        PeerParameters guess,
                                                        double tolerance) const {
  const SISLSurf& s = *impl_->surface;
  double low[2] = {s.et1[0], s.et2[0]};
  double high[2] = {s.et1[s.in1], s.et2[s.in2]};
  double start[2] = {guess.u, guess.v};
  double place[2] = {};
  int status = 0;
  s1775(impl_->surface.get(), unconst(point), 3, tolerance, low, high, start, place, &status);
  if (status < 0) return std::nullopt;
  return PeerParameters{place[0], place[1]};
}

std::optional<PeerHit> SislSurface::first_hit(const PeerRay& ray, double tolerance) const {
  Found found;
  s1856(impl_->surface.get(), unconst(ray.origin), unconst(ray.direction), 3, kUnused, tolerance,
        &found.point_count, &found.first, &found.curve_count, &found.curves, &found.status);
  if (found.status < 0) return std::nullopt;
  const auto& d = ray.direction;
  const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  std::optional<PeerHit> first;
  for (int i = 0; i < found.point_count; ++i) {
    double* at = found.first + std::ptrdiff_t{2} * i;
    double point[3];
    double normal[3];
    int status = 0;
    s1421(impl_->surface.get(), 0, at, &impl_->hint_u, &impl_->hint_v, point, normal, &status);
    double t = 0.0;
    for (std::size_t k = 0; k < 3; ++k) t += (point[k] - ray.origin[k]) * d[k] / square;
    if (t >= 0.0 && (!first.has_value() || t < first->t)) first = PeerHit{t, at[0], at[1]};
  }
  return first;
}

SislSurface SislSurface::with_knots(std::span<const double> u, std::span<const double> v) const {
  SISLSurf* made = nullptr;
  int status = 0;
  s1025(impl_->surface.get(), const_cast<double*>(u.data()), static_cast<int>(u.size()),
        const_cast<double*>(v.data()), static_cast<int>(v.size()), &made, &status);
  return SislSurface(std::make_unique<Impl>(made));
}

SislSurface SislSurface::with_degrees(int u, int v) const {
  SISLSurf* made = nullptr;
  int status = 0;
  s1387(impl_->surface.get(), u + 1, v + 1, &made, &status);
  return SislSurface(std::make_unique<Impl>(made));
}

namespace {

/// A parameter curve's places at the distinct knots of `along`.
std::vector<PeerParameters> places_at_knots(SISLCurve* curve, const SISLCurve& along) {
  std::vector<PeerParameters> out;
  int hint = 0;
  for (int i = along.ik - 1; i <= along.in; ++i) {
    if (i > along.ik - 1 && along.et[i] == along.et[i - 1]) continue;
    double values[2] = {};
    int status = 0;
    s1221(curve, 0, along.et[i], &hint, values, &status);
    out.push_back({values[0], values[1]});
  }
  return out;
}

PeerBranch branch_of(const SISLIntcurve& found) {
  constexpr int kClosedLoop = 2, kClosedSingular = 3;
  PeerBranch out;
  out.is_closed = found.itype == kClosedLoop || found.itype == kClosedSingular;
  if (found.pgeom != nullptr && found.ppar1 != nullptr && found.ppar2 != nullptr) {
    const auto first = places_at_knots(found.ppar1, *found.pgeom);
    const auto second = places_at_knots(found.ppar2, *found.pgeom);
    for (std::size_t i = 0; i < first.size(); ++i) out.places.push_back({first[i], second[i]});
    return out;
  }
  for (int i = 0; i < found.ipoint; ++i) {
    const double* first = found.epar1 + std::ptrdiff_t{2} * i;
    const double* second = found.epar2 + std::ptrdiff_t{2} * i;
    out.places.push_back({{first[0], first[1]}, {second[0], second[1]}});
  }
  return out;
}

}  // namespace

std::optional<PeerIntersection> SislSurface::intersection_with(const SislSurface& other,
                                                               double tolerance) const {
  constexpr double kAnyStep = 0.0;
  constexpr int kWithParameterCurves = 2;
  constexpr int kDrawNothing = 0;
  Found found;
  SISLSurf* first = impl_->surface.get();
  SISLSurf* second = other.impl_->surface.get();
  s1859(first, second, kUnused, tolerance, &found.point_count, &found.first, &found.second,
        &found.curve_count, &found.curves, &found.status);
  if (found.status < 0) return std::nullopt;
  PeerIntersection out;
  for (int i = 0; i < found.point_count; ++i) {
    const double* a = found.first + std::ptrdiff_t{2} * i;
    const double* b = found.second + std::ptrdiff_t{2} * i;
    out.points.push_back({{a[0], a[1]}, {b[0], b[1]}});
  }
  for (int i = 0; i < found.curve_count; ++i) {
    int status = 0;
    s1310(first, second, found.curves[i], tolerance, kAnyStep, kWithParameterCurves, kDrawNothing,
          &status);
    out.branches.push_back(branch_of(*found.curves[i]));
  }
  return out;
}

struct SislCurve::Impl {
  explicit Impl(SISLCurve* made) : curve(made) {
    if (curve == nullptr) throw std::runtime_error("SISL refuses the curve");
  }

  Curve curve;
  int hint = 0;
};

SislCurve::SislCurve(const PeerCurve& c) {
  const auto coefficients = homogeneous(c.points, c.weights, static_cast<std::size_t>(c.dimension));
  impl_ = std::make_unique<Impl>(
      newCurve(c.count, c.degree + 1, const_cast<double*>(c.knots.data()),
               const_cast<double*>(coefficients.data()),
               c.weights.empty() ? kPolynomial : kRational, c.dimension, kCopy));
}

SislCurve::SislCurve(SislCurve&&) noexcept = default;
SislCurve& SislCurve::operator=(SislCurve&&) noexcept = default;
SislCurve::~SislCurve() = default;

PeerCurveJet SislCurve::jet(double t) const {
  constexpr int kSecond = 2;
  const int dimension = impl_->curve->idim;
  double values[9] = {};
  int status = 0;
  s1221(impl_->curve.get(), kSecond, t, &impl_->hint, values, &status);
  return {point_of(values, dimension), point_of(values + dimension, dimension),
          point_of(values + std::ptrdiff_t{2} * dimension, dimension)};
}

std::vector<PeerCurvePair> SislCurve::intersections_with(const SislCurve& other,
                                                         double tolerance) const {
  Found found;
  s1857(impl_->curve.get(), other.impl_->curve.get(), kUnused, tolerance, &found.point_count,
        &found.first, &found.second, &found.curve_count, &found.curves, &found.status);
  std::vector<PeerCurvePair> out;
  if (found.status < 0) return out;
  for (int i = 0; i < found.point_count; ++i) out.push_back({found.first[i], found.second[i]});
  return out;
}

std::vector<double> SislCurve::plane_crossings(const PeerPoint& point, const PeerPoint& normal,
                                               double tolerance) const {
  Found found;
  s1850(impl_->curve.get(), unconst(point), unconst(normal), 3, kUnused, tolerance,
        &found.point_count, &found.first, &found.curve_count, &found.curves, &found.status);
  if (found.status < 0) return {};
  return {found.first, found.first + found.point_count};
}

double SislCurve::length(double tolerance) const {
  double length = 0.0;
  int status = 0;
  s1240(impl_->curve.get(), tolerance, &length, &status);
  return length;
}

}  // namespace limn::peers
