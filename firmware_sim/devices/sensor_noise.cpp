#include "firmware_sim/devices/sensor_noise.hpp"

#include <cmath>

#include "firmware_sim/devices/portable_math.hpp"

namespace limn::firmware {

std::uint64_t SensorNoise::next_bits() noexcept {
  state_ += 0x9E3779B97F4A7C15U;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

double SensorNoise::next_uniform() noexcept {
  constexpr double kStep = 1.0 / (std::uint64_t{1} << 52);
  return static_cast<double>(next_bits() >> 11) * kStep - 1;
}

double SensorNoise::next() noexcept {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double u = 0;
  double v = 0;
  double square = 0;
  do {
    u = next_uniform();
    v = next_uniform();
    square = u * u + v * v;
  } while (square >= 1 || square < 1e-30);
  const double factor = std::sqrt(-2 * portable_log(square) / square);
  spare_ = v * factor;
  has_spare_ = true;
  return u * factor;
}

}  // namespace limn::firmware
