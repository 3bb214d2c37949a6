#include "input/sample/sample_hash.hpp"

#include <bit>
#include <type_traits>

namespace limn {
namespace {

class Fnv1a {
 public:
  explicit Fnv1a(std::uint64_t hash) : hash_(hash) {}
  std::uint64_t hash() const noexcept { return hash_; }

  template <class Number>
  void add(Number number) noexcept {
    if constexpr (std::is_floating_point_v<Number>) {
      add(std::bit_cast<std::uint64_t>(number));
    } else if constexpr (std::is_enum_v<Number> || std::is_same_v<Number, bool>) {
      add(static_cast<std::uint8_t>(number));
    } else {
      const auto bits = static_cast<std::uint64_t>(number);
      for (unsigned i = 0; i < sizeof number; ++i) {
        constexpr std::uint64_t kPrime = 0x100000001B3U;
        hash_ = (hash_ ^ (bits >> (8 * i) & 0xFFU)) * kPrime;
      }
    }
  }

 private:
  std::uint64_t hash_;
};

}  // namespace

std::uint64_t hash_sample(const PenSample& sample, std::uint64_t before) noexcept {
  Fnv1a fnv(before);
  fnv.add(static_cast<std::int64_t>(sample.time.count()));
  fnv.add(sample.device);
  fnv.add(sample.tool);
  fnv.add(sample.state);
  fnv.add(sample.buttons);
  fnv.add(sample.axes.bits());
  for (const double value : {sample.x_mm, sample.y_mm, sample.pressure, sample.tilt_x_rad,
                             sample.tilt_y_rad, sample.twist_rad, sample.distance}) {
    fnv.add(value);
  }
  fnv.add(sample.serial);
  fnv.add(sample.lost);
  fnv.add(sample.lost_estimated);
  fnv.add(sample.disturbances.bits());
  fnv.add(sample.raw.x);
  fnv.add(sample.raw.y);
  fnv.add(sample.raw.pressure);
  return fnv.hash();
}

std::uint64_t hash_sample(const MotionSample& sample, std::uint64_t before) noexcept {
  Fnv1a fnv(before);
  fnv.add(static_cast<std::int64_t>(sample.time.count()));
  fnv.add(sample.device);
  for (const double value : sample.deflection) fnv.add(value);
  for (const std::int32_t count : sample.raw) fnv.add(count);
  for (const bool flag :
       {sample.translation_told, sample.rotation_told, sample.rests_exactly, sample.changes_only,
        sample.silence, sample.battery_percent.has_value()}) {
    fnv.add(flag);
  }
  for (const std::uint64_t word : sample.buttons.words()) fnv.add(word);
  fnv.add(sample.battery_percent.value_or(0));
  fnv.add(sample.lost);
  fnv.add(sample.lost_estimated);
  fnv.add(sample.disturbances.bits());
  return fnv.hash();
}

}  // namespace limn
