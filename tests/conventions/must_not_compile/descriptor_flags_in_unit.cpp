// A Unit item takes a unit: the flags of an Input item, one slip of the hand away, are refused.

#include "firmware_sim/usb/descriptor_builder.hpp"

using namespace limn::firmware;

#ifdef LIMN_MUST_NOT_COMPILE
constexpr auto built = DescriptorBuilder().unit(InputFlags::kVariable);
#else
constexpr auto built = DescriptorBuilder().unit(Unit::kCentimeter);
#endif
