// A pen's state is one of the five names; a flag of a report is not one by accident.

#include "input/sample/pen_sample.hpp"

limn::PenSample sample() {
  limn::PenSample result;
#ifdef LIMN_MUST_NOT_COMPILE
  result.state = true;
#else
  result.state = limn::PenState::kInContact;
#endif
  return result;
}
