#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// Words of spacenavd's protocol, in the machine's byte order, both ends being on one machine.
// Source: spacenavd's and libspnav's public description of it (FreeSpacenav, proto.h).
namespace limn::spnav {

/// Event: [type, six axes, period in ms] or [type, button]; request and answer: [tag | request,
/// six values, status or length].
using Message = std::array<std::int32_t, 8>;
inline constexpr std::size_t kMessageBytes = 8 * sizeof(std::int32_t);
inline constexpr std::size_t kStatus = 7;

inline constexpr std::int32_t kHighestVersion = 1;

enum EventType : std::int32_t { kMotion = 0, kPress = 1, kRelease = 2, kDevice = 3 };

/// What a client wants to be told.
enum EventMask : std::uint32_t { kMotions = 1, kButtons = 2, kDevices = 4 };

inline constexpr std::int32_t kTag = 0x7FAA0000;
inline constexpr std::int32_t kTagBits = 0x7FFF0000;

enum Request : std::int32_t {
  kSetName = 0x1000,
  kSetSensitivity,
  kGetSensitivity,
  kSetEventMask,
  kGetEventMask,
  kDeviceName = 0x2000,
  kDevicePath,
  kDeviceAxes,
  kDeviceButtons,
  kDeviceUsbId,
  kDeviceType,
  kSetSerialDevice = 0x3016,  ///< a string, like kSetName
  kChangeVersion = 0x5500,    ///< one word, the version in its low byte
};

/// A string comes in pieces, each with how many bytes are left, its own included.
inline constexpr std::size_t kStringPiece = 24;
inline constexpr std::int32_t kLaterPiece = 0x10000;

}  // namespace limn::spnav
