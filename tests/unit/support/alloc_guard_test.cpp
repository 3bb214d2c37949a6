#include "tests/support/alloc_guard.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

namespace limn::test {
namespace {

struct alignas(64) CacheLine {
  std::array<char, 64> bytes;
};

// Direct calls of operator new: a compiler may drop a new-expression but not these.
TEST(AllocGuard, CountsEveryFormOfNew) {
  const AllocGuard guard;
  ::operator delete(::operator new(8));
  ::operator delete[](::operator new[](8));
  ::operator delete(::operator new(8, std::nothrow), std::nothrow);
  ::operator delete(::operator new(0));
  const auto aligned = static_cast<std::align_val_t>(64);
  ::operator delete(::operator new(100, aligned), aligned);
  EXPECT_EQ(guard.count(), 5U);
}

TEST(AllocGuard, SeesTheStandardLibrary) {
  const AllocGuard guard;
  std::vector<int> numbers;
  numbers.reserve(1000);
  std::string text(200, 'x');
  // Written to where the compiler must suppose a reader: clang drops what nobody looks at.
  const void* volatile seen = numbers.data();
  seen = text.data();
  EXPECT_NE(seen, nullptr);
  EXPECT_EQ(guard.count(), 2U);
}

TEST(AllocGuard, CountsNothingWhereNothingIsAllocated) {
  std::vector<int> numbers;
  numbers.reserve(100);
  const AllocGuard guard;
  for (int i = 0; i < 100; ++i) numbers.push_back(i);
  std::string inside_the_object = "short";
  EXPECT_EQ(guard.count(), 0U);
}

TEST(AllocGuard, KeepsTheAlignmentAskedFor) {
  const auto lines = std::make_unique<CacheLine[]>(3);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(lines.get()) % 64, 0U);
}

TEST(AllocGuard, CountsThisThreadAlone) {
  std::size_t in_the_thread = 0;
  std::thread thread([&in_the_thread] {
    const AllocGuard guard;
    ::operator delete(::operator new(8));
    in_the_thread = guard.count();
  });
  const AllocGuard guard;
  thread.join();
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_EQ(in_the_thread, 1U);
}

}  // namespace
}  // namespace limn::test
