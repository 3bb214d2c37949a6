#include "modeler/fit/stroke_fit.hpp"

template limn::Expected<limn::CurveFit<2>> limn::fit_detail::fit_stroke<2>(
    std::span<const Eigen::Matrix<double, 2, 1>>, std::span<const double>, const limn::FitOptions&);
