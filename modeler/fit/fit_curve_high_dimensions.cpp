// A translation unit of its own, so that the build can compile it beside the common dimensions.
#include "modeler/fit/stroke_fit.hpp"

namespace limn {

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
