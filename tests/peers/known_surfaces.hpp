#pragma once

#include "tests/peers/peer_surface.hpp"

namespace limn::peers {

// Surfaces of which answers are known. Rational ones are exact.

/// A height field over [0, 100]^2 mm with n x n control points, bicubic, uniform knots over
/// [0, 1]^2: hills of up to 5 mm every 35 mm or so on an arch that sags 8 mm at its ends. The same
/// shape for every n, but for what n control points resolve: what closest points and rays are
/// timed on. Precondition: n >= 4.
PeerSurface wavy_sheet(int n);

/// z = x^2 + y^2 over [-1, 1]^2, with u = x and v = y; biquadratic.
PeerSurface paraboloid();

/// About the z axis; u turns about it and v about the tube, both over [0, 1] in four quarters, the
/// tube from its outermost circle upwards. S_u x S_v points outwards.
PeerSurface torus(double major_radius, double minor_radius);

/// u turns about the z axis over [0, 1], v runs from the south pole (0) to the north pole (1): two
/// edges are points. S_u x S_v points outwards.
PeerSurface sphere(double radius);

/// About the origin, once round over [0, 1] in four quarters from (radius, 0).
PeerCurve circle(int dimension, double radius);

}  // namespace limn::peers
