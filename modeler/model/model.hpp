#pragma once

#include <string>
#include <vector>

#include "modeler/model/body.hpp"

namespace limn {

/// A curve in space that bounds nothing.
struct NamedCurve {
  std::string name;
  BsplineCurve<3> curve;
};

/// What a file holds: bodies and free curves, in mm, z up.
struct Model {
  std::vector<Body> bodies;
  std::vector<NamedCurve> curves;
};

}  // namespace limn
