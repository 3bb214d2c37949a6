#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/devices/device_traits.hpp"
#include "tests/support/simulated_tablet.hpp"
#include "tests/unit/drivers/devices_support.hpp"
#include "tests/unit/drivers/hid_items.hpp"

namespace limn {
namespace {

TraceDevice device(std::uint16_t vendor, std::uint16_t product,
                   std::vector<std::uint8_t> descriptor = {}) {
  TraceDevice out;
  out.vendor = vendor;
  out.product = product;
  out.report_descriptor = std::move(descriptor);
  return out;
}

/// An application collection of a usage on Generic Desktop with one input bit.
std::vector<std::uint8_t> application(std::uint32_t usage) {
  hid::test::Items items;
  items.usage_page(hid::page::kGenericDesktop).usage(usage).collection(1).usage(0x30);
  items.logical(0, 1).report_size(1).report_count(1).input(0x02).end_collection();
  return {items.bytes().begin(), items.bytes().end()};
}

PenAxes axes(std::initializer_list<PenAxis> list) {
  PenAxes out;
  for (const PenAxis axis : list) out.add(axis);
  return out;
}

TEST(TraitsOf, AHidPenIsWhatItsDescriptorDeclares) {
  const DeviceTraits traits =
      traits_of(device(0x1209, 2, test::SimulatedTablet::report_descriptor()));
  EXPECT_EQ(traits.kind, DeviceKind::kPen);
  EXPECT_EQ(traits.name, "HID pen");
  EXPECT_EQ(traits.axes,
            axes({PenAxis::kX, PenAxis::kY, PenAxis::kPressure, PenAxis::kTiltX, PenAxis::kTiltY}));
  EXPECT_NEAR(traits.range.width_mm, 105.3, 1e-9);
}

TEST(TraitsOf, ATablesPenHasItsFamilysAxes) {
  const DeviceTraits intuos = traits_of(device(test::kWacom, 0x00B9));  // Intuos4 6x9
  EXPECT_EQ(intuos.kind, DeviceKind::kPen);
  EXPECT_EQ(intuos.name, "Intuos4");
  EXPECT_EQ(intuos.axes,
            axes({PenAxis::kX, PenAxis::kY, PenAxis::kPressure, PenAxis::kTiltX, PenAxis::kTiltY,
                  PenAxis::kTwist, PenAxis::kDistance, PenAxis::kSerial}));
  const DeviceTraits bamboo = traits_of(device(test::kWacom, 0x00D1));  // Bamboo Pen & Touch
  EXPECT_EQ(bamboo.axes, axes({PenAxis::kX, PenAxis::kY, PenAxis::kPressure, PenAxis::kDistance}));
}

TEST(TraitsOf, AKernelPenIsToldByItsAxes) {
  TraceDevice pen = device(0x1209, 2, test::SimulatedTablet::report_descriptor());
  pen.axes = {{0, 0, 20000, 0, 0, 190}, {1, 0, 10000, 0, 0, 190}, {0x18, 0, 1023, 0, 0, 0}};
  const DeviceTraits traits = traits_of(pen);
  EXPECT_EQ(traits.kind, DeviceKind::kPen);
  EXPECT_EQ(traits.name, "kernel pen");
  EXPECT_EQ(traits.axes, axes({PenAxis::kX, PenAxis::kY, PenAxis::kPressure}));
  EXPECT_NEAR(traits.range.width_mm, 105.3, 1e-9);
  for (EvdevAxis& axis : pen.axes) axis = {axis.code};  // it may not be asked
  EXPECT_EQ(traits_of(pen).kind, DeviceKind::kPen);
  EXPECT_EQ(traits_of(pen).axes, traits.axes);
  EXPECT_EQ(traits_of(pen).range.width_mm, 0);
  pen.axes.pop_back();
  EXPECT_EQ(traits_of(pen).kind, DeviceKind::kOther) << "the pad of the same tablet";
}

TEST(TraitsOf, A3dMouseIsAMultiAxisController) {
  EXPECT_EQ(traits_of(device(0x1209, 7, application(0x08))).kind, DeviceKind::k3dMouse);
  EXPECT_EQ(traits_of(device(0x256F, 0xC635, application(0x08))).name, "3D mouse");
  EXPECT_EQ(traits_of(device(0x256F, 0xC635, application(0x06))).kind, DeviceKind::kOther)
      << "the keyboard that some have beside it";
  EXPECT_EQ(traits_of(device(0x256F, 0xC635)).kind, DeviceKind::k3dMouse) << "by its ids";
  EXPECT_EQ(traits_of(device(0x046D, 0xC626)).kind, DeviceKind::k3dMouse);
  EXPECT_EQ(traits_of(device(0x256F, 0xC650)).kind, DeviceKind::kOther) << "CadMouse";
  EXPECT_EQ(traits_of(device(0x046D, 0xC077)).kind, DeviceKind::kOther) << "a plain mouse";
}

TEST(TraitsOf, AKernelDecoded3dMouseHasSixAxes) {
  TraceDevice mouse = device(0x046D, 0xC626);
  for (std::uint16_t code = 0; code < 6; ++code) mouse.axes.push_back({code, -350, 350});
  EXPECT_EQ(traits_of(mouse).kind, DeviceKind::k3dMouse);
  mouse.axes.pop_back();
  EXPECT_EQ(traits_of(mouse).kind, DeviceKind::kOther);
}

/// A 3D mouse whose input field of X has these flags.
std::vector<std::uint8_t> mouse_of_500(std::uint32_t flags) {
  hid::test::Items items;
  items.usage_page(hid::page::kGenericDesktop).usage(0x08).collection(1);
  items.logical(0, 1).usage(0x48).report_size(8).report_count(1).input(0x06);  // relative, no X
  items.usage(0x30).logical(-500, 500).report_size(16).report_count(1).input(flags);
  items.end_collection();
  return {items.bytes().begin(), items.bytes().end()};
}

TEST(RelativeFullCounts, AreOfMiceThatCallTheirAxesRelative) {
  EXPECT_EQ(relative_full_counts(device(0x046D, 0xC626, mouse_of_500(0x06))), 500);
  EXPECT_EQ(relative_full_counts(device(0x046D, 0xC626, mouse_of_500(0x02))), std::nullopt);
  EXPECT_EQ(relative_full_counts(device(0x046D, 0xC626)), std::nullopt) << "nothing says";
  EXPECT_EQ(relative_full_counts(device(0x046D, 0xC626, {0xFE})), std::nullopt);
  EXPECT_EQ(relative_full_counts(device(0x1209, 2, test::SimulatedTablet::report_descriptor())),
            std::nullopt);
  TraceDevice node = device(0x046D, 0xC626, mouse_of_500(0x06));
  node.relative_axes = {0, 1, 2, 3, 4, 5};
  EXPECT_EQ(relative_full_counts(node), 350) << "as EvdevMotionDecoder has it";
  node.relative_axes = {};
  for (std::uint16_t code = 0; code < 6; ++code) node.axes.push_back({code, -350, 350});
  EXPECT_EQ(relative_full_counts(node), std::nullopt);
}

}  // namespace
}  // namespace limn
