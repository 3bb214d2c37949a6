#pragma once

#include <cstdint>

namespace limn::firmware {

/// Gaussian noise of a position sensor. The same seed gives the same numbers on every machine.
///
/// Bits by SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number
/// generators", OOPSLA 2014), normal deviates by the polar form of Box and Muller's method
/// (G. Marsaglia and T. A. Bray, SIAM Review 6, 1964).
class SensorNoise {
 public:
  explicit SensorNoise(std::uint64_t seed) noexcept : state_(seed) {}

  /// The next deviate: mean 0, standard deviation 1, independent of all others.
  double next() noexcept;

 private:
  std::uint64_t next_bits() noexcept;
  double next_uniform() noexcept;  // -1 to 1

  std::uint64_t state_;
  double spare_ = 0;
  bool has_spare_ = false;
};

/// A seed for each instant of a session, so that its noise does not depend on what was measured
/// before: the finaliser of SplitMix64 over both.
constexpr std::uint64_t noise_seed(std::uint64_t session, std::uint64_t instant) noexcept {
  std::uint64_t z = session ^ (instant + 1) * 0xD1342543DE82EF95U;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

}  // namespace limn::firmware
