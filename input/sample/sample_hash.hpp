#pragma once

#include <cstdint>

#include "input/sample/motion_sample.hpp"
#include "input/sample/pen_sample.hpp"

namespace limn {

/// Of no samples.
inline constexpr std::uint64_t kEmptySampleHash = 0xCBF29CE484222325U;

/// The hash of a stream of samples, `sample` behind those of `before`: 64-bit FNV-1a of every
/// field, numbers low byte first, doubles by their bits. The same on every machine, and equal only
/// where every bit is (0.0 and -0.0 differ).
/// Source: Fowler, Noll, Vo, draft-eastlake-fnv.
std::uint64_t hash_sample(const PenSample& sample, std::uint64_t before) noexcept;
std::uint64_t hash_sample(const MotionSample& sample, std::uint64_t before) noexcept;

}  // namespace limn
