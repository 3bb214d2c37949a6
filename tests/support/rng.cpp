#include "tests/support/rng.hpp"

#include <cmath>
#include <numbers>

namespace limn::test {

Rng::result_type Rng::operator()() noexcept {
  state_ += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

double Rng::uniform(double low, double high) noexcept {
  const double unit = static_cast<double>((*this)() >> 11U) * 0x1p-53;
  return low + (high - low) * unit;
}

std::int64_t Rng::integer(std::int64_t low, std::int64_t high) noexcept {
  // Unsigned, so that the whole 64-bit range neither overflows nor divides by zero. The bias of
  // the remainder is below 2^-32 for ranges up to 2^32, nothing that a test can see.
  const std::uint64_t count =
      static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low) + 1;
  const std::uint64_t draw = (*this)();
  const std::uint64_t offset = count == 0 ? draw : draw % count;
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(low) + offset);
}

bool Rng::chance(double probability) noexcept { return uniform(0.0, 1.0) < probability; }

double Rng::normal() noexcept {
  const double u = 1.0 - uniform(0.0, 1.0);  // in (0, 1], so the logarithm is finite
  const double v = uniform(0.0, 1.0);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

std::vector<std::uint8_t> Rng::bytes(std::size_t count) {
  std::vector<std::uint8_t> out(count);
  for (auto& byte : out) byte = static_cast<std::uint8_t>((*this)() & 0xffU);
  return out;
}

}  // namespace limn::test
