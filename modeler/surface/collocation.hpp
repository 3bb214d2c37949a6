#pragma once

#include <span>
#include <vector>

#include "input/base/error.hpp"
#include "modeler/bspline/knot_vector.hpp"

namespace limn {

// Curves through or near data in one direction, as surfaces need them: the data are rows of numbers
// (points of a section, of a line of a grid), all treated alike. Parameters ascend from 0 to 1.

using DataRow = std::vector<double>;

/// Parameters of rows by the average distance of their points, 3 coordinates and `width` doubles
/// each (the fourth a weight to divide by). [PT97 eq 10.8]
/// Error: kNumeric where two neighbours do not differ.
Expected<std::vector<double>> average_chords(std::span<const DataRow> rows, std::size_t width);

/// Clamped knots with as many control points as there are parameters, each interior knot the
/// average of `degree` neighbours, so that interpolation is well conditioned. [PT97 eq 9.8]
/// Precondition: more parameters than `degree`.
Expected<KnotVector> averaged_knots(int degree, std::span<const double> parameters);

/// Control rows of the spline that has the value rows[i] at parameters[i].
/// Error: kNumeric where there is none. Precondition: knots.basis_count() of each.
Expected<std::vector<DataRow>> interpolate(const KnotVector& knots,
                                           std::span<const double> parameters,
                                           std::span<const DataRow> rows);

/// Control rows of the spline nearest to the rows by least squares, the first and last met.
/// Error: kNumeric where it is not unique. Precondition: at least knots.basis_count() of each.
Expected<std::vector<DataRow>> approximate(const KnotVector& knots,
                                           std::span<const double> parameters,
                                           std::span<const DataRow> rows);

/// Cubic clamped knots with an interior knot at each interior parameter.
/// Precondition: four parameters or more.
Expected<KnotVector> quasi_interpolation_knots(std::span<const double> parameters);

/// Control rows that depend on four neighbouring rows each: the polar form of the cubic through
/// them at the control point's knots [Ramshaw89]. Precondition: knots of
/// quasi_interpolation_knots().
Expected<std::vector<DataRow>> quasi_interpolate(const KnotVector& knots,
                                                 std::span<const double> parameters,
                                                 std::span<const DataRow> rows);

}  // namespace limn
