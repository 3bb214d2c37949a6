#pragma once

#include <cstddef>
#include <functional>

#include "modeler/view/sheet.hpp"
#include "tests/bench/row.hpp"

namespace limn::bench {

/// Takes the rows of an area as they are measured.
using RowSink = std::function<void(const Row&)>;

struct Picture {
  Sheet sheet;
  Drawing drawing;
};

/// Each of these measures one area.
void decode_area(const RowSink& sink);

/// Decodes `count` reports of a generic pen and nothing else, for who counts instructions.
void decode_reports(std::size_t count);

void trace_area(const RowSink& sink);
void transport_area(const RowSink& sink);
void footprint_area(const RowSink& sink);
void fit_area(const RowSink& sink);
void kernel_area(const RowSink& sink);
/// Draws them, too.
Picture growth_area(const RowSink& sink);
void boot_area(const RowSink& sink);

}  // namespace limn::bench
