#pragma once

#include <cstddef>

namespace limn::test {

/// How often this thread has called a global operator new (any form) since it started. Allocations
/// by malloc alone, as in C libraries, are not seen.
std::size_t allocation_count() noexcept;

/// Counts the heap allocations of this thread from the guard's construction on.
///
///     AllocGuard guard;
///     decoder.push(report, sink);
///     EXPECT_EQ(guard.count(), 0U);
///
/// Needs the object library limn_alloc_guard in the test's LINK: it replaces the global operator
/// new and delete of the whole program by counting ones on malloc and free, which AddressSanitizer
/// still watches. Never link it into anything that is installed.
class AllocGuard {
 public:
  AllocGuard() noexcept : before_(allocation_count()) {}
  std::size_t count() const noexcept { return allocation_count() - before_; }

 private:
  std::size_t before_;
};

}  // namespace limn::test
