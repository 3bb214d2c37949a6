// Uses the installed libraries that need nothing but themselves: parses a report descriptor and
// evaluates a curve. Exits with 0 if the answers are right.

#include <array>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "drivers/hid/descriptor_parser.hpp"
#include "modeler/bspline/tensor_spline.hpp"

namespace {

// Usage Page (Digitizers), Usage (Pen), Collection (Application), Usage (Tip Switch), Logical
// 0 to 1, Report Size 1, Report Count 1, Input (Data, Variable, Absolute), End Collection.
constexpr std::array<std::uint8_t, 19> kDescriptor = {0x05, 0x0d, 0x09, 0x02, 0xa1, 0x01, 0x09,
                                                      0x42, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01,
                                                      0x95, 0x01, 0x81, 0x02, 0xc0};

bool parses_a_descriptor() {
  const auto descriptor = limn::hid::parse_descriptor(kDescriptor);
  if (!descriptor || descriptor->fields.size() != 1) return false;
  const auto usage = descriptor->element_usage(descriptor->fields[0], 0);
  return usage && usage->page == 0x0d && usage->id == 0x42;
}

// A parabola as a quadratic curve: half way it is at (1, 0.5).
bool evaluates_a_curve() {
  using Curve = limn::BsplineCurve<2>;
  const auto knots = limn::KnotVector::make_clamped(2, 0.0, 1.0);
  if (!knots) return false;
  const auto curve = Curve::make(*knots, {{0.0, 0.0}, {1.0, 1.0}, {2.0, 0.0}});
  return curve && curve->point(0.5) == Curve::Point(1.0, 0.5);
}

}  // namespace

int main() {
  const bool ok = parses_a_descriptor() && evaluates_a_curve();
  std::puts(ok ? "the installed limn works" : "the installed limn gives a wrong answer");
  return ok ? 0 : 1;
}
