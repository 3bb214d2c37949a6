#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>

#include "tests/support/rng.hpp"

namespace limn::test {

/// The seed that LIMN_SEED asks for (decimal, or hexadecimal after 0x), none where it is not set.
/// A value that is no number fails the running test.
std::optional<std::uint64_t> requested_seed();

/// Seed of case `index` of the running test: a fixed function of the test's full name, so that
/// every run and every machine tries the same cases, and two tests try different ones.
std::uint64_t case_seed(int index);

/// "rerun with LIMN_SEED=0x..", the line that a failing case prints.
std::string rerun_hint(std::uint64_t seed);

/// Checks a law on random cases: calls `body(rng)` `count` times, each with a generator of its own,
/// and stops at the first case that fails. The failure says "rerun with LIMN_SEED=..", which runs
/// that one case alone. The body states the law with gtest's EXPECT_ or ASSERT_ macros.
template <class Body>
void for_all(int count, Body&& body) {
  const auto run = [&body](std::uint64_t seed) {
    const testing::ScopedTrace trace("for_all", 0, rerun_hint(seed));
    Rng rng(seed);
    body(rng);
  };
  if (const auto seed = requested_seed()) {
    run(*seed);
    return;
  }
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) run(case_seed(i));
}

}  // namespace limn::test
