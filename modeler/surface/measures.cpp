#include "modeler/surface/measures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <queue>
#include <vector>

#include "modeler/bspline/surface_evaluator.hpp"

namespace limn {
namespace {

constexpr int kMostCells = 20'000;

/// Nodes and weights of Gauss-Legendre quadrature on [-1, 1]: 8 points, exact to degree 15.
struct Node {
  double x;
  double weight;
};
constexpr std::array<Node, 8> kGauss = {{{-0.9602898564975363, 0.1012285362903763},
                                         {-0.7966664774136267, 0.2223810344533745},
                                         {-0.5255324099163290, 0.3137066458778873},
                                         {-0.1834346424956498, 0.3626837833783620},
                                         {0.1834346424956498, 0.3626837833783620},
                                         {0.5255324099163290, 0.3137066458778873},
                                         {0.7966664774136267, 0.2223810344533745},
                                         {0.9602898564975363, 0.1012285362903763}}};

/// A box of parameters (kDimension of them), its integral and how much halving changed it.
template <std::size_t kDimension>
struct Cell {
  std::array<double, kDimension> low;
  std::array<double, kDimension> high;
  double value = 0;
  double error = 0;
  bool operator<(const Cell& other) const { return error < other.error; }
};

/// Halves the cells of largest error first. `integrate(cell)` is the quadrature of one.
template <std::size_t kDimension, class Integrate>
Measure integrate_adaptively(std::vector<Cell<kDimension>> cells, double relative,
                             Integrate integrate) {
  std::priority_queue<Cell<kDimension>> queue;
  Measure total;
  int count = 0;
  // The value of a cell is that of its halves in all directions, its error the change by that.
  const auto add = [&](Cell<kDimension> cell, double whole) {
    double sum = 0;
    for (std::size_t part = 0; part < (1U << kDimension); ++part) {
      Cell<kDimension> half = cell;
      for (std::size_t d = 0; d < kDimension; ++d) {
        const double middle = cell.low[d] + 0.5 * (cell.high[d] - cell.low[d]);
        ((part >> d & 1) != 0 ? half.low[d] : half.high[d]) = middle;
      }
      sum += integrate(half);
    }
    cell.value = sum;
    cell.error = std::abs(sum - whole);
    total.value += cell.value;
    total.error += cell.error;
    queue.push(cell);
    ++count;
  };
  for (const auto& cell : cells) add(cell, integrate(cell));
  while (total.error > relative * std::abs(total.value) && count < kMostCells) {
    const Cell<kDimension> worst = queue.top();
    if (worst.error <= 1e-17 * std::abs(total.value)) break;  // all that is left is rounding
    queue.pop();
    total.value -= worst.value;
    total.error -= worst.error;
    for (std::size_t part = 0; part < (1U << kDimension); ++part) {
      Cell<kDimension> half = worst;
      for (std::size_t d = 0; d < kDimension; ++d) {
        const double middle = worst.low[d] + 0.5 * (worst.high[d] - worst.low[d]);
        ((part >> d & 1) != 0 ? half.low[d] : half.high[d]) = middle;
      }
      add(half, integrate(half));
    }
  }
  // Summed anew: the running sum has lost digits to what was taken out again.
  total = {};
  while (!queue.empty()) {
    total.value += queue.top().value;
    total.error += queue.top().error;
    queue.pop();
  }
  return total;
}

template <int kDimension>
Measure length_between(const BsplineCurve<kDimension>& curve, double low, double high,
                       double relative) {
  std::vector<Cell<1>> cells;
  const auto ends = curve.knots().breakpoints();
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double a = std::max(ends[i], low);
    const double b = std::min(ends[i + 1], high);
    if (a < b) cells.push_back({{a}, {b}});
  }
  return integrate_adaptively(std::move(cells), relative, [&curve](const Cell<1>& cell) {
    const double half = 0.5 * (cell.high[0] - cell.low[0]);
    double sum = 0;
    for (const Node& node : kGauss) {
      std::array<typename BsplineCurve<kDimension>::Point, 2> d;
      curve.derivatives(cell.low[0] + half * (1 + node.x), d);
      sum += node.weight * d[1].norm();
    }
    return half * sum;
  });
}

/// Integrates f(point, S_u x S_v) over all spans.
template <class Function>
Measure over_surface(const BsplineSurface& surface, double relative, Function f) {
  const SurfaceEvaluator evaluator(surface);
  std::vector<Cell<2>> cells;
  const auto us = surface.knots(0).breakpoints();
  const auto vs = surface.knots(1).breakpoints();
  for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
      cells.push_back({{us[i], vs[j]}, {us[i + 1], vs[j + 1]}});
    }
  }
  return integrate_adaptively(std::move(cells), relative, [&](const Cell<2>& cell) {
    const double half_u = 0.5 * (cell.high[0] - cell.low[0]);
    const double half_v = 0.5 * (cell.high[1] - cell.low[1]);
    double sum = 0;
    for (const Node& u : kGauss) {
      for (const Node& v : kGauss) {
        const SurfaceJet jet =
            evaluator.jet(cell.low[0] + half_u * (1 + u.x), cell.low[1] + half_v * (1 + v.x));
        sum += u.weight * v.weight * f(jet.point, jet.du.cross(jet.dv));
      }
    }
    return half_u * half_v * sum;
  });
}

}  // namespace

Measure arc_length(const BsplineCurve<2>& curve, double relative) {
  return length_between(curve, curve.knots().domain_begin(), curve.knots().domain_end(), relative);
}

Measure arc_length(const BsplineCurve<3>& curve, double relative) {
  return length_between(curve, curve.knots().domain_begin(), curve.knots().domain_end(), relative);
}

Measure arc_length(const BsplineCurve<3>& curve, double low, double high, double relative) {
  return length_between(curve, low, high, relative);
}

Measure area(const BsplineSurface& surface, double relative) {
  return over_surface(surface, relative,
                      [](const Eigen::Vector3d&, const Eigen::Vector3d& n) { return n.norm(); });
}

Measure volume(const BsplineSurface& surface, double relative) {
  return over_surface(surface, relative, [](const Eigen::Vector3d& p, const Eigen::Vector3d& n) {
    return p.dot(n) / 3;
  });
}

}  // namespace limn
