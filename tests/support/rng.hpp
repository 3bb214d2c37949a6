#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace limn::test {

/// Seeded random numbers for tests, with the same bits on every machine and library (the standard
/// leaves its distributions open). SplitMix64, so any seed is as good as any other. Also usable as
/// a uniform random bit generator, for example with std::shuffle.
class Rng {
 public:
  using result_type = std::uint64_t;

  explicit Rng(std::uint64_t seed) noexcept : state_(seed) {}

  static constexpr result_type min() noexcept { return 0; }
  static constexpr result_type max() noexcept { return std::numeric_limits<result_type>::max(); }
  result_type operator()() noexcept;

  /// In [low, high). Precondition: low <= high, both finite.
  double uniform(double low, double high) noexcept;

  /// In [low, high], both ends included. Precondition: low <= high.
  std::int64_t integer(std::int64_t low, std::int64_t high) noexcept;

  /// True with the given probability, 0..1.
  bool chance(double probability) noexcept;

  /// Standard normal: mean 0, standard deviation 1.
  double normal() noexcept;

  /// `count` independent uniform bytes.
  std::vector<std::uint8_t> bytes(std::size_t count);

 private:
  std::uint64_t state_;
};

}  // namespace limn::test
