// Any host at the cable of any simulated device: control requests, polls, output reports and resets
// from arbitrary bytes, with up to three faults before it.
//
//   u8       which device
//   u8       faults: their number, modulo 4; for each u8 which, u8 tenths of a second
//   then transfers: u8 kind (modulo 8; 0 to 2 a control request, 3 to 5 a poll, 6 a report to an
//   endpoint, 7 a reset), u8 milliseconds since the last, and
//     control  the eight bytes of the setup packet, then what is sent
//     poll     u8 endpoint, u8 room
//     report   u8 endpoint, u8 length, bytes

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "firmware_sim/devices/catalogue.hpp"
#include "firmware_sim/devices/drawings.hpp"
#include "firmware_sim/devices/faulty_device.hpp"
#include "firmware_sim/devices/motions.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using namespace limn;
using namespace limn::firmware;

void require_sound(const TransferResult& result, std::size_t room) {
  fuzz::require(result.bytes <= room, "no more than there is room for");
  fuzz::require(result.status == TransferStatus::kDone || result.bytes == 0,
                "nothing comes of what failed");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const auto infos = simulated_devices();
  const SimulatedInfo& info = infos[input.byte() % infos.size()];
  const std::string_view movement =
      info.kind == SimulatedKind::kPen ? drawings()[0].name : motions()[0].name;
  const auto device = make_simulated_device(info.name, movement, 1);
  std::vector<FaultSpec> wanted(input.byte() % 4);
  for (FaultSpec& fault : wanted) {
    fault = faults()[input.byte() % kFaultKinds].usual;
    fault.at = std::chrono::milliseconds(100) * input.byte();
  }
  FaultyDevice bus(device->bus(), wanted);

  std::chrono::microseconds now{};
  bus.reset();
  bus.control({0x00, 9, 1, 0, 0}, now, {});
  std::array<std::uint8_t, 1024> room{};
  while (!input.empty()) {
    const unsigned kind = input.byte() % 8;
    now += std::chrono::milliseconds(input.byte());
    if (bus.plugged(now) && kind < 3) {
      SetupPacket setup;
      setup.request_type = input.byte();
      setup.request = input.byte();
      setup.value = static_cast<std::uint16_t>(input.word());
      setup.index = static_cast<std::uint16_t>(input.word());
      setup.length = static_cast<std::uint16_t>(input.word() % room.size());
      const auto stage = std::span(room).first(setup.length);
      if ((setup.request_type & 0x80) == 0) {
        const auto bytes = input.take(setup.length);
        std::copy(bytes.begin(), bytes.end(), stage.begin());
      }
      require_sound(bus.control(setup, now, stage), stage.size());
    } else if (kind < 6) {
      const std::uint8_t endpoint = input.byte();
      const std::size_t most = input.byte();
      require_sound(bus.interrupt_in(endpoint, now, std::span(room).first(most)), most);
    } else if (kind == 6) {
      const std::uint8_t endpoint = input.byte();
      const auto bytes = input.take(input.byte());
      require_sound(bus.interrupt_out(endpoint, now, bytes), bytes.size());
    } else {
      bus.reset();
    }
  }
  return 0;
}
