// Knot vectors, control points and weights from bytes: what is accepted can be evaluated, refined
// and asked without a crash or an endless search, whatever its numbers are.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "modeler/bspline/refine.hpp"
#include "modeler/bspline/simplify.hpp"
#include "modeler/bspline/surface_evaluator.hpp"
#include "modeler/surface/curve_crossings.hpp"
#include "modeler/surface/primitives.hpp"
#include "modeler/surface/surface_crossings.hpp"
#include "modeler/surface/surface_index.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using limn::BsplineSurface;
using limn::KnotVector;

using limn::fuzz::Input;
using limn::fuzz::require;

/// Whether a number was any double's bits: then what is found need not be accurate.
bool wild = false;

/// Small decimals, which make valid splines often, or the bits of any double.
double number(Input& input) {
  if (input.byte() % 8 != 0) return (input.byte() - 128) / 16.0;
  wild = true;
  const auto bytes = input.take(sizeof(double));
  double bits = 0;
  if (bytes.size() == sizeof bits) std::memcpy(&bits, bytes.data(), sizeof bits);
  return bits;
}

limn::Expected<KnotVector> any_knots(Input& input) {
  const int degree = input.byte() % 6;
  const bool sorted = input.byte() % 4 != 0;
  const bool periodic = input.byte() % 4 == 0;
  std::vector<double> values;
  const int count = 2 * (degree + 1) + input.byte() % 5;
  for (int i = 0; i < count; ++i) values.push_back(number(input));
  if (sorted) std::sort(values.begin(), values.end());
  if (periodic) return KnotVector::make_periodic(degree, values, number(input));
  return sorted ? KnotVector::make_clamped(degree, values.front(), values.back(),
                                           std::span(values).subspan(1, values.size() - 2))
                : KnotVector::make(degree, values);
}

/// `width` doubles a control point; the last is a weight where `rational`, positive for the most
/// part.
std::vector<double> coordinates(Input& input, const std::vector<KnotVector>& knots,
                                std::size_t width, bool rational) {
  std::size_t count = width;
  for (const KnotVector& k : knots) count *= static_cast<std::size_t>(k.basis_count());
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = number(input);
    if (rational && i % width == width - 1 && input.byte() % 8 != 0) {
      out[i] = std::abs(out[i]) + 0.125;
    }
  }
  // Periodic directions repeat their first points.
  std::size_t stride = width;
  for (const KnotVector& k : knots) {
    const auto n = static_cast<std::size_t>(k.basis_count());
    const auto round = n - static_cast<std::size_t>(k.is_periodic() ? k.degree() : 0);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t layer = i / stride % n;
      if (layer >= round) out[i] = out[i - (layer - layer % round) * stride];
    }
    stride *= n;
  }
  return out;
}

constexpr std::size_t kMostLeaves = 60;

constexpr double kTolerance = 1e-3;  // mm, of crossings

void check_crossing(const limn::SurfaceCrossing& crossing, const BsplineSurface& first,
                    const BsplineSurface& second) {
  // The deviation is that in three places of a span; elsewhere a span may be off by more.
  constexpr double kBetween = 1.5;
  constexpr double kRounding = 1e-8;  // mm, of coordinates up to 8
  const double room = crossing.deviation * kBetween + kRounding;
  const std::vector<double> ends = crossing.curve.knots().breakpoints();
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    for (const double part : {0.0, 0.1, 0.4, 0.6, 0.9}) {
      const double t = ends[i] + part * (ends[i + 1] - ends[i]);
      const Eigen::Vector3d point = crossing.curve.point(t);
      const auto check = [&](const BsplineSurface& surface, const limn::BsplineCurve<2>& on) {
        const Eigen::Vector2d at = on.point(t);
        for (int d = 0; d < 2; ++d) {
          const auto& knots = surface.knots(d);
          const double rounding = 1e-15 * (std::abs(at[d]) + 1);
          require(
              at[d] >= knots.domain_begin() - rounding && at[d] <= knots.domain_end() + rounding,
              "curves lie in the domain");
        }
        const Eigen::Vector3d there = surface.point({at.x(), at.y()});
        require(there.allFinite() && point.allFinite(), "curves are finite");
        require(wild || (there - point).norm() <= room, "curves lie on both surfaces");
      };
      check(first, crossing.on_first);
      check(second, crossing.on_second);
    }
  }
}

