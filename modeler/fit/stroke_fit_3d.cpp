#include "modeler/fit/stroke_fit.hpp"

template limn::Expected<limn::CurveFit<3>> limn::fit_detail::fit_stroke<3>(
    std::span<const Eigen::Matrix<double, 3, 1>>, std::span<const double>, const limn::FitOptions&);
