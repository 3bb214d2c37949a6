#include "modeler/surface/collocation.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "input/base/expect.hpp"

namespace limn {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

Eigen::MatrixXd matrix_of(std::span<const DataRow> rows) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(rows.size()),
                      static_cast<Eigen::Index>(rows.front().size()));
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    for (Eigen::Index c = 0; c < out.cols(); ++c) {
      out(i, c) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(c)];
    }
  }
  return out;
}

std::vector<DataRow> rows_of(const Eigen::MatrixXd& values) {
  std::vector<DataRow> out(static_cast<std::size_t>(values.rows()));
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    auto& row = out[static_cast<std::size_t>(i)];
    for (Eigen::Index c = 0; c < values.cols(); ++c) row.push_back(values(i, c));
  }
  return out;
}

/// N_j(t_i), row i and column j.
Sparse collocation_matrix(const KnotVector& knots, std::span<const double> parameters) {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> basis(static_cast<std::size_t>(knots.degree()) + 1);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const int span = knots.find_span(parameters[i]);
    knots.basis(span, parameters[i], basis);
    for (int k = 0; k <= knots.degree(); ++k) {
      entries.emplace_back(static_cast<int>(i), span - knots.degree() + k,
                           basis[static_cast<std::size_t>(k)]);
    }
  }
  Sparse out(static_cast<Eigen::Index>(parameters.size()), knots.basis_count());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

tl::unexpected<Error> no_solution() {
  return fail(ErrorCode::kNumeric, "parameters",
              "no spline on these knots is determined by the data",
              "choose fewer knots, or parameters in each of their spans");
}

}  // namespace

Expected<std::vector<double>> average_chords(std::span<const DataRow> rows, std::size_t width) {
  LIMN_EXPECT(rows.size() > 1 && (width == 3 || width == 4));
  std::vector<double> out(rows.size(), 0.0);
  const std::size_t size = rows.front().size();
  const auto point = [width](const DataRow& row, std::size_t i) {
    const double w = width == 4 ? row[i + 3] : 1.0;
    return Eigen::Vector3d(row[i] / w, row[i + 1] / w, row[i + 2] / w);
  };
  std::vector<double> total(size / width, 0.0);
  for (std::size_t p = 0; p < total.size(); ++p) {
    for (std::size_t r = 1; r < rows.size(); ++r) {
      total[p] += (point(rows[r], p * width) - point(rows[r - 1], p * width)).norm();
    }
  }
  std::size_t used = 0;  // points that stand still everywhere have no say
  for (std::size_t p = 0; p < total.size(); ++p) {
    if (!(total[p] > 0)) continue;
    ++used;
    double so_far = 0;
    for (std::size_t r = 1; r < rows.size(); ++r) {
      so_far += (point(rows[r], p * width) - point(rows[r - 1], p * width)).norm();
      out[r] += so_far / total[p];
    }
  }
  for (std::size_t r = 1; r < rows.size(); ++r) {
    out[r] =
        r + 1 == rows.size() ? 1.0 : out[r] / static_cast<double>(std::max<std::size_t>(used, 1));
    if (used == 0 || !(out[r] > out[r - 1])) {
      return fail(ErrorCode::kNumeric, "row " + std::to_string(r),
                  "all its points coincide with those before", "leave it out");
    }
  }
  return out;
}

Expected<KnotVector> averaged_knots(int degree, std::span<const double> parameters) {
  LIMN_EXPECT(static_cast<int>(parameters.size()) > degree && degree >= 1);
  std::vector<double> interior;
  const auto p = static_cast<std::size_t>(degree);
  for (std::size_t j = 1; j + p < parameters.size(); ++j) {
    double sum = 0;
    for (std::size_t i = j; i < j + p; ++i) sum += parameters[i];
    interior.push_back(sum / degree);
  }
  return KnotVector::make_clamped(degree, parameters.front(), parameters.back(), interior);
}

