#pragma once

#include <array>

#include "input/base/error.hpp"
#include "modeler/base/frame.hpp"
#include "modeler/bspline/tensor_spline.hpp"

namespace limn {

// Exact shapes in a frame, sizes in mm. S_u x S_v points outwards, or along frame.z where there is
// no inside. Angles are parameters: u runs from 0 to 2 pi about frame.z, from frame.x to frame.y,
// and closes on itself there (the direction is not periodic: it begins and ends on the seam). It is
// not the angle itself but for the quarters. Errors of all: kOutOfRange for a size that is not
// finite and above 0.

/// A circle about frame.z, rational and quadratic.
Expected<BsplineCurve<3>> make_circle(const Frame& frame, double radius);

/// origin + u x + v y, 0 <= u <= width, 0 <= v <= depth.
Expected<BsplineSurface> make_plane(const Frame& frame, double width, double depth);

/// The six faces of [0, size.x] x [0, size.y] x [0, size.z]: low x, high x, low y, .. high z.
Expected<std::array<BsplineSurface, 6>> make_box(const Frame& frame, const Eigen::Vector3d& size);

/// v is the distance from the rim; the centre is a pole, at v = radius.
Expected<BsplineSurface> make_disc(const Frame& frame, double radius);

/// v runs up the axis, 0 <= v <= height.
Expected<BsplineSurface> make_cylinder(const Frame& frame, double radius, double height);

/// Radii at the bottom and at the top; one of them may be 0, where a pole is.
Expected<BsplineSurface> make_cone(const Frame& frame, double bottom_radius, double top_radius,
                                   double height);

/// v runs from the south pole to the north pole, 0 <= v <= pi.
Expected<BsplineSurface> make_sphere(const Frame& frame, double radius);

/// v turns about the tube from its outermost circle upwards, 0 <= v <= 2 pi.
/// Error: kOutOfRange also where the tube is not thinner than the ring.
Expected<BsplineSurface> make_torus(const Frame& frame, double ring_radius, double tube_radius);

}  // namespace limn
