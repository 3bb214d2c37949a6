// A set of axes is made of axes, never of a number.

#include "input/sample/pen_sample.hpp"

limn::PenAxes axes() {
#ifdef LIMN_MUST_NOT_COMPILE
  return 3;
#else
  limn::PenAxes set;
  set.add(limn::PenAxis::kX);
  return set;
#endif
}
