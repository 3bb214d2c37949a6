#include "modeler/fit/stroke_fit.hpp"

template limn::Expected<limn::CurveFit<10>> limn::fit_detail::fit_stroke<10>(
    std::span<const Eigen::Matrix<double, 10, 1>>, std::span<const double>,
    const limn::FitOptions&);
