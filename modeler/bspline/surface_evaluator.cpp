#include "modeler/bspline/surface_evaluator.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "input/base/expect.hpp"
#include "modeler/bspline/basis_kernels.hpp"

namespace limn {
namespace bspline_detail {
namespace {

using SurfaceFunctions = Functions<2>;

LIMN_KERNEL void store(const Lanes& from, Eigen::Vector3d& to) noexcept {
  to[0] = from[0];
  to[1] = from[1];
  to[2] = from[2];
}

/// The derivatives of A / w from those of (A, w), lane 3 being w.
LIMN_KERNEL void divide(Lanes& s, Lanes& u, Lanes& v, Lanes& uu, Lanes& uv, Lanes& vv) noexcept {
  const double per_w = 1 / s[3];
  const double wu = u[3];
  const double wv = v[3];
  s = s * per_w;
  u = (u - wu * s) * per_w;
  v = (v - wv * s) * per_w;
  uu = (uu - 2 * wu * u - uu[3] * s) * per_w;
  uv = (uv - wu * v - wv * u - uv[3] * s) * per_w;
  vv = (vv - 2 * wv * v - vv[3] * s) * per_w;
}

/// The surface as the kernels see it.
struct Prepared {
  const SplineData* data;
  const BasisTable* u;
  const BasisTable* v;
};

/// The jet of a surface with kWidth coordinates a control point and degree kDegree in u, from the
/// functions of both directions.
template <int kWidth, int kDegree>
LIMN_KERNEL void sum_jet(const Prepared& surface, int degree_v, const SurfaceFunctions& fu,
                         const SurfaceFunctions& fv, SurfaceJet& out) noexcept {
  const PagedArray& coordinates = surface.data->coordinates();
  const auto row_length = static_cast<std::size_t>(surface.data->knots(0).basis_count());
  constexpr std::size_t kRun = (kDegree + 1) * kWidth;
  double scratch[kRun + PagedArray::kPadding];
  const Lanes zero = {0, 0, 0, 0};
  Lanes s = zero, u = zero, v = zero, uu = zero, uv = zero, vv = zero;
  std::size_t first =
      static_cast<std::size_t>(fv.first) * row_length + static_cast<std::size_t>(fu.first);
  for (int j = 0; j <= degree_v; ++j, first += row_length) {
    const double* p = coordinates.run(first * kWidth, kRun, scratch);
    Lanes x;
    load(p, x);
    Lanes line0 = x * fu.value[0][0];
    Lanes line1 = x * fu.value[1][0];
    Lanes line2 = x * fu.value[2][0];
    for (int k = 1; k <= kDegree; ++k) {
      load(p + k * kWidth, x);
      line0 += x * fu.value[0][k];
      line1 += x * fu.value[1][k];
      line2 += x * fu.value[2][k];
    }
    const double b0 = fv.value[0][j];
    const double b1 = fv.value[1][j];
    s += line0 * b0;
    u += line1 * b0;
    uu += line2 * b0;
    v += line0 * b1;
    uv += line1 * b1;
    vv += line0 * fv.value[2][j];
  }
  if constexpr (kWidth == 4) divide(s, u, v, uu, uv, vv);
  store(s, out.point);
  store(u, out.du);
  store(v, out.dv);
  store(uu, out.duu);
  store(uv, out.duv);
  store(vv, out.dvv);
}

/// A parameter in its spans.
struct Place {
  std::array<int, 2> spans;
  Eigen::Vector2d at;
};

/// Jets at `count` places.
template <int kWidth, int kDegree>
LIMN_KERNEL void evaluate_jets(const Prepared& surface, const Place* places, std::size_t count,
                               SurfaceJet* out) noexcept {
  SurfaceFunctions fu;
  SurfaceFunctions fv;
  const int degree_v = surface.data->knots(1).degree();
  if constexpr (kDegree == 2 || kDegree == 3) {
    if (degree_v == kDegree) {  // the usual case, with loops of known length
      for (std::size_t i = 0; i < count; ++i) {
        evaluate_functions_in<kDegree>(*surface.u, places[i].spans[0], places[i].at.x(), fu);
        evaluate_functions_in<kDegree>(*surface.v, places[i].spans[1], places[i].at.y(), fv);
        sum_jet<kWidth, kDegree>(surface, kDegree, fu, fv, out[i]);
      }
      return;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    evaluate_functions_in<kDegree>(*surface.u, places[i].spans[0], places[i].at.x(), fu);
    evaluate_functions_in<-1>(*surface.v, places[i].spans[1], places[i].at.y(), fv);
    sum_jet<kWidth, kDegree>(surface, degree_v, fu, fv, out[i]);
  }
}

template <int kWidth>
LIMN_KERNEL void evaluate_jets_of(const Prepared& surface, const Place* places, std::size_t count,
                                  SurfaceJet* out) noexcept {
  switch (surface.data->knots(0).degree()) {
    case 0:
      return evaluate_jets<kWidth, 0>(surface, places, count, out);
    case 1:
      return evaluate_jets<kWidth, 1>(surface, places, count, out);
    case 2:
      return evaluate_jets<kWidth, 2>(surface, places, count, out);
    case 3:
      return evaluate_jets<kWidth, 3>(surface, places, count, out);
    case 4:
      return evaluate_jets<kWidth, 4>(surface, places, count, out);
    case 5:
      return evaluate_jets<kWidth, 5>(surface, places, count, out);
    case 6:
      return evaluate_jets<kWidth, 6>(surface, places, count, out);
    case 7:
      return evaluate_jets<kWidth, 7>(surface, places, count, out);
    case 8:
      return evaluate_jets<kWidth, 8>(surface, places, count, out);
    default:
      return evaluate_jets<kWidth, 9>(surface, places, count, out);
  }
}

LIMN_ON_EACH_PROCESSOR(
    jets_of, (const Prepared& surface, const Place* places, std::size_t count, SurfaceJet* out),
    (surface, places, count, out),
    surface.data->is_rational() ? evaluate_jets_of<4>(surface, places, count, out)
                                : evaluate_jets_of<3>(surface, places, count, out))

/// Asks for the control points that the jets at a place need: what is far apart in memory is
/// fetched while others are worked on.
void prefetch(const BsplineSurface& surface, const Place& place) noexcept {
  const auto row = static_cast<std::size_t>(surface.knots(0).basis_count());
  const auto width = static_cast<std::size_t>(surface.data().width());
  const std::array<int, 2> degree = {surface.knots(0).degree(), surface.knots(1).degree()};
  const auto column = static_cast<std::size_t>(place.spans[0] - degree[0]);
  const auto first = static_cast<std::size_t>(place.spans[1] - degree[1]);
  for (std::size_t j = first; j <= static_cast<std::size_t>(place.spans[1]); ++j) {
    const std::size_t at = (j * row + column) * width;
    surface.data().coordinates().prefetch(at, static_cast<std::size_t>(degree[0] + 1) * width);
  }
}

/// Where a grid's parameters meet one direction.
using FunctionList = std::vector<Functions<1>>;

LIMN_KERNEL void list_functions(const BasisTable& table, std::span<const double> at,
                                FunctionList& out) noexcept {
  for (std::size_t i = 0; i < at.size(); ++i) evaluate_functions(table, at[i], out[i]);
}

/// One line of a grid: control points of the curve at v and of its derivative along v, then the
/// points on it.
template <int kWidth>
LIMN_KERNEL void evaluate_line(const Prepared& surface, const FunctionList& us,
                               const Functions<1>& fv, double* curve, SurfaceFrame* out) noexcept {
  const PagedArray& coordinates = surface.data->coordinates();
  const int degree_u = surface.data->knots(0).degree();
  const int degree_v = surface.data->knots(1).degree();
  const auto row = static_cast<std::size_t>(surface.data->knots(0).basis_count());
  double scratch[4 + PagedArray::kPadding];
  for (std::size_t k = 0; k < row; ++k) {
    Lanes sum = {0, 0, 0, 0};
    Lanes sum_v = sum;
    for (int j = 0; j <= degree_v; ++j) {
      Lanes x;
      load(coordinates.run((static_cast<std::size_t>(fv.first + j) * row + k) * kWidth, kWidth,
                           scratch),
           x);
      sum += x * fv.value[0][j];
      sum_v += x * fv.value[1][j];
    }
    std::memcpy(curve + 8 * k, &sum, sizeof sum);
    std::memcpy(curve + 8 * k + 4, &sum_v, sizeof sum_v);
  }
  for (std::size_t i = 0; i < us.size(); ++i) {
    const double* p = curve + 8 * us[i].first;
    Lanes s = {0, 0, 0, 0};
    Lanes u = s;
    Lanes v = s;
    for (int k = 0; k <= degree_u; ++k, p += 8) {
      Lanes x;
      Lanes x_v;
      load(p, x);
      load(p + 4, x_v);
      s += x * us[i].value[0][k];
      u += x * us[i].value[1][k];
      v += x_v * us[i].value[0][k];
    }
    if constexpr (kWidth == 4) {
      const double per_w = 1 / s[3];
      s = s * per_w;
      u = (u - u[3] * s) * per_w;
      v = (v - v[3] * s) * per_w;
    }
    store(s, out[i].point);
    store(u, out[i].du);
    store(v, out[i].dv);
    const Eigen::Vector3d cross = out[i].du.cross(out[i].dv);
    const double length = cross.norm();
    out[i].normal = length > 0 ? Eigen::Vector3d(cross / length) : Eigen::Vector3d(0, 0, 0);
  }
}

LIMN_KERNEL void evaluate_grid(const Prepared& surface, std::span<const double> us,
                               std::span<const double> vs, FunctionList& lists_u,
                               FunctionList& lists_v, double* curve, SurfaceFrame* out) noexcept {
  list_functions(*surface.u, us, lists_u);
  list_functions(*surface.v, vs, lists_v);
  const bool rational = surface.data->is_rational();
  for (const Functions<1>& fv : lists_v) {
    rational ? evaluate_line<4>(surface, lists_u, fv, curve, out)
             : evaluate_line<3>(surface, lists_u, fv, curve, out);
    out += us.size();
  }
}

LIMN_ON_EACH_PROCESSOR(grid_of,
                       (const Prepared& surface, std::span<const double> us,
                        std::span<const double> vs, FunctionList& lists_u, FunctionList& lists_v,
                        double* curve, SurfaceFrame* out),
                       (surface, us, vs, lists_u, lists_v, curve, out),
                       evaluate_grid(surface, us, vs, lists_u, lists_v, curve, out))

}  // namespace
}  // namespace bspline_detail

SurfaceEvaluator::SurfaceEvaluator(BsplineSurface surface)
    : surface_(std::move(surface)),
      tables_{BasisTable(surface_.knots(0)), BasisTable(surface_.knots(1))},
      usable_(tables_[0].usable() && tables_[1].usable()) {}

SurfaceJet SurfaceEvaluator::jet(double u, double v) const noexcept {
  const double x = surface_.knots(0).clamp(u);
  const double y = surface_.knots(1).clamp(v);
  return jet_in_spans({surface_.knots(0).find_span(x), surface_.knots(1).find_span(y)}, x, y);
}

SurfaceJet SurfaceEvaluator::jet_in_spans(const std::array<int, 2>& spans, double u,
                                          double v) const noexcept {
  const bspline_detail::Place place{spans, {u, v}};
  SurfaceJet out;
  if (usable_) {
    bspline_detail::jets_of({&surface_.data(), &tables_[0], &tables_[1]}, &place, 1, &out);
    return out;
  }
  constexpr std::array<int, 2> kOrders = {2, 2};
  std::array<Eigen::Vector3d, 9> d;
  evaluate_in_spans(surface_.data(), spans.data(), place.at.data(), kOrders.data(), d[0].data());
  // In the order of TensorSpline::derivatives().
  return {d[0], d[1], d[3], d[2], d[4], d[6]};
}

void SurfaceEvaluator::jets(std::span<const Eigen::Vector2d> at,
                            std::span<SurfaceJet> out) const noexcept {
  LIMN_EXPECT(at.size() == out.size());
  if (!usable_) {
    for (std::size_t i = 0; i < at.size(); ++i) out[i] = jet(at[i].x(), at[i].y());
    return;
  }
  constexpr std::size_t kTogether = 8;
  std::array<bspline_detail::Place, kTogether> places;
  for (std::size_t first = 0; first < at.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, at.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      bspline_detail::Place& place = places[i];
      for (int d = 0; d < 2; ++d) {
        place.at[d] = surface_.knots(d).clamp(at[first + i][d]);
        place.spans[static_cast<std::size_t>(d)] = surface_.knots(d).find_span(place.at[d]);
      }
      bspline_detail::prefetch(surface_, place);
    }
    bspline_detail::jets_of({&surface_.data(), &tables_[0], &tables_[1]}, places.data(), count,
                            out.data() + first);
  }
}

void SurfaceEvaluator::grid(std::span<const double> us, std::span<const double> vs,
                            std::span<SurfaceFrame> out) const {
  LIMN_EXPECT(out.size() == us.size() * vs.size());
  if (usable_) {
    bspline_detail::FunctionList lists_u(us.size());
    bspline_detail::FunctionList lists_v(vs.size());
    std::vector<double> curve(8 * static_cast<std::size_t>(surface_.knots(0).basis_count()));
    bspline_detail::grid_of({&surface_.data(), &tables_[0], &tables_[1]}, us, vs, lists_u, lists_v,
                            curve.data(), out.data());
    return;
  }
  for (std::size_t j = 0; j < vs.size(); ++j) {
    for (std::size_t i = 0; i < us.size(); ++i) {
      const SurfaceJet here = jet(us[i], vs[j]);
      out[i + us.size() * j] = {here.point, here.du, here.dv,
                                normal(here).value_or(Eigen::Vector3d::Zero())};
    }
  }
}

}  // namespace limn
