#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "drivers/devices/trace_decoder.hpp"
#include "input/trace/trace.hpp"
#include "modeler/app/command.hpp"

namespace limn::app {

/// Opens the recording that the arguments name, with the descriptor and ids they supply. Shows the
/// progress of long reads on standard error where that is a terminal.
tl::expected<std::unique_ptr<TraceReader>, Failure> open_trace_input(
    const TraceArguments& arguments);

/// The same for the recordings of any program that limn knows (open_import()), which are then
/// written to a file.
tl::expected<std::unique_ptr<TraceReader>, Failure> open_import_input(
    const TraceArguments& arguments);

/// What a decoded recording held, for people: "2100 samples, 5 lost, 1 gap, 2 repaired state
/// transitions". What there was none of is left out.
std::string summarise(const TraceSummary& summary);

/// ", at least 5 lost, 1 gap", to be appended; empty where nothing disturbed the stream.
std::string losses_text(const StreamLosses& losses);

/// "1 sample", "2 samples".
std::string count_of(std::uint64_t count, std::string_view what);

}  // namespace limn::app
