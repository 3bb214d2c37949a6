// Seconds in floating point do not become a Timestamp silently: rounding is written out.

#include "input/base/time.hpp"

constexpr std::chrono::duration<double> kSeconds{0.1};

#ifdef LIMN_MUST_NOT_COMPILE
const limn::Timestamp when = kSeconds;
#else
const auto when = std::chrono::round<limn::Timestamp>(kSeconds);
#endif
