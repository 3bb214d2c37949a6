// Any answers to any initialisation: the sequence ends, and its parameters make a sound decoder.
//
//   u8    which sequence, modulo their number
//   then answers: u8 length, bytes; then, behind the last step, reports: u8 length, bytes

#include "drivers/devices/pen_initialization.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/devices/pen_decoder.hpp"
#include "tests/fuzz/pen_laws.hpp"

namespace {

using namespace limn;
using Bytes = std::span<const std::uint8_t>;

Bytes take(Bytes& rest) {
  if (rest.empty()) return {};
  const std::size_t length = std::min<std::size_t>(rest[0], rest.size() - 1);
  const Bytes taken = rest.subspan(1, length);
  rest = rest.subspan(1 + length);
  return taken;
}

void check(const PenParameters& parameters) {
  const double width = parameters.x_max / parameters.counts_per_mm;
  const double height = parameters.y_max / parameters.counts_per_mm;
  fuzz::require(width > 0 && width <= 2000 && height > 0 && height <= 2000, "a tablet's size");
  fuzz::require(parameters.pressure_max > 0, "some pressure");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  Bytes rest(data + 1, size - 1);
  const auto sequences = pen_initializations();
  const PenInitialization& sequence = sequences[data[0] % sequences.size()];
  PenInitializer initializer(sequence);
  std::size_t steps = 0;
  while (initializer.next() != nullptr) {
    fuzz::require(++steps <= sequence.steps.size(), "each step once at most");
    initializer.done(take(rest));
  }
  fuzz::require(initializer.firmware().size() <= 127, "a string descriptor's text");
  PenIdentity identity;
  identity.vendor = sequence.vendor;
  identity.product = sequence.product;
  identity.firmware = initializer.firmware();
  auto decoder = PenDecoder::make(identity, {}, initializer.parameters());
  if (initializer.parameters() != nullptr) {
    check(*initializer.parameters());
    fuzz::require(decoder.has_value(), "parameters make a pen");
  }
  if (!decoder) return 0;
  fuzz::PenLaws laws;
  while (!rest.empty()) laws.check(decoder->decode(Report{1, Timestamp{}, take(rest)}).samples);
  laws.check(decoder->disconnect(1, Timestamp{}));
  return 0;
}
