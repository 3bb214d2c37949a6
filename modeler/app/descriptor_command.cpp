#include <array>
#include <cstdio>
#include <optional>
#include <vector>

#include "drivers/hid/describe.hpp"
#include "input/trace/descriptor_file.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/standard_output.hpp"
#include "modeler/app/table.hpp"

namespace limn::app {
namespace {

std::string hex4(std::uint16_t value) {
  std::array<char, 8> text;
  std::snprintf(text.data(), text.size(), "%04x", value);
  return text.data();
}

Cell number(const std::optional<double>& value) { return value ? Cell(*value) : Cell(); }

Cell words(std::string text) { return text.empty() ? Cell() : Cell(std::move(text)); }

Table field_table() {
  return Table(
      {{"device", ""},       {"id", ""},           {"report", ""},        {"report_id", ""},
       {"bit_offset", ""},   {"bit_size", ""},     {"count", ""},         {"collections", ""},
       {"usage", ""},        {"flags", ""},        {"logical_min", ""},   {"logical_max", ""},
       {"physical_min", ""}, {"physical_max", ""}, {"unit", ""},          {"unit_exponent", ""},
       {"minimum", ""},      {"maximum", ""},      {"quantity_unit", ""}, {"counts_per_mm", ""}});
}

void add_fields(const TraceDevice& device, const hid::Description& description, Table& table) {
  const auto integer = [](auto value) { return static_cast<std::int64_t>(value); };
  const bool has_ids = device.vendor != 0 || device.product != 0;
  for (const hid::FieldRow& row : description.rows) {
    table.add({integer(device.index),
               has_ids ? Cell(hex4(device.vendor) + ':' + hex4(device.product)) : Cell(),
               std::string(name(row.kind)),
               integer(row.report_id),
               integer(row.bit_offset),
               integer(row.bit_size),
               integer(row.count),
               words(row.collections),
               words(row.usage),
               words(row.flags),
               integer(row.logical.minimum),
               integer(row.logical.maximum),
               integer(row.physical.minimum),
               integer(row.physical.maximum),
               words(row.unit),
               integer(row.unit_exponent),
               number(row.minimum),
               number(row.maximum),
               words(std::string(unit_of(row.quantity))),
               number(row.counts_per_mm)});
  }
}

std::string heading(const TraceDevice& device) {
  std::string text = "device " + std::to_string(device.index);
  if (!device.name.empty()) text += ": " + device.name;
  if (device.vendor != 0 || device.product != 0) {
    text += " (" + hex4(device.vendor) + ':' + hex4(device.product) + ')';
  }
  return text + '\n';
}

}  // namespace

Outcome run_descriptor(const DescriptorArguments& arguments) {
  auto devices = in_file(arguments.path, open_bytes(arguments.path).and_then([](auto bytes) {
    return read_descriptors(std::move(bytes));
  }));
  if (!devices) return tl::unexpected(std::move(devices.error()));

  std::string text;
  Table table = field_table();
  for (const TraceDevice& device : *devices) {
    auto descriptor = hid::parse_descriptor(device.report_descriptor);
    if (!descriptor) {
      if (devices->size() > 1) {
        descriptor.error().at =
            "descriptor of device " + std::to_string(device.index) + ", " + descriptor.error().at;
      }
      return in_file(arguments.path, Expected<void>(tl::unexpected(descriptor.error())));
    }
    const hid::Description description = describe(*descriptor);
    if (arguments.format == OutputFormat::kText) {
      if (!text.empty()) text += '\n';
      if (devices->size() > 1 || !device.name.empty()) text += heading(device);
      text += to_text(description);
    } else {
      add_fields(device, description, table);
    }
  }
  return print(arguments.format == OutputFormat::kText ? text : table.print(arguments.format));
}

}  // namespace limn::app
