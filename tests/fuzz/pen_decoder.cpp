// Any device, any bytes: a decoder of each table row (or of none) with any report descriptor.
//
//   u8       0: no descriptor
//   u8       family, modulo their number + 1; the one past the end: a stranger to the tables
//   u8       which of the family's rows
//   u16, ..  length and bytes of the descriptor, where there is one
//   then reports: u8 length, u8 milliseconds since the last, bytes (numbers: low byte first)

#include "drivers/devices/pen_decoder.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "input/stroke/stroke_sampler.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/pen_laws.hpp"

namespace {

using namespace limn;

PenSpec row_of(PenFamily family, std::size_t choice) {
  const auto of_family = [family](const PenSpec& spec) { return spec.family == family; };
  const auto rows = pen_specs();
  auto number =
      choice % static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), of_family));
  auto row = std::find_if(rows.begin(), rows.end(), of_family);
  for (; number > 0; --number) row = std::find_if(row + 1, rows.end(), of_family);
  return *row;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const bool has_descriptor = input.byte() != 0;
  const unsigned family = input.byte() % (kPenFamilyCount + 1U);
  const bool stranger = family == kPenFamilyCount;
  const std::size_t choice = input.byte();
  const PenSpec spec = stranger ? PenSpec{} : row_of(static_cast<PenFamily>(family), choice);
  std::span<const std::uint8_t> descriptor;
  if (has_descriptor) {
    const std::size_t length = input.word();
    descriptor = input.take(length);
  }
  PenIdentity identity;
  identity.vendor = spec.vendor;
  identity.product = spec.product;
  identity.firmware = spec.firmware;
  identity.product_name = spec.product_name;
  identity.descriptor_bytes = spec.descriptor_bytes;
  auto decoder = PenDecoder::make(identity, descriptor);
  if (!decoder) {
    fuzz::require(stranger, "a device of the tables needs no descriptor");
    return 0;
  }

  fuzz::PenLaws laws;
  StrokeSampler strokes({.max_points = 64});
  const auto sink = [](Stroke& stroke) {
    fuzz::require(!stroke.points.empty() && stroke.points.size() <= 64, "strokes keep their limit");
  };
  Timestamp time{};
  while (!input.empty()) {
    const std::size_t length = input.byte();
    time += std::chrono::milliseconds(input.byte());
    const auto due = decoder->due();
    const auto decoded = decoder->decode(Report{1, time, input.take(length)});
    fuzz::require(decoded.kind == ReportClass::kPen || decoded.samples.empty() ||
                      (due.has_value() && *due <= time),
                  "samples come from pen reports and from silence");
    fuzz::require(!decoder->due() || *decoder->due() > time, "what was due was given");
    laws.check(decoded.samples);
    for (const PenSample& sample : decoded.samples) strokes.push(sample, sink);
  }
  if (const auto due = decoder->due()) {
    const auto left = decoder->advance(1, *due);
    fuzz::require(!left.empty() && left.back().state == PenState::kOutOfRange, "silence leaves");
    laws.check(left);
  }
  laws.check(decoder->disconnect(1, time));
  strokes.finish(sink);
  return 0;
}
