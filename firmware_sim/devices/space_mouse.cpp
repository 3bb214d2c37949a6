#include "firmware_sim/devices/space_mouse.hpp"

#include "firmware_sim/devices/counts.hpp"
#include "firmware_sim/usb/descriptor_builder.hpp"

namespace limn::firmware {
namespace {

constexpr ReportId kAxes{1};
constexpr ReportId kButtons{3};
constexpr ReportId kLight{4};
constexpr ReportId kZero{7};

constexpr DescriptorBuilder kBuilt =
    DescriptorBuilder()
        .application(usages::kMultiAxisController)
        .report_id(kAxes)
        .collection(CollectionKind::kPhysical, usages::kPointer)
        .usage(usages::kX)
        .usage(usages::kY)
        .usage(usages::kZ)
        .usage(usages::kRx)
        .usage(usages::kRy)
        .usage(usages::kRz)
        .logical({-KnobFunction::kMostCounts, KnobFunction::kMostCounts})
        .physical({-1400, 1400})
        .unit(Unit::kCentimeter, -4)
        .report_size(16, kKnobAxes)
        .input(InputFlags::kVariable)
        .end_collection()
        .report_id(kButtons)
        .usage_range(usages::button(1), 2)
        .logical({0, 1})
        .physical(kNoPhysical)
        .unit(Unit::kNone)
        .report_size(1, 2)
        .input(InputFlags::kVariable)
        .padding(14)
        .report_id(kLight)
        .usage(usages::kGenericIndicator)
        .report_size(1)
        .output(InputFlags::kVariable)
        .report_size(7)
        .output(InputFlags::kConstant)
        .report_id(kZero)
        .usage(usages::kVendor1)
        .logical({-128, 127})
        .report_size(8)
        .feature(InputFlags::kVariable)
        .end_collection();
static_assert(kBuilt.is_well_formed());
static_assert(kBuilt.report_bytes(kAxes) == SpaceMouse::kAxisBytes);
static_assert(SpaceMouse::kAxisBytes <= KnobFunction::kMostReportBytes);
constexpr auto kDescriptor = descriptor_bytes<kBuilt.size()>(kBuilt);

constexpr EndpointSpec kEndpoints[] = {{0x81, 32, 8}, {0x02, 32, 8}};
constexpr InterfaceSpec kInterfaces[] = {{kDescriptor, 0, 0, kEndpoints}};

constexpr DeviceSpec kSpec = [] {
  DeviceSpec spec;
  spec.vendor = 0x256F;
  spec.product = 0xC62E;
  spec.version = 0x0414;
  spec.manufacturer = "3Dconnexion";
  spec.product_name = "SpaceMouse Wireless";
  spec.interfaces = kInterfaces;
  return spec;
}();

}  // namespace

const DeviceSpec& SpaceMouse::spec() const noexcept { return kSpec; }

std::size_t SpaceMouse::axis_report(const Counts& counts, ReportBuffer report) noexcept {
  report[0] = kAxes.value();
  for (std::size_t axis = 0; axis < kKnobAxes; ++axis) put_le16(report, 1 + 2 * axis, counts[axis]);
  return kAxisBytes;
}

}  // namespace limn::firmware
