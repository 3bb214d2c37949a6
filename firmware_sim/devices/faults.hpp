#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace limn::firmware {

/// What can go wrong with a device, its cable or its host.
enum class FaultKind : std::uint8_t {
  kDrop,
  kDuplicate,
  kReorder,
  kShort,
  kOverlong,
  kWrongId,
  kGarbage,
  kStall,
  kTimeout,
  kUnplug,
  kModeChange,
  kStuckTip,
  kOrphanExit,
  kTimeJump,
  kBatch,
  kFlood,
  kHostileDescriptor,
};
inline constexpr std::size_t kFaultKinds = 17;

/// A fault as it is asked for: from `at` on, with `probability`, `count` times at most.
struct FaultSpec {
  FaultKind kind = FaultKind::kDrop;
  std::chrono::microseconds at{};  ///< since the simulation began
  double probability = 1;          ///< above 0, at most 1: of each report, or of each second
  std::uint32_t count = 0;         ///< 0: any number of times
  std::uint64_t seed = 1;
};

struct FaultInfo {
  std::string_view name;
  std::string_view description;  ///< one line
  FaultSpec usual;               ///< where nothing else is asked for
};

/// All faults, in the order of FaultKind, which is that in which they should be listed.
std::span<const FaultInfo, kFaultKinds> faults() noexcept;

/// What became of a text that asks for a fault.
struct ParsedFault {
  std::optional<FaultSpec> fault;  ///< absent: an error
  std::string error;               ///< one line: what is wrong and what would be right
  bool unknown_name = false;       ///< the error is that there is no fault of that name
};

/// Reads `NAME[,at=SECONDS][,p=PROBABILITY][,n=COUNT][,seed=N]`; what is left out is as usual for
/// that fault. SECONDS from 0 to a day; p above 0 and at most 1; COUNT and N whole numbers.
ParsedFault parse_fault(std::string_view text);

}  // namespace limn::firmware
