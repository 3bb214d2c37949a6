// Reports to pen samples: processor time and heap allocations a report.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

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

/// Instructions of `limn-bench --decode-reports COUNT`, by callgrind; nothing where valgrind is not
/// installed.
std::optional<double> instructions_of_decoding(std::size_t count) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command = "valgrind --tool=callgrind --callgrind-out-file=/dev/null '" + self +
                              "' --decode-reports " + std::to_string(count) + " 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::optional<double> instructions;
  std::array<char, 512> line;
  while (pipe && std::fgets(line.data(), line.size(), pipe.get()) != nullptr) {
    // "==123== Collected : 4567"
    const std::string_view text(line.data());
    constexpr std::string_view kCollected = "Collected : ";
    const auto at = text.find(kCollected);
    if (at != std::string_view::npos) {
      instructions = std::atof(line.data() + at + kCollected.size());
    }
  }
  return instructions;
}

/// Counted, not timed: the same on every run. Of two runs the difference, which leaves out what the
/// program does otherwise.
void count_instructions(const RowSink& sink) {
  constexpr double kMostInstructions = 1500;
  const auto few = instructions_of_decoding(kReports);
  const auto many = instructions_of_decoding(2 * kReports);
  if (!few || !many) {
    std::fprintf(stderr, "limn-bench: no instructions counted (apt install valgrind)\n");
    return;
  }
  sink({"decode/generic HID pen, instructions", (*many - *few) / kReports, "instr/report",
        std::nullopt, at_most(kMostInstructions)});
}

}  // namespace

void decode_reports(std::size_t count) {
  const ReportStream stream = generic_pen_stream(kReports);
  auto decoder = PenDecoder::make(stream.vendor, stream.product, stream.descriptor);
  double sum = 0;
  for (std::size_t i = 0; decoder && i < count; ++i) {
    for (const PenSample& sample : decoder->decode(stream.report(i % kReports)).samples) {
      sum += sample.x_mm;
    }
  }
  keep(sum);
}

void decode_area(const RowSink& sink) {
  decode_stream(generic_pen_stream(kReports), sink);
  count_instructions(sink);
  decode_stream(wacom_intuos_stream(kReports), sink);
}

}  // namespace limn::bench
