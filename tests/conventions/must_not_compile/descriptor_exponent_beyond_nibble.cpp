// A unit exponent has four bits: -8 to 7.

#include "firmware_sim/usb/descriptor_builder.hpp"

using namespace limn::firmware;

#ifdef LIMN_MUST_NOT_COMPILE
constexpr UnitExponent exponent = -9;
#else
constexpr UnitExponent exponent = -8;
#endif
