#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "modeler/surface/collocation.hpp"
#include "modeler/surface/constructions.hpp"

namespace limn {
namespace {

/// A grid as rows and, turned, as columns of x, y, z.
struct Lines {
  std::vector<DataRow> rows;
  std::vector<DataRow> columns;
  std::vector<double> u;
  std::vector<double> v;
};

Expected<Lines> lines_of(const PointGrid& grid, int degree) {
  if (degree < 1 || degree > KnotVector::kMaxDegree) {
    return fail(ErrorCode::kOutOfRange, "degree",
                std::to_string(degree) + " is not 1 to " + std::to_string(KnotVector::kMaxDegree),
                "choose a degree in that range");
  }
  if (grid.columns < 2 || grid.rows < 2 ||
      grid.points.size() !=
          static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows)) {
    return fail(ErrorCode::kPointCount, "points",
                std::to_string(grid.points.size()) + " are given for " +
                    std::to_string(grid.columns) + " by " + std::to_string(grid.rows),
                "give two a direction at least, and all of them");
  }
  Lines out;
  const auto columns = static_cast<std::size_t>(grid.columns);
  out.rows.resize(static_cast<std::size_t>(grid.rows));
  out.columns.resize(columns);
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const Eigen::Vector3d& p = grid.points[i];
    if (!p.allFinite()) {
      return fail(ErrorCode::kOutOfRange, "point " + std::to_string(i),
                  "a coordinate is not finite", "give finite coordinates");
    }
    for (DataRow* line : {&out.rows[i / columns], &out.columns[i % columns]}) {
      line->insert(line->end(), {p.x(), p.y(), p.z()});
    }
  }
  auto u = average_chords(out.columns, 3);
  if (!u) return tl::unexpected(std::move(u.error()));
  auto v = average_chords(out.rows, 3);
  if (!v) return tl::unexpected(std::move(v.error()));
  out.u = *std::move(u);
  out.v = *std::move(v);
  return out;
}

std::vector<DataRow> transposed(const std::vector<DataRow>& rows) {
  const std::size_t columns = rows.front().size() / 3;
  std::vector<DataRow> out(columns);
  for (const DataRow& row : rows) {
    for (std::size_t i = 0; i < columns; ++i) {
      out[i].insert(out[i].end(), row.begin() + static_cast<std::ptrdiff_t>(3 * i),
                    row.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
    }
  }
  return out;
}

/// `count` control points by least squares, all of them where the count allows no less.
Expected<std::vector<DataRow>> fit(const KnotVector& knots, const std::vector<double>& parameters,
                                   const std::vector<DataRow>& rows) {
  return knots.basis_count() == static_cast<int>(rows.size())
             ? interpolate(knots, parameters, rows)
             : approximate(knots, parameters, rows);
}

Expected<GridSurface> fit_grid(const Lines& lines, const KnotVector& ku, const KnotVector& kv) {
  auto along_v = fit(kv, lines.v, lines.rows);
  if (!along_v) return tl::unexpected(std::move(along_v.error()));
  auto along_u = fit(ku, lines.u, transposed(*along_v));
  if (!along_u) return tl::unexpected(std::move(along_u.error()));
  std::vector<double> values;
  for (const DataRow& row : transposed(*along_u))
    values.insert(values.end(), row.begin(), row.end());
  const KnotVector knots[] = {ku, kv};
  auto surface = BsplineSurface::from(SplineData::make(knots, 3, Form::kPolynomial, values));
  if (!surface) return tl::unexpected(std::move(surface.error()));
  double deviation = 0;
  for (std::size_t j = 0; j < lines.v.size(); ++j) {
    for (std::size_t i = 0; i < lines.u.size(); ++i) {
      const Eigen::Vector3d wanted(lines.rows[j][3 * i], lines.rows[j][3 * i + 1],
                                   lines.rows[j][3 * i + 2]);
      deviation = std::max(deviation, (surface->point({lines.u[i], lines.v[j]}) - wanted).norm());
    }
  }
  return GridSurface{*std::move(surface), deviation};
}

int degree_for(int degree, std::size_t count) {
  return std::min(degree, static_cast<int>(count) - 1);
}

/// Knots for `count` control points that share the parameters out evenly. [PT97 eq 9.69]
Expected<KnotVector> shared_knots(int degree, const std::vector<double>& parameters, int count) {
  if (count == static_cast<int>(parameters.size())) return averaged_knots(degree, parameters);
  std::vector<double> interior;
  const double step = static_cast<double>(parameters.size()) / (count - degree);
  for (int j = 1; j < count - degree; ++j) {
    const auto i = static_cast<std::size_t>(j * step);
    const double part = j * step - std::floor(j * step);
    interior.push_back((1 - part) * parameters[i - 1] + part * parameters[i]);
  }
  return KnotVector::make_clamped(degree, parameters.front(), parameters.back(), interior);
}

}  // namespace

Expected<GridSurface> interpolate_grid(const PointGrid& grid, int degree) {
  auto lines = lines_of(grid, degree);
  if (!lines) return tl::unexpected(std::move(lines.error()));
  auto ku = averaged_knots(degree_for(degree, lines->u.size()), lines->u);
  if (!ku) return tl::unexpected(std::move(ku.error()));
  auto kv = averaged_knots(degree_for(degree, lines->v.size()), lines->v);
  if (!kv) return tl::unexpected(std::move(kv.error()));
  return fit_grid(*lines, *ku, *kv);
}

Expected<GridSurface> approximate_grid(const PointGrid& grid, double tolerance, int degree) {
  if (!(std::isfinite(tolerance) && tolerance > 0)) {
    return fail(ErrorCode::kOutOfRange, "tolerance", "it is not a finite number above 0",
                "give it in mm, above 0");
  }
  auto lines = lines_of(grid, degree);
  if (!lines) return tl::unexpected(std::move(lines.error()));
  const int degree_u = degree_for(degree, lines->u.size());
  const int degree_v = degree_for(degree, lines->v.size());
  const int most_u = static_cast<int>(lines->u.size());
  const int most_v = static_cast<int>(lines->v.size());
  int count_u = degree_u + 1;
  int count_v = degree_v + 1;
  // A direction grows by a quarter as long as growing it alone brings more than growing the other.
  for (;;) {
    auto ku = shared_knots(degree_u, lines->u, count_u);
    if (!ku) return tl::unexpected(std::move(ku.error()));
    auto kv = shared_knots(degree_v, lines->v, count_v);
    if (!kv) return tl::unexpected(std::move(kv.error()));
    auto fitted = fit_grid(*lines, *ku, *kv);
    if (fitted && fitted->deviation <= tolerance) return fitted;
    if (count_u == most_u && count_v == most_v) return fitted;
    const auto grown = [](int count, int most) {
      return std::min(most, count + std::max(1, count / 4));
    };
    const auto try_growing = [&](int u, int v) {
      auto knots_u = shared_knots(degree_u, lines->u, u);
      auto knots_v = shared_knots(degree_v, lines->v, v);
      if (!knots_u || !knots_v) return 1e300;
      auto candidate = fit_grid(*lines, *knots_u, *knots_v);
      return candidate ? candidate->deviation : 1e300;
    };
    const int more_u = grown(count_u, most_u);
    const int more_v = grown(count_v, most_v);
    const double by_u = count_u < most_u ? try_growing(more_u, count_v) : 1e301;
    const double by_v = count_v < most_v ? try_growing(count_u, more_v) : 1e301;
    if (by_u <= by_v) {
      count_u = more_u;
    } else {
      count_v = more_v;
    }
  }
}

}  // namespace limn
