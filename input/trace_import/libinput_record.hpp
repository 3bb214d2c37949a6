#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "input/base/byte_stream.hpp"
#include "input/base/error.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// What a libinput recording holds, in file order.
struct LibinputRecord {
  enum class Kind : std::uint8_t {
    kFrame,   ///< events [begin, begin + count), without the SYN_REPORT
    kReport,  ///< bytes [begin, begin + count) of the hidraw node `source`
    kDamage,  ///< damage[begin]; count frames of the device went with it
  };
  struct Item {
    Kind kind = Kind::kFrame;
    std::uint32_t device = 0;  ///< of `devices`
    std::uint32_t source = 0;  ///< of `hidraw_names`; of damage: devices before it
    std::uint32_t line = 0;
    Timestamp time{};
    std::size_t begin = 0;
    std::size_t count = 0;
  };

  /// Places one after the other, of one device.
  struct Damage {
    Error first;
    std::uint64_t places = 0;
  };

  std::vector<TraceDevice> devices;  ///< as the file lists them; index is their position
  std::vector<std::string> hidraw_names;
  std::vector<Item> items;
  std::vector<EvdevEvent> events;
  std::vector<std::uint8_t> bytes;
  std::vector<Damage> damage;
  /// What ended the reading, with everything before it above. Not set: the file is whole.
  std::optional<Error> failure;
};

/// Reads a whole file. Where `salvage` is set, damage within the structure becomes items; else it
/// is the failure, as damage of the structure is always.
/// Error: kMissing where limn was built without yaml-cpp.
Expected<LibinputRecord> read_libinput_record(std::unique_ptr<ByteSource> bytes, bool salvage);

}  // namespace limn
