#pragma once

#include <utility>

#include "tests/peers/peer_surface.hpp"
#include "tests/support/rng.hpp"

namespace limn::peers {

/// Bounds of what random_surface() and random_curve() draw.
struct RandomSplines {
  int max_degree = 7;          ///< of each direction by itself, from 1
  int max_interior_knots = 8;  ///< distinct ones, from 1
  double repeated = 0.3;       ///< share of them with a multiplicity drawn from 1 .. degree
  double rational = 0.5;       ///< share of rational splines; weights 0.3 .. 3
  int decimals = 0;            ///< to which all numbers are rounded; 0: not
};

/// A surface over a lattice of unit spacing, every control point moved by up to 0.7 in each
/// direction: degenerate nowhere in general, often folded. Knot spans are 0.2 to 1 long and the
/// domain starts anywhere in -2 .. 2. The same seed gives the same surface on every machine.
PeerSurface random_surface(test::Rng& rng, const RandomSplines& bounds = {});

/// The same with one parameter. Precondition: dimension is 2 or 3.
PeerCurve random_curve(test::Rng& rng, int dimension, const RandomSplines& bounds = {});

/// Two wavy sheets of 10 x 10, degrees 2 to 4 and 6 to 10 control points a direction, that share
/// their middle; the second is turned by 10 to 90 degrees about a random axis in the plane of the
/// first. A third of the pairs meets in several branches, up to seven, and some in loops.
std::pair<PeerSurface, PeerSurface> random_crossing_pair(test::Rng& rng);

}  // namespace limn::peers
