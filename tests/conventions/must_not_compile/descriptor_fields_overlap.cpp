// A table of fields that overlap stops the build at its static_assert.

#include "firmware_sim/usb/report_field.hpp"

using namespace limn::firmware;

#ifdef LIMN_MUST_NOT_COMPILE
constexpr std::uint16_t kSecondBit = 0;
#else
constexpr std::uint16_t kSecondBit = 1;
#endif

constexpr FieldSpec kFields[] = {
    {usages::kTipSwitch, 0, 1, {0, 1}, kNoPhysical, Unit::kNone, 0},
    {usages::kInRange, kSecondBit, 1, {0, 1}, kNoPhysical, Unit::kNone, 0},
};
static_assert(is_well_formed(kFields, 8));
