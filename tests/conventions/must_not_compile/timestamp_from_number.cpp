// A time without a unit is refused: seconds and nanoseconds must not be mistaken for each other.

#include "input/base/time.hpp"

#ifdef LIMN_MUST_NOT_COMPILE
const limn::Timestamp when = 12;
#else
const limn::Timestamp when = std::chrono::milliseconds(12);
#endif
