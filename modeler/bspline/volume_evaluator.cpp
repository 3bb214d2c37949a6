#include "modeler/bspline/volume_evaluator.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "input/base/expect.hpp"
#include "modeler/bspline/basis_kernels.hpp"

namespace limn {
namespace bspline_detail {
namespace {

/// A volume as the kernels see it.
struct Prepared {
  const SplineData* data;
  const std::array<BasisTable, 3>* tables;
};

/// A point and its tangents in whole vectors.
struct Sums {
  Lanes s = {0, 0, 0, 0};
  Lanes u = s;
  Lanes v = s;
  Lanes w = s;
};

LIMN_KERNEL void put(const Sums& sums, bool rational, VolumeJet& out) noexcept {
  Lanes s = sums.s;
  Lanes u = sums.u;
  Lanes v = sums.v;
  Lanes w = sums.w;
  if (rational) {  // lane 3 is the weight
    const double per_weight = 1 / s[3];
    s = s * per_weight;
    u = (u - u[3] * s) * per_weight;
    v = (v - v[3] * s) * per_weight;
    w = (w - w[3] * s) * per_weight;
  }
  out.point = {s[0], s[1], s[2]};
  out.du = {u[0], u[1], u[2]};
  out.dv = {v[0], v[1], v[2]};
  out.dw = {w[0], w[1], w[2]};
}

template <int kWidth>
LIMN_KERNEL void evaluate_jets(const Prepared& volume, std::span<const Eigen::Vector3d> at,
                               VolumeJet* out) noexcept {
  const PagedArray& coordinates = volume.data->coordinates();
  const std::array<BasisTable, 3>& tables = *volume.tables;
  const auto row = static_cast<std::size_t>(tables[0].knots().basis_count());
  const auto plane = row * static_cast<std::size_t>(tables[1].knots().basis_count());
  const auto count = static_cast<std::size_t>(tables[0].knots().degree()) + 1;
  const int degree_v = tables[1].knots().degree();
  const int degree_w = tables[2].knots().degree();
  double scratch[(BasisTable::kMostDegree + 1) * kWidth + PagedArray::kPadding];
  Functions<1> fu;
  Functions<1> fv;
  Functions<1> fw;
  for (const Eigen::Vector3d& place : at) {
    evaluate_functions(tables[0], place.x(), fu);
    evaluate_functions(tables[1], place.y(), fv);
    evaluate_functions(tables[2], place.z(), fw);
    const std::size_t first = static_cast<std::size_t>(fu.first) +
                              row * static_cast<std::size_t>(fv.first) +
                              plane * static_cast<std::size_t>(fw.first);
    Sums sums;
    for (int k = 0; k <= degree_w; ++k) {
      Sums flat;  // of the plane, without w
      for (int j = 0; j <= degree_v; ++j) {
        const std::size_t begin =
            first + row * static_cast<std::size_t>(j) + plane * static_cast<std::size_t>(k);
        const double* p = coordinates.run(begin * kWidth, count * kWidth, scratch);
        Lanes x;
        load(p, x);
        Lanes line = x * fu.value[0][0];
        Lanes line_u = x * fu.value[1][0];
        for (std::size_t i = 1; i < count; ++i) {
          load(p + i * kWidth, x);
          line += x * fu.value[0][i];
          line_u += x * fu.value[1][i];
        }
        flat.s += line * fv.value[0][j];
        flat.u += line_u * fv.value[0][j];
        flat.v += line * fv.value[1][j];
      }
      sums.s += flat.s * fw.value[0][k];
      sums.u += flat.u * fw.value[0][k];
      sums.v += flat.v * fw.value[0][k];
      sums.w += flat.s * fw.value[1][k];
    }
    put(sums, kWidth == 4, *out++);
  }
}

LIMN_ON_EACH_PROCESSOR(volume_jets_of,
                       (const Prepared& volume, std::span<const Eigen::Vector3d> at,
                        VolumeJet* out),
                       (volume, at, out),
                       volume.data->is_rational() ? evaluate_jets<4>(volume, at, out)
                                                  : evaluate_jets<3>(volume, at, out))

using FunctionList = std::vector<Functions<1>>;

/// Room for what a grid sums up: a vector of values and one of derivatives a control point of a
/// plane, and for each control point of a line values and derivatives by v and by w.
struct GridRoom {
  FunctionList us;
  FunctionList vs;
  FunctionList ws;
  std::vector<double> plane;
  std::vector<double> line;
};

/// Control points of the surface at w, and of its derivative.
template <int kWidth>
LIMN_KERNEL void sum_plane(const Prepared& volume, const Functions<1>& fw,
                           GridRoom& room) noexcept {
  const PagedArray& coordinates = volume.data->coordinates();
  const std::size_t count = room.plane.size() / 8;
  const int degree = (*volume.tables)[2].knots().degree();
  double scratch[4 + PagedArray::kPadding];
  for (std::size_t i = 0; i < count; ++i) {
    Lanes s = {0, 0, 0, 0};
    Lanes w = s;
    for (int k = 0; k <= degree; ++k) {
      const std::size_t at = i + count * static_cast<std::size_t>(fw.first + k);
      Lanes x;
      load(coordinates.run(at * kWidth, kWidth, scratch), x);
      s += x * fw.value[0][k];
      w += x * fw.value[1][k];
    }
    store(s, &room.plane[8 * i]);
    store(w, &room.plane[8 * i + 4]);
  }
}

/// Control points of the curve at v of that surface, and of its derivatives.
LIMN_KERNEL void sum_line(const Prepared& volume, const Functions<1>& fv, GridRoom& room) noexcept {
  const std::size_t count = room.line.size() / 12;
  const int degree = (*volume.tables)[1].knots().degree();
  for (std::size_t i = 0; i < count; ++i) {
    Sums sums;
    for (int j = 0; j <= degree; ++j) {
      const double* p = &room.plane[8 * (i + count * static_cast<std::size_t>(fv.first + j))];
      Lanes x;
      Lanes x_w;
      load(p, x);
      load(p + 4, x_w);
      sums.s += x * fv.value[0][j];
      sums.v += x * fv.value[1][j];
      sums.w += x_w * fv.value[0][j];
    }
    store(sums.s, &room.line[12 * i]);
    store(sums.v, &room.line[12 * i + 4]);
    store(sums.w, &room.line[12 * i + 8]);
  }
}

LIMN_KERNEL void sum_points(const Prepared& volume, const GridRoom& room, VolumeJet* out) noexcept {
  const int degree = (*volume.tables)[0].knots().degree();
  for (const Functions<1>& fu : room.us) {
    Sums sums;
    const double* p = &room.line[12 * static_cast<std::size_t>(fu.first)];
    for (int i = 0; i <= degree; ++i, p += 12) {
      Lanes x;
      Lanes x_v;
      Lanes x_w;
      load(p, x);
      load(p + 4, x_v);
      load(p + 8, x_w);
      sums.s += x * fu.value[0][i];
      sums.u += x * fu.value[1][i];
      sums.v += x_v * fu.value[0][i];
      sums.w += x_w * fu.value[0][i];
    }
    put(sums, volume.data->is_rational(), *out++);
  }
}

LIMN_KERNEL void evaluate_grid(const Prepared& volume, GridRoom& room, VolumeJet* out) noexcept {
  for (const Functions<1>& fw : room.ws) {
    volume.data->is_rational() ? sum_plane<4>(volume, fw, room) : sum_plane<3>(volume, fw, room);
    for (const Functions<1>& fv : room.vs) {
      sum_line(volume, fv, room);
      sum_points(volume, room, out);
      out += room.us.size();
    }
  }
}

LIMN_ON_EACH_PROCESSOR(volume_grid_of, (const Prepared& volume, GridRoom& room, VolumeJet* out),
                       (volume, room, out), evaluate_grid(volume, room, out))

FunctionList functions_at(const BasisTable& table, std::span<const double> at) {
  FunctionList out(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) evaluate_functions(table, at[i], out[i]);
  return out;
}

}  // namespace
}  // namespace bspline_detail

VolumeEvaluator::VolumeEvaluator(BsplineVolume volume)
    : volume_(std::move(volume)),
      tables_{BasisTable(volume_.knots(0)), BasisTable(volume_.knots(1)),
              BasisTable(volume_.knots(2))},
      usable_(tables_[0].usable() && tables_[1].usable() && tables_[2].usable()) {}

VolumeJet VolumeEvaluator::jet(const Eigen::Vector3d& at) const noexcept {
  VolumeJet out;
  jets({&at, 1}, {&out, 1});
  return out;
}

void VolumeEvaluator::jets(std::span<const Eigen::Vector3d> at,
                           std::span<VolumeJet> out) const noexcept {
  LIMN_EXPECT(at.size() == out.size());
  if (usable_) return bspline_detail::volume_jets_of({&volume_.data(), &tables_}, at, out.data());
  for (std::size_t i = 0; i < at.size(); ++i) {
    std::array<Eigen::Vector3d, 8> d;
    volume_.derivatives({at[i].x(), at[i].y(), at[i].z()}, {1, 1, 1}, d);
    out[i] = {d[0], d[1], d[2], d[4]};
  }
}

void VolumeEvaluator::grid(std::span<const double> us, std::span<const double> vs,
                           std::span<const double> ws, std::span<VolumeJet> out) const {
  LIMN_EXPECT(out.size() == us.size() * vs.size() * ws.size());
  if (usable_) {
    const auto row = static_cast<std::size_t>(volume_.knots(0).basis_count());
    const auto column = static_cast<std::size_t>(volume_.knots(1).basis_count());
    bspline_detail::GridRoom room{
        bspline_detail::functions_at(tables_[0], us), bspline_detail::functions_at(tables_[1], vs),
        bspline_detail::functions_at(tables_[2], ws), std::vector<double>(8 * row * column),
        std::vector<double>(12 * row)};
    return bspline_detail::volume_grid_of({&volume_.data(), &tables_}, room, out.data());
  }
  std::size_t next = 0;
  for (const double w : ws) {
    for (const double v : vs) {
      for (const double u : us) out[next++] = jet({u, v, w});
    }
  }
}

}  // namespace limn
