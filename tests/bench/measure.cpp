#include "tests/bench/measure.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <mutex>

namespace limn::bench {

namespace {

/// Keeps the processor time of every repetition, and prints nothing.
class Capture : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration)
        seconds_[run.run_name.function_name].push_back(run.cpu_accumulated_time /
                                                       static_cast<double>(run.iterations));
  }

  double least(const std::string& name) const {
    const auto found = seconds_.find(name);
    if (found == seconds_.end() || found->second.empty()) return 0;
    return *std::min_element(found->second.begin(), found->second.end());
  }

 private:
  std::map<std::string, std::vector<double>> seconds_;
};

void initialize() {
  static std::once_flag once;
  std::call_once(once, [] {
    std::string program = "limn-bench";
    std::string interleaving = "--benchmark_enable_random_interleaving=true";
    char* arguments[] = {program.data(), interleaving.data(), nullptr};
    int count = 2;
    benchmark::Initialize(&count, arguments);
  });
}

}  // namespace

std::vector<double> measure(const std::vector<Job>& jobs) {
  initialize();
  benchmark::ClearRegisteredBenchmarks();
  for (const Job& job : jobs) {
    benchmark::RegisterBenchmark(job.name.c_str(),
                                 [&job](benchmark::State& state) {
                                   for (auto _ : state) job.run();
                                 })
        ->MinTime(job.effort.seconds)
        ->Repetitions(job.effort.repetitions);
  }
  Capture capture;
  benchmark::RunSpecifiedBenchmarks(&capture, ".");
  std::vector<double> seconds;
  for (const Job& job : jobs) seconds.push_back(capture.least(job.name));
  benchmark::ClearRegisteredBenchmarks();
  return seconds;
}

}  // namespace limn::bench
