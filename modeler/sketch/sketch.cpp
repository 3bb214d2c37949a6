#include "modeler/sketch/sketch.hpp"

namespace limn {

std::size_t SketchStroke::control_point_count() const noexcept {
  const std::size_t count = curve.control_points().size();
  return closed() ? count - static_cast<std::size_t>(curve.knots().degree()) : count;
}

}  // namespace limn
