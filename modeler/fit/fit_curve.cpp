#include "modeler/fit/fit_curve.hpp"

#include <utility>
#include <vector>

namespace limn {

namespace fit_detail {

/// Instantiated in stroke_fit_*d.cpp, one unit a dimension: each takes a compiler a while.
template <int kDimension>
Expected<CurveFit<kDimension>> fit_stroke(
    std::span<const Eigen::Matrix<double, kDimension, 1>> positions, std::span<const double> times,
    const FitOptions& options);

}  // namespace fit_detail

namespace {

/// Dimensions that the fitter is compiled for. The others are fitted in the next one with zeros
/// appended: coordinates that are zero at every sample stay exactly zero in every control point.
constexpr int compiled_dimension(int dimension) {
  if (dimension <= 2) return 2;
  return dimension == 3 ? 3 : 10;
}

template <int kFrom, int kTo>
CurveFit<kTo> truncated(CurveFit<kFrom> wide, Expected<BsplineCurve<kTo>> curve) {
  CurveFit<kTo> out;
  out.curve = *std::move(curve);
  out.sample_parameters = std::move(wide.sample_parameters);
  out.deviation_max = wide.deviation_max;
  out.deviation_rms = wide.deviation_rms;
  out.polyline_deviation_max = wide.polyline_deviation_max;
  out.corners = std::move(wide.corners);
  out.closed = wide.closed;
  return out;
}

}  // namespace

template <int kDimension>
Expected<CurveFit<kDimension>> fit_curve(
    std::span<const Eigen::Matrix<double, kDimension, 1>> positions, std::span<const double> times,
    const FitOptions& options) {
  constexpr int kCompiled = compiled_dimension(kDimension);
  if constexpr (kCompiled == kDimension) {
    return fit_detail::fit_stroke<kDimension>(positions, times, options);
  } else {
    using Wide = Eigen::Matrix<double, kCompiled, 1>;
    std::vector<Wide> padded;
    padded.reserve(positions.size());
    for (const auto& p : positions) {
      padded.push_back(Wide::Zero());
      padded.back().template head<kDimension>() = p;
    }
    auto fitted = fit_detail::fit_stroke<kCompiled>(padded, times, options);
    if (!fitted) return tl::unexpected(std::move(fitted.error()));
    std::vector<Eigen::Matrix<double, kDimension, 1>> points;
    for (const Wide& p : fitted->curve.control_points()) {
      points.push_back(p.template head<kDimension>());
    }
    auto curve = BsplineCurve<kDimension>::make(fitted->curve.knots(), std::move(points));
    if (!curve) return tl::unexpected(std::move(curve.error()));
    return truncated<kCompiled, kDimension>(*std::move(fitted), std::move(curve));
  }
}

template Expected<CurveFit<1>> fit_curve<1>(std::span<const Eigen::Matrix<double, 1, 1>>,
                                            std::span<const double>, const FitOptions&);
template Expected<CurveFit<2>> fit_curve<2>(std::span<const Eigen::Matrix<double, 2, 1>>,
                                            std::span<const double>, const FitOptions&);
template Expected<CurveFit<3>> fit_curve<3>(std::span<const Eigen::Matrix<double, 3, 1>>,
                                            std::span<const double>, const FitOptions&);
template Expected<CurveFit<4>> fit_curve<4>(std::span<const Eigen::Matrix<double, 4, 1>>,
                                            std::span<const double>, const FitOptions&);
template Expected<CurveFit<5>> fit_curve<5>(std::span<const Eigen::Matrix<double, 5, 1>>,
                                            std::span<const double>, const FitOptions&);
template Expected<CurveFit<6>> fit_curve<6>(std::span<const Eigen::Matrix<double, 6, 1>>,
                                            std::span<const double>, const FitOptions&);
template Expected<CurveFit<7>> fit_curve<7>(std::span<const Eigen::Matrix<double, 7, 1>>,
                                            std::span<const double>, const FitOptions&);
template Expected<CurveFit<8>> fit_curve<8>(std::span<const Eigen::Matrix<double, 8, 1>>,
                                            std::span<const double>, const FitOptions&);
template Expected<CurveFit<9>> fit_curve<9>(std::span<const Eigen::Matrix<double, 9, 1>>,
                                            std::span<const double>, const FitOptions&);
template Expected<CurveFit<10>> fit_curve<10>(std::span<const Eigen::Matrix<double, 10, 1>>,
                                              std::span<const double>, const FitOptions&);

}  // namespace limn
