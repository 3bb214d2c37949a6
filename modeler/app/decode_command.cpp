#include <cstdio>

#include "drivers/devices/trace_decoder.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/sample_text.hpp"
#include "modeler/app/standard_output.hpp"
#include "modeler/app/trace_input.hpp"

namespace limn::app {

Outcome run_decode(const DecodeArguments& arguments) {
  auto reader = open_trace_input(arguments.trace);
  if (!reader) return tl::unexpected(std::move(reader.error()));
  SampleText format(arguments.format, (*reader)->format() != TraceFormat::kStrokeCsv,
                    arguments.drag);
  TraceDecoder decoder(std::move(*reader), {.salvage = arguments.trace.salvage});

  StandardOutput out;
  format.begin(out.text());
  for (;;) {
    auto sample = decoder.next_any();
    if (!sample) {
      // What came before the damage stands; a document stays unended, as its reader should know.
      if (auto written = out.flush(); !written) return written;
      return in_file(arguments.trace.path, Expected<void>(tl::unexpected(sample.error())));
    }
    if (!format.append(*sample, out.text())) break;
    if (auto written = out.flush_if_large(); !written) return written;
  }
  format.end(out.text());
  if (auto written = out.flush(); !written) return written;
  std::fprintf(stderr, "%s\n", summarise(decoder.summary()).c_str());
  return {};
}

}  // namespace limn::app