Expected<std::vector<DataRow>> interpolate(const KnotVector& knots,
                                           std::span<const double> parameters,
                                           std::span<const DataRow> rows) {
  LIMN_EXPECT(knots.basis_count() == static_cast<int>(rows.size()) &&
              parameters.size() == rows.size());
  Eigen::SparseLU<Sparse> lu(collocation_matrix(knots, parameters));
  if (lu.info() != Eigen::Success) return no_solution();
  const Eigen::MatrixXd solved = lu.solve(matrix_of(rows));
  if (lu.info() != Eigen::Success || !solved.allFinite()) return no_solution();
  return rows_of(solved);
}

Expected<std::vector<DataRow>> approximate(const KnotVector& knots,
                                           std::span<const double> parameters,
                                           std::span<const DataRow> rows) {
  const Eigen::Index count = knots.basis_count();
  LIMN_EXPECT(count <= static_cast<Eigen::Index>(rows.size()) && parameters.size() == rows.size());
  const Sparse n = collocation_matrix(knots, parameters);
  const Eigen::MatrixXd data = matrix_of(rows);
  Eigen::MatrixXd out(count, data.cols());
  out.row(0) = data.row(0);
  out.row(count - 1) = data.row(data.rows() - 1);
  if (count > 2) {
    const Sparse inner = n.middleCols(1, count - 2);
    const Sparse normal = Sparse(inner.transpose()) * inner;
    const Eigen::MatrixXd left =
        data - n.col(0) * out.row(0) - n.col(count - 1) * out.row(count - 1);
    Eigen::SimplicialLDLT<Sparse> solver(normal);
    if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 1e-14)) {
      return no_solution();
    }
    const Eigen::MatrixXd solved = solver.solve(inner.transpose() * left);
    if (!solved.allFinite()) return no_solution();
    out.middleRows(1, count - 2) = solved;
  }
  return rows_of(out);
}

Expected<KnotVector> quasi_interpolation_knots(std::span<const double> parameters) {
  LIMN_EXPECT(parameters.size() >= 4);
  return KnotVector::make_clamped(3, parameters.front(), parameters.back(),
                                  parameters.subspan(1, parameters.size() - 2));
}

Expected<std::vector<DataRow>> quasi_interpolate(const KnotVector& knots,
                                                 std::span<const double> parameters,
                                                 std::span<const DataRow> rows) {
  LIMN_EXPECT(knots.degree() == 3 && parameters.size() == rows.size() && rows.size() >= 4);
  std::vector<DataRow> out;
  for (int i = 0; i < knots.basis_count(); ++i) {
    const double* t = knots.values().data() + i + 1;  // the control point's own knots
    // Four parameters around the middle one.
    const auto above = std::upper_bound(parameters.begin(), parameters.end(), t[1]);
    const auto before = above - parameters.begin() - 2;
    const auto last = static_cast<std::ptrdiff_t>(parameters.size()) - 4;
    const auto first = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(before, 0, last));
    const double* s = parameters.data() + first;
    // Lagrange's cubic l_k vanishes at the other three a, b, c; its polar form at (x, y, z) is the
    // mean over all orders of (x - a)(y - b)(z - c), divided by its value at s_k.
    std::array<double, 4> weight{};
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<double, 3> r{};
      std::size_t count = 0;
      double value = 1;
      for (std::size_t j = 0; j < 4; ++j) {
        if (j == k) continue;
        r[count++] = s[j];
        value *= s[k] - s[j];
      }
      std::array<std::size_t, 3> order = {0, 1, 2};
      double sum = 0;
      do {
        sum += (t[0] - r[order[0]]) * (t[1] - r[order[1]]) * (t[2] - r[order[2]]);
      } while (std::next_permutation(order.begin(), order.end()));
      weight[k] = sum / 6 / value;
    }
    DataRow row(rows.front().size(), 0.0);
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t c = 0; c < row.size(); ++c) row[c] += weight[k] * rows[first + k][c];
    }
    out.push_back(std::move(row));
  }
  return out;
}

}  // namespace limn
