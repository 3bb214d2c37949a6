#pragma once

#include <functional>
#include <string>
#include <vector>

namespace limn::bench {

/// How long a measurement may take: each repetition runs for `seconds` (and once at least). The
/// fastest repetition counts: what disturbs one only ever adds to it.
struct Effort {
  double seconds = 0.05;
  int repetitions = 10;
};

struct Job {
  std::string name;
  std::function<void()> run;
  Effort effort = {};
};

/// Processor time of one run of each job, in seconds. The repetitions of the jobs alternate, so
/// that other work on the machine troubles all alike.
std::vector<double> measure(const std::vector<Job>& jobs);

/// Hands `value` to nobody: the compiler may not leave out the work that made it.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "r,m"(value) : "memory");
}

}  // namespace limn::bench
