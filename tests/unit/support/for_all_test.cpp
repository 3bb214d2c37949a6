#include "tests/support/for_all.hpp"

#include <gtest/gtest-spi.h>
#include <stdlib.h>  // setenv is POSIX

#include <set>
#include <string>
#include <vector>

namespace limn::test {
namespace {

/// Sets an environment variable for the life of the object.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const std::string& value) : name_(name) {
    setenv(name, value.c_str(), 1);
  }
  ~ScopedVariable() { unsetenv(name_); }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;

 private:
  const char* name_;
};

/// What follows "LIMN_SEED=" in a failure message.
std::string seed_in(const std::string& message) {
  const std::string key = "rerun with LIMN_SEED=";
  const auto at = message.find(key);
  if (at == std::string::npos) return {};
  const auto end = message.find_first_not_of("0123456789abcdefx", at + key.size());
  return message.substr(at + key.size(), end - at - key.size());
}

// A law that fails for about one case in four; the failures it makes are caught, not reported.
std::vector<std::string> failures_of_a_false_law(std::vector<std::uint64_t>* drawn) {
  testing::TestPartResultArray results;
  {
    const testing::ScopedFakeTestPartResultReporter reporter(
        testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
    for_all(40, [drawn](Rng& rng) {
      const std::uint64_t value = rng();
      drawn->push_back(value);
      EXPECT_NE(value % 4, 0U) << "value=" << value << ".";
    });
  }
  std::vector<std::string> messages;
  for (int i = 0; i < results.size(); ++i)
    messages.push_back(results.GetTestPartResult(i).message());
  return messages;
}

/// Every test here decides itself whether one case is asked for.
class ForAllTest : public testing::Test {
 protected:
  ForAllTest() { unsetenv("LIMN_SEED"); }
};

TEST_F(ForAllTest, RunsTheAskedNumberOfDifferentCases) {
  std::set<std::uint64_t> seen;
  for_all(100, [&seen](Rng& rng) { seen.insert(rng()); });
  EXPECT_EQ(seen.size(), 100U);
}

TEST_F(ForAllTest, RunsTheSameCasesEveryTime) {
  std::vector<std::uint64_t> first;
  std::vector<std::uint64_t> second;
  for_all(10, [&first](Rng& rng) { first.push_back(rng()); });
  for_all(10, [&second](Rng& rng) { second.push_back(rng()); });
  EXPECT_EQ(first, second);
}

TEST_F(ForAllTest, AFailureNamesASeedThatRunsItsCaseAlone) {
  std::vector<std::uint64_t> drawn;
  const auto messages = failures_of_a_false_law(&drawn);
  ASSERT_FALSE(messages.empty());
  const std::string seed = seed_in(messages.back());
  ASSERT_FALSE(seed.empty()) << messages.back();

  const ScopedVariable variable("LIMN_SEED", seed);
  drawn.clear();
  const auto again = failures_of_a_false_law(&drawn);
  ASSERT_EQ(drawn.size(), 1U);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again.front(), messages.back());
}

TEST_F(ForAllTest, RefusesASeedThatIsNoNumber) {
  const ScopedVariable variable("LIMN_SEED", "12monkeys");
  EXPECT_NONFATAL_FAILURE(requested_seed(), "LIMN_SEED is no 64-bit number: 12monkeys");
}

}  // namespace
}  // namespace limn::test
