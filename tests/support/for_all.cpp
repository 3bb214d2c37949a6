#include "tests/support/for_all.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace limn::test {

std::optional<std::uint64_t> requested_seed() {
  const char* text = std::getenv("LIMN_SEED");
  if (text == nullptr || *text == '\0') return std::nullopt;
  char* end = nullptr;
  errno = 0;
  const std::uint64_t seed = std::strtoull(text, &end, 0);
  if (*end != '\0' || errno != 0) ADD_FAILURE() << "LIMN_SEED is no 64-bit number: " << text;
  return seed;
}

std::uint64_t case_seed(int index) {
  std::string name = "outside a test";
  if (const auto* info = testing::UnitTest::GetInstance()->current_test_info())
    name = std::string(info->test_suite_name()) + "." + info->name();
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a, 64 bits
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return Rng(hash + static_cast<std::uint64_t>(index))();
}

std::string rerun_hint(std::uint64_t seed) {
  char text[48];
  std::snprintf(text, sizeof text, "rerun with LIMN_SEED=0x%llx",
                static_cast<unsigned long long>(seed));
  return text;
}

}  // namespace limn::test
