#include "modeler/fit/stroke_fit.hpp"

template class limn::fit_detail::StrokeFitter<3>;
