#include "modeler/fit/stroke_fit.hpp"

namespace limn {

template Expected<CurveFit<1>> fit_curve<1>(std::span<const Eigen::Matrix<double, 1, 1>>,
                                            std::span<const double>, const FitOptions&);
template Expected<CurveFit<2>> fit_curve<2>(std::span<const Eigen::Matrix<double, 2, 1>>,
                                            std::span<const double>, const FitOptions&);
template Expected<CurveFit<3>> fit_curve<3>(std::span<const Eigen::Matrix<double, 3, 1>>,
                                            std::span<const double>, const FitOptions&);

}  // namespace limn
