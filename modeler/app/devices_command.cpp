#include <array>
#include <cstdio>
#include <utility>

#include "drivers/transport/diagnosis.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/device_selection.hpp"
#include "modeler/app/standard_output.hpp"
#include "modeler/app/table.hpp"
#include "modeler/app/terminal_text.hpp"

namespace limn::app {
namespace {

struct AxisName {
  PenAxis axis;
  std::string_view name;
  std::string_view short_name;  // for people: one for both tilts
};
constexpr auto kAxisNames = std::to_array<AxisName>({
    {PenAxis::kX, "x", "x"},
    {PenAxis::kY, "y", "y"},
    {PenAxis::kPressure, "pressure", "p"},
    {PenAxis::kTiltX, "tilt_x", "t"},
    {PenAxis::kTiltY, "tilt_y", ""},
    {PenAxis::kTwist, "twist", "tw"},
    {PenAxis::kDistance, "distance", "d"},
    {PenAxis::kSerial, "serial", "s"},
});

std::string axes_of(const DeviceTraits& traits, std::string_view AxisName::*spelling) {
  if (traits.kind == DeviceKind::k3dMouse) return "x y z rx ry rz";
  std::string text;
  for (const AxisName& axis : kAxisNames) {
    if (!traits.axes.has(axis.axis) || (axis.*spelling).empty()) continue;
    if (!text.empty()) text += ' ';
    text += axis.*spelling;
  }
  return text;
}

std::string id_of(const ListedDevice& listed) {
  if (listed.device.vendor == 0 && listed.device.product == 0) return {};
  std::array<char, 16> id{};
  std::snprintf(id.data(), id.size(), "%04x:%04x", listed.device.vendor, listed.device.product);
  return id.data();
}

std::string kind_of(const DeviceTraits& traits) {
  return traits.kind == DeviceKind::kOther ? "no pen" : std::string(traits.name);
}

Cell text_or_nothing(std::string text) { return text.empty() ? Cell() : Cell(std::move(text)); }

Cell positive(double value) { return value > 0 ? Cell(value) : Cell(); }

struct Row {
  ListedDevice listed;
  DeviceTraits traits;
  Finding finding;
};

/// Everything, for programs.
Table whole_table(const std::vector<Row>& rows) {
  Table table({{"id", "id"},
               {"node", "node"},
               {"name", "name"},
               {"kind", "kind"},
               {"width_mm", "mm", 1},
               {"height_mm", "mm", 1},
               {"pressure_max", "pressure"},
               {"axes", "axes"},
               {"rate", "rate", 0},
               {"backend", "backend"},
               {"driver", "driver"},
               {"serial", "serial"},
               {"same_as", "same as"},
               {"trouble", "trouble"},
               {"remedy", "remedy"}});
  for (const auto& [listed, traits, finding] : rows) {
    const bool good = finding.state == Finding::State::kGood;
    table.add({text_or_nothing(id_of(listed)), listed.node, listed.device.name, kind_of(traits),
               positive(traits.range.width_mm), positive(traits.range.height_mm),
               traits.range.pressure_max > 0 ? Cell(traits.range.pressure_max) : Cell(),
               text_or_nothing(axes_of(traits, &AxisName::name)),
               positive(listed.most_reports_per_second), std::string(name(listed.backend)),
               text_or_nothing(listed.driver), text_or_nothing(listed.serial),
               text_or_nothing(listed.same_as), good ? Cell() : Cell(finding.what),
               good ? Cell() : Cell(finding.remedy)});
  }
  return table;
}

/// At most 100 columns, and a line below for each row that needs one.
std::string for_people(const std::vector<Row>& rows) {
  Table table({{"id", "id"},
               {"node", "node"},
               {"name", "name"},
               {"kind", "kind"},
               {"size", "mm"},
               {"axes", "axes"},
               {"rate", "Hz", 0}});
  std::string notes;
  for (const auto& [listed, traits, finding] : rows) {
    constexpr std::size_t kMostName = 18;
    std::string name = shortened(printable(listed.device.name), kMostName);
    std::string kind = kind_of(traits);
    constexpr std::size_t kMostKind = 12;
    if (kind.size() > kMostKind) kind.resize(kMostKind);
    std::array<char, 24> size{};
    if (traits.range.width_mm > 0) {
      std::snprintf(size.data(), size.size(), "%.0f x %.0f", traits.range.width_mm,
                    traits.range.height_mm);
    }
    table.add({text_or_nothing(id_of(listed)), listed.node, std::move(name), std::move(kind),
               text_or_nothing(size.data()),
               text_or_nothing(axes_of(traits, &AxisName::short_name)),
               positive(listed.most_reports_per_second)});
    if (!listed.same_as.empty())
      notes += listed.node + ": the same device as " + listed.same_as + "\n";
    if (finding.state != Finding::State::kGood) {
      notes += printable(listed.node + ": " + finding.what + "; " + finding.remedy) + "\n";
    }
  }
  return table.print(OutputFormat::kText) + notes;
}

}  // namespace

Outcome run_devices(const DevicesArguments& arguments) {
  const auto listed = in_file("", list_devices());
  if (!listed) return tl::unexpected(listed.error());
  std::vector<Row> rows;
  for (const ListedDevice& one : *listed) {
    const DeviceTraits traits = traits_of(one);
    if (traits.kind == DeviceKind::kOther && !arguments.all) continue;
    rows.push_back({one, traits, look_at(one)});
  }
  if (arguments.format != OutputFormat::kText) {
    return print(whole_table(rows).print(arguments.format));
  }
  if (rows.empty()) {
    std::fputs(arguments.all ? "no input device is here\n"
                             : "no pen and no 3D mouse is here; --all lists every input device\n",
               stderr);
    return {};
  }
  return print(for_people(rows));
}

}  // namespace limn::app
