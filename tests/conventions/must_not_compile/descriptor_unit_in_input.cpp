// An Input item takes its flags, no unit and no number.

#include "firmware_sim/usb/descriptor_builder.hpp"

using namespace limn::firmware;

#ifdef LIMN_MUST_NOT_COMPILE
constexpr auto built = DescriptorBuilder().input(Unit::kDegree);
#else
constexpr auto built = DescriptorBuilder().input(InputFlags::kConstant);
#endif