void ask(const BsplineSurface& surface, Input& input) {
  const limn::SurfaceEvaluator evaluator(surface);
  (void)evaluator.jet(number(input), number(input));
  const limn::SurfaceIndex index(surface);
  const Eigen::Vector3d p(number(input), number(input), number(input));
  if (!p.allFinite()) return;
  const auto closest = index.closest_point(p);
  require(!(closest.distance < 0), "a distance is 0 or more");
  for (int d = 0; d < 2; ++d) {
    const double u = closest.parameter[d];
    require(u >= surface.knots(d).domain_begin() && u <= surface.knots(d).domain_end(),
            "the parameters lie in the domain");
  }
  if (!wild) {
    require(std::abs((closest.point - p).norm() - closest.distance) < 1e-6,
            "the point is as far away as it says");
  }
  const Eigen::Vector3d direction(number(input), number(input), number(input));
  if (!direction.allFinite() || direction.isZero(0)) return;
  (void)index.first_hit({p, direction});
  const auto hits = index.all_hits({p, direction});
  for (const auto& hit : hits.hits) {
    require(!(hit.t < 0), "hits lie ahead");
    if (wild || !hit.certain) continue;
    require((p + hit.t * direction - hit.point).norm() < 1e-6, "hits lie on the ray");
  }
  // Of rough surfaces the search, though bounded, takes long.
  if (index.leaves().size() > kMostLeaves) return;
  const auto plane = limn::make_plane({p, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 8, 8);
  if (!plane) return;
  const auto crossings = limn::cross_surfaces(index, limn::SurfaceIndex(*plane), kTolerance);
  for (const auto& crossing : crossings.curves) {
    require(crossing.deviation <= kTolerance, "curves are within the tolerance");
    check_crossing(crossing, surface, *plane);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  wild = false;
  const std::uint8_t what = input.byte();
  const auto form = what % 2 == 0 ? limn::Form::kPolynomial : limn::Form::kRational;
  const std::size_t directions = what / 2 % 2 + 1;
  std::vector<KnotVector> knots;
  for (std::size_t d = 0; d < directions; ++d) {
    auto made = any_knots(input);
    if (!made) return 0;
    knots.push_back(*std::move(made));
  }
  const int dimension = directions == 2 ? 3 : 2;
  const auto width = static_cast<std::size_t>(dimension + (form == limn::Form::kRational ? 1 : 0));
  auto spline = limn::SplineData::make(
      knots, dimension, form, coordinates(input, knots, width, form == limn::Form::kRational));
  if (!spline) return 0;
  const double added[] = {number(input)};
  if (auto finer = limn::insert_knots(*spline, 0, added)) {
    require(finer->count() > spline->count(), "a knot brings a control point");
  }
  (void)limn::elevate_degree(*spline, 0, 1);
  (void)limn::segment(*spline, 0, number(input), number(input));
  (void)limn::reverse(*spline, 0);
  (void)limn::to_bezier(*spline, 0);
  (void)limn::reduce_degree(*spline, 0);
  if (directions == 2) {
    ask(BsplineSurface::of(*std::move(spline)), input);
  } else {
    const auto curve = limn::BsplineCurve<2>::of(*std::move(spline));
    const Eigen::Vector2d p(number(input), number(input));
    if (p.allFinite()) {
      const auto closest = limn::closest_on_curve(curve, p);
      require(!(closest.distance < 0), "a distance is 0 or more");
    }
    (void)limn::cross_curves(curve, curve);
  }
  return 0;
}
