// A simulated device whose report descriptor and reports were tampered with on their way to limn:
// initialised, polled and decoded as a live one would be.
//
//   u8       which device
//   u8       changes of the descriptors, modulo 64; for each u16 place, u8 value
//   then polls: u8 milliseconds since the last; u8 changes of each report, modulo 8; for each u8
//   place, u8 value; u8 bytes that it keeps of 255 (255: all)

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/devices/pen_decoder.hpp"
#include "drivers/devices/pen_initialization.hpp"
#include "firmware_sim/devices/catalogue.hpp"
#include "firmware_sim/devices/drawings.hpp"
#include "firmware_sim/devices/motions.hpp"
#include "input/stroke/stroke_sampler.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/pen_laws.hpp"

namespace {

using namespace limn;
using Bytes = std::vector<std::uint8_t>;

Bytes ask(firmware::BusDevice& bus, const firmware::SetupPacket& setup) {
  Bytes data(setup.length);
  data.resize(bus.control(setup, {}, data).bytes);
  return data;
}

/// What limn does to a device before it reads it.
PenInitializer initialise(firmware::BusDevice& bus, const PenInitialization& sequence) {
  PenInitializer initializer(sequence);
  while (const PenInitStep* step = initializer.next()) {
    Bytes answer;
    switch (step->action) {
      case PenInitAction::kReadString: {
        const auto index = static_cast<std::uint16_t>(0x0300 | step->string_index);
        answer = ask(bus, {0x80, 6, index, kPenStringLanguage, kPenStringLength});
        break;
      }
      case PenInitAction::kWriteInterrupt:
        bus.interrupt_out(step->endpoint, {}, step->bytes);
        break;
      case PenInitAction::kSetFeature:
        break;  // none of the simulated devices has one
    }
    initializer.done(answer);
  }
  return initializer;
}

/// One interface as limn reads it.
struct Reader {
  std::uint8_t endpoint = 0;
  PenDecoder decoder;
  fuzz::PenLaws laws = {};
};

std::vector<Reader> open_all(firmware::BusDevice& bus, fuzz::Input& input) {
  struct Change {
    std::size_t at;
    std::uint8_t value;
  };
  std::vector<Change> changes(input.byte() % 64);
  for (Change& change : changes) {
    change.at = input.word();
    change.value = input.byte();
  }
  const firmware::DeviceSpec& spec = bus.spec();
  const PenInitialization* sequence = find_pen_initialization(spec.vendor, spec.product);
  std::optional<PenInitializer> learnt;
  if (sequence != nullptr) learnt = initialise(bus, *sequence);
  std::vector<Reader> readers;
  for (std::size_t i = 0; i < spec.interfaces.size(); ++i) {
    Bytes descriptor = ask(bus, {0x81, 6, 0x2200, static_cast<std::uint16_t>(i), 1024});
    for (const Change& change : changes) {
      if (!descriptor.empty()) descriptor[change.at % descriptor.size()] = change.value;
    }
    PenIdentity identity;
    identity.vendor = spec.vendor;
    identity.product = spec.product;
    identity.product_name = spec.product_name;
    const bool told = learnt && sequence->interface_number == i;
    if (told) identity.firmware = learnt->firmware();
    auto decoder = PenDecoder::make(identity, descriptor, told ? learnt->parameters() : nullptr);
    if (decoder) readers.push_back({spec.interfaces[i].endpoints[0].address, *std::move(decoder)});
  }
  return readers;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const auto infos = firmware::simulated_devices();
  const firmware::SimulatedInfo& info = infos[input.byte() % infos.size()];
  const bool pen = info.kind == firmware::SimulatedKind::kPen;
  const auto device = firmware::make_simulated_device(
      info.name, pen ? firmware::drawings()[0].name : firmware::motions()[0].name, 1);
  firmware::BusDevice& bus = device->bus();
  bus.reset();
  bus.control({0x00, 9, 1, 0, 0}, {}, {});
  std::array<std::uint8_t, 2> pen_mode = {2, 2};
  bus.control({0x21, 9, 0x0302, 0, 2}, {}, pen_mode);  // Wacom's; refused by all others
  std::vector<Reader> readers = open_all(bus, input);

  StrokeSampler strokes({.max_points = 64});
  const auto sink = [](Stroke& stroke) {
    fuzz::require(!stroke.points.empty() && stroke.points.size() <= 64, "strokes keep their limit");
  };
  std::chrono::microseconds now{};
  while (!input.empty()) {
    now += std::chrono::milliseconds(input.byte());
    const auto changes = input.take(std::size_t{2} * (input.byte() % 8));
    const std::uint8_t kept = input.byte();
    for (Reader& reader : readers) {
      std::array<std::uint8_t, 512> report{};
      auto result = bus.interrupt_in(reader.endpoint, now, report);
      if (result.status != firmware::TransferStatus::kDone || result.bytes == 0) continue;
      for (std::size_t i = 0; i + 1 < changes.size(); i += 2) {
        report[changes[i] % result.bytes] = changes[i + 1];
      }
      if (kept < 255) result.bytes = std::min<std::size_t>(result.bytes, kept);
      const auto bytes = std::span(report).first(result.bytes);
      const auto decoded = reader.decoder.decode(Report{reader.endpoint, now, bytes});
      reader.laws.check(decoded.samples);
      for (const PenSample& sample : decoded.samples) strokes.push(sample, sink);
    }
  }
  for (Reader& reader : readers) {
    reader.laws.check(reader.decoder.disconnect(reader.endpoint, now));
  }
  strokes.finish(sink);
  return 0;
}
