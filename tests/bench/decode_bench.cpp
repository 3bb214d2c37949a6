// Reports to pen samples: processor time and heap allocations a report.

#include <cstdio>
#include <cstdlib>

#include "drivers/devices/pen_decoder.hpp"
#include "tests/bench/areas.hpp"
#include "tests/bench/measure.hpp"
#include "tests/bench/simulated_reports.hpp"
#include "tests/support/alloc_guard.hpp"

namespace limn::bench {

namespace {

constexpr std::size_t kReports = 4000;
constexpr double kMostNanoseconds = 100;

void decode_stream(const ReportStream& stream, const RowSink& sink) {
  auto decoder = PenDecoder::make(stream.vendor, stream.product, stream.descriptor);
  std::vector<Report> reports;
  for (std::size_t i = 0; i < stream.reports.size(); ++i) reports.push_back(stream.report(i));
  std::size_t in_contact_count = 0;
  const auto decode_all = [&] {
    in_contact_count = 0;
    for (const Report& report : reports)
      for (const PenSample& sample : decoder->decode(report).samples)
        if (in_contact(sample.state)) ++in_contact_count;
    keep(in_contact_count);
  };
  if (decoder) decode_all();
  if (in_contact_count < kReports) {
    std::fprintf(stderr, "limn-bench: %s gave %zu samples in contact for %zu reports\n",
                 stream.name.c_str(), in_contact_count, kReports);
    std::exit(2);
  }
  const test::AllocGuard guard;
  decode_all();
  const auto allocations = static_cast<double>(guard.count());
  const auto count = static_cast<double>(reports.size());
  const double seconds = measure({{stream.name, decode_all}})[0];
  sink({"decode/" + stream.name + ", time", seconds / count * 1e9, "ns/report", std::nullopt,
        at_most(kMostNanoseconds)});
  sink({"decode/" + stream.name + ", heap", allocations / count, "allocs/report", std::nullopt,
        at_most(0)});
}

}  // namespace

void decode_area(const RowSink& sink) {
  decode_stream(generic_pen_stream(kReports), sink);
  decode_stream(wacom_intuos_stream(kReports), sink);
}

}  // namespace limn::bench
