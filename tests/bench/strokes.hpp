#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace limn::bench {

/// Samples of one contact of a pen: what a fit is given.
struct SampledStroke {
  std::string name;
  std::vector<Eigen::Vector2d> positions;  ///< mm
  std::vector<double> times;               ///< seconds, rising
};

/// Four shapes as a pen on an A5 tablet gives them: `count` samples at 200 Hz with Gaussian noise
/// of `sigma_mm` in each coordinate, cut to 200 counts a mm. The same strokes on every machine.
///
///     lissajous   3:2, no corner, runs into itself
///     spiral      six turns, evenly growing
///     cursive     a row of loops that leans, as in joined writing
///     corners     a zigzag of 24 corners at which the pen stops
std::vector<SampledStroke> drawn_strokes(int count, double sigma_mm);

/// The strokes of the CSV files under ../shared/strokes/`folder` whose names hold `part`; none
/// where that folder is absent.
std::vector<SampledStroke> recorded_strokes(const std::string& folder, const std::string& part);

}  // namespace limn::bench
