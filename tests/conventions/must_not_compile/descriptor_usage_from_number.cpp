// A usage belongs to a page: a bare number is refused.

#include "firmware_sim/usb/descriptor_builder.hpp"

using namespace limn::firmware;

#ifdef LIMN_MUST_NOT_COMPILE
constexpr auto built = DescriptorBuilder().usage(0x42);
#else
constexpr auto built = DescriptorBuilder().usage(usages::kTipSwitch);
#endif
