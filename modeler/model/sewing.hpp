#pragma once

#include <string>
#include <vector>

#include "input/base/error.hpp"
#include "modeler/model/body.hpp"

namespace limn {

/// A body whose faces are all of these surfaces. Borders that coincide within `tolerance` (mm), in
/// either direction and at proportional parameters, become one edge, also two of one surface (a
/// seam); a border whose control points lie within `tolerance` of one place becomes a pole. Each
/// other border is an edge of its own.
///
/// Edges hold to Edge::deviation, a bound from hulls. O(n^2) in the borders, cheap but for those
/// whose ends meet.
/// Errors: kOutOfRange unless tolerance > 0 and finite, or for a surface with a direction of degree
/// 0, whose pieces have borders of their own; kMissing for no surfaces.
Expected<Body> sew(std::string name, std::vector<BsplineSurface> surfaces, double tolerance);

/// Whether each edge but poles has exactly two uses: the body has an inside.
bool is_closed(const Body& body);

/// A border of a surface, in mm, parameterised by the surface's own u (direction 0, at the first or
/// the last v) or v (direction 1, at the first or the last u). Precondition: degrees above 0.
BsplineCurve<3> border_curve(const BsplineSurface& surface, int direction, bool last);

}  // namespace limn
