#pragma once

#include <Eigen/Core>
#include <vector>

#include "modeler/surface/crossing_jets.hpp"
#include "modeler/surface/surface_crossings.hpp"

namespace limn {

/// A place where two surfaces meet and no curve in which they cross leads through.
struct MeetingPlace {
  CrossingPlace place;
  Eigen::Vector3d point;
  /// How far from `point` the surfaces may meet as well, mm: 0 where they do not, near it.
  double reach = 0;
};

/// Meeting places that are the same, or whose reaches meet, are one touch. Its extent is that of
/// all its places with their reaches, and 0 only where all are one isolated place. O(n log n) for
/// n places of about equal reaches.
std::vector<SurfaceTouch> touches_of(const std::vector<MeetingPlace>& found);

}  // namespace limn
