#pragma once

#include <string>
#include <vector>

#include "tests/bench/areas.hpp"

namespace limn::bench {

/// How a job's cost grows with the number of control points.
struct GrowthCurve {
  std::string name;
  std::vector<double> control_points;
  std::vector<double> cost;  ///< as many, in any unit; all above 0
};

/// On logarithmic axes: costs against that of each curve's first place, so that all begin at 1.
/// Precondition: curves with two places at least.
Picture draw_growth(const std::vector<GrowthCurve>& curves);

}  // namespace limn::bench
