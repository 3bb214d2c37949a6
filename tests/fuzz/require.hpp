#pragma once

#include <cstdio>
#include <cstdlib>

namespace limn::fuzz {

/// Ends the program at a broken law, as fuzzers want it.
inline void require(bool holds, const char* law) {
  if (holds) return;
  std::fprintf(stderr, "broken law: %s\n", law);
  std::abort();
}

}  // namespace limn::fuzz
