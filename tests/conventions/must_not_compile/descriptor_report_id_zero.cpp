// Report ID 0 is reserved.

#include "firmware_sim/usb/descriptor_builder.hpp"

using namespace limn::firmware;

#ifdef LIMN_MUST_NOT_COMPILE
constexpr ReportId id{0};
#else
constexpr ReportId id{1};
#endif
