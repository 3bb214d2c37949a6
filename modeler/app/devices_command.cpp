#include <cstdio>

#include "drivers/devices/pen_decoder.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/live_input.hpp"
#include "modeler/app/standard_output.hpp"
#include "modeler/app/table.hpp"

namespace limn::app {

Outcome run_devices(const DevicesArguments& arguments) {
  const auto listed = in_file("", list_hid_devices());
  if (!listed) return tl::unexpected(listed.error());
  Table table({{"id", "id"},
               {"node", "node"},
               {"name", "name"},
               {"kind", "kind"},
               {"width_mm", "mm", 1},
               {"height_mm", "mm", 1},
               {"pressure_max", "pressure"},
               {"backend", "backend"},
               {"trouble", "trouble"}});
  int pens = 0;
  for (const ListedDevice& one : *listed) {
    const std::string kind = pen_kind(one);
    if (kind.empty() && !arguments.all) continue;
    ++pens;
    char id[16];
    std::snprintf(id, sizeof id, "%04x:%04x", one.device.vendor, one.device.product);
    std::vector<Cell> row = {std::string(id), one.node, one.device.name,
                             kind.empty() ? std::string("no pen") : kind};
    const auto decoder =
        PenDecoder::make(one.device.vendor, one.device.product, one.device.report_descriptor);
    const PenRange range = decoder ? decoder->range() : PenRange{};
    const auto positive = [](double value) { return value > 0 ? Cell(value) : Cell(); };
    row.push_back(positive(range.width_mm));
    row.push_back(positive(range.height_mm));
    row.push_back(range.pressure_max > 0 ? Cell(range.pressure_max) : Cell());
    row.push_back(std::string("hidraw"));
    row.push_back(one.readable ? Cell()
                               : Cell(std::string("no permission: install the udev rules")));
    table.add(std::move(row));
  }
  if (pens == 0 && arguments.format == OutputFormat::kText) {
    std::fputs(arguments.all ? "no HID device is here\n"
                             : "no pen is here; --all lists every HID device\n",
               stderr);
    return {};
  }
  return print(table.print(arguments.format));
}

}  // namespace limn::app
