#pragma once

#include <array>

namespace limn::fit_detail {

/// The four cubic B-splines that do not vanish on a span, their first and second derivatives.
struct CubicBasis {
  std::array<double, 4> value;
  std::array<double, 4> first;
  std::array<double, 4> second;
};

/// N_{s-3..s,3}(u) where `knot` points at u_s, u_s < u_{s+1}. The cubic case of
/// KnotVector::basis, unrolled: the fit spends half its time here. [PT97 A2.2]
inline std::array<double, 4> cubic_values(const double* knot, double u) noexcept {
  const double l1 = u - knot[0];
  const double r1 = knot[1] - u;
  const double l2 = u - knot[-1];
  const double r2 = knot[2] - u;
  const double l3 = u - knot[-2];
  const double r3 = knot[3] - u;
  const double t = 1.0 / (r1 + l1);
  const double a = r1 * t / (r1 + l2);
  const double b = l1 * t / (r2 + l1);
  const double x = r1 * a / (r1 + l3);
  const double y = (l2 * a + r2 * b) / (r2 + l2);
  const double z = l1 * b / (r3 + l1);
  return {r1 * x, l3 * x + r2 * y, l2 * y + r3 * z, l1 * z};
}

/// The same with two derivatives.
inline CubicBasis cubic_basis(const double* knot, double u) noexcept {
  const double l1 = u - knot[0];
  const double r1 = knot[1] - u;
  const double l2 = u - knot[-1];
  const double r2 = knot[2] - u;
  const double l3 = u - knot[-2];
  const double r3 = knot[3] - u;
  const double t = 1.0 / (r1 + l1);
  const double d0 = 1.0 / (r1 + l2);
  const double d1 = 1.0 / (r2 + l1);
  const double e0 = 1.0 / (r1 + l3);
  const double e1 = 1.0 / (r2 + l2);
  const double e2 = 1.0 / (r3 + l1);
  const double a = r1 * t * d0;
  const double b = l1 * t * d1;
  const double x = r1 * a * e0;
  const double y = (l2 * a + r2 * b) * e1;
  const double z = l1 * b * e2;
  const double p = 2 * a;  // slopes of the quadratic B-splines are -p, p - q, q
  const double q = 2 * b;
  const double xx = -p * e0;
  const double yy = (p - q) * e1;
  const double zz = q * e2;
  return {{r1 * x, l3 * x + r2 * y, l2 * y + r3 * z, l1 * z},
          {-3 * x, 3 * (x - y), 3 * (y - z), 3 * z},
          {-3 * xx, 3 * (xx - yy), 3 * (yy - zz), 3 * zz}};
}

}  // namespace limn::fit_detail
