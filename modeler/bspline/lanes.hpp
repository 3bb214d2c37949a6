#pragma once

#include <cstring>

namespace limn::bspline_detail {

/// Four doubles that the compiler adds and multiplies at once, in the widest registers that the
/// function around it may use; the bits are the same in all of them.
using Lanes [[gnu::vector_size(32)]] = double;

/// Kernels are inlined into a function a processor class (LIMN_ON_EACH_PROCESSOR).
#define LIMN_KERNEL [[gnu::always_inline]] inline

LIMN_KERNEL void load(const double* from, Lanes& to) noexcept { std::memcpy(&to, from, sizeof to); }
LIMN_KERNEL void store(const Lanes& from, double* to) noexcept {
  std::memcpy(to, &from, sizeof from);
}

/// Defines `void name parameters` twice, for any processor and for those with AVX2, and a function
/// that calls the better one. `call` is a LIMN_KERNEL, which is compiled in both.
#if defined(__x86_64__)
#define LIMN_ON_EACH_PROCESSOR(name, parameters, arguments, call)        \
  [[gnu::target("avx2")]] void name##_avx2 parameters noexcept { call; } \
  void name##_any parameters noexcept { call; }                          \
  void name parameters noexcept {                                        \
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;    \
    has_avx2 ? name##_avx2 arguments : name##_any arguments;             \
  }
#else
#define LIMN_ON_EACH_PROCESSOR(name, parameters, arguments, call) \
  void name parameters noexcept { call; }
#endif

}  // namespace limn::bspline_detail
