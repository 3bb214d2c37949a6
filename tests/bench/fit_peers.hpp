#pragma once

#include "tests/bench/strokes.hpp"

namespace limn::bench {

// Fits of other libraries. Each returns the number of control points of a cubic curve within
// `tolerance_mm` of the samples, 0 where it fails.

#ifdef LIMN_BENCH_OCCT
/// Geom2dAPI_PointsToBSpline, C2, chord length.
int fit_with_occt(const SampledStroke& stroke, double tolerance_mm);
#endif
#ifdef LIMN_BENCH_SISL
/// s1961 with chord length as parameter, and with the sample's number, which is time where samples
/// come at one rate: neither is the better for all shapes. Its tolerance is one a coordinate.
int fit_with_sisl_by_length(const SampledStroke& stroke, double tolerance_mm);
int fit_with_sisl_by_time(const SampledStroke& stroke, double tolerance_mm);
#endif

}  // namespace limn::bench
