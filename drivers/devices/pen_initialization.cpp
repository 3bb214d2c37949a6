#include "drivers/devices/pen_initialization.hpp"

#include <algorithm>
#include <utility>

#include "drivers/devices/pen_bytes.hpp"

namespace limn {
namespace {

using namespace pen_bytes;

using A = PenInitAction;
using W = PenInitWhen;
using F = PenFamily;

constexpr std::uint8_t kParametersV1 = 100;
constexpr std::uint8_t kFrameButtons = 123;
constexpr std::uint8_t kParametersV2 = 200;
constexpr std::uint8_t kFirmware = 201;

// Asked for v2 parameters, this firmware gives them but goes on with v1 reports.
constexpr std::string_view kTransitionalFirmware = "HUION_T153_160607";
constexpr std::string_view kFrameButtonsOn = "HK On";

constexpr std::uint16_t kHuionVendor = 0x256C;

// Reading the parameters is what switches a tablet to its full mode.
constexpr PenInitStep kHuion[] = {
    {.action = A::kReadString, .string_index = kFirmware},
    {.action = A::kReadString,
     .when = W::kUnlessTransitional,
     .string_index = kParametersV2,
     .gives = F::kUcLogicV2},
    {.action = A::kReadString,
     .when = W::kUnlessParametersKnown,
     .string_index = kParametersV1,
     .gives = F::kUcLogicV1},
    {.action = A::kReadString, .when = W::kWithParametersFromHere, .string_index = kFrameButtons},
};

// Older UC-Logic, and XP-Pen's of that kind. String 200 is left alone: read from a Deco 01 V2 it
// made another device of it (product 1227) until it was replugged.
constexpr PenInitStep kUcLogicV1[] = {
    {.action = A::kReadString, .string_index = kParametersV1, .gives = F::kUcLogicV1},
    {.action = A::kReadString, .when = W::kWithParametersFromHere, .string_index = kFrameButtons},
};
constexpr PenInitStep kXpPenV1[] = {
    {.action = A::kReadString, .string_index = kParametersV1, .gives = F::kUcLogicV1},
};

// XP-Pen's first tablets understand this too, and tell nothing of themselves.
constexpr std::uint8_t kXpPenMagic[] = {0x02, 0xB0, 0x02, 0, 0, 0, 0, 0};
constexpr PenInitStep kXpPen[] = {
    {.action = A::kWriteInterrupt, .endpoint = 3, .bytes = kXpPenMagic},
};

constexpr std::uint8_t kUgeeMagic[] = {0x02, 0xB0, 0x04, 0, 0, 0, 0, 0, 0, 0};
constexpr PenInitStep kUgee[] = {
    {.action = A::kWriteInterrupt, .endpoint = 3, .bytes = kUgeeMagic},
    {.action = A::kReadString, .string_index = kParametersV1, .gives = F::kUgee},
};

constexpr std::uint8_t kVeikkMagic[] = {0x09, 0x01, 0x04, 0, 0, 0, 0, 0, 0};
constexpr PenInitStep kVeikk[] = {
    {.action = A::kWriteInterrupt, .endpoint = 3, .bytes = kVeikkMagic},
};

constexpr std::uint8_t kKyeMagic[] = {0x05, 0x12, 0x10, 0x11, 0x12, 0, 0, 0};
constexpr PenInitStep kKye[] = {
    {.action = A::kSetFeature, .bytes = kKyeMagic},
};

constexpr std::string_view kHidUclogic = "hid-uclogic";

// clang-format off
constexpr PenInitialization kSequences[] = {
    // vendor, product, family, interface, steps, evidence
    {kHuionVendor, 0,    F::kUcLogicV2, 0, kHuion,     "capture huion_q11k, hid-uclogic"},
    {0x5543, 0x0781,     F::kUcLogicV1, 0, kUcLogicV1, "probe UC-Logic_TWHA60_v3, hid-uclogic"},
    {0x5543, 0,          F::kUcLogicV1, 0, kHuion,     kHidUclogic},
    {0x28BD, 0x0042,     F::kUcLogicV1, 1, kXpPenV1,   kHidUclogic},
    {0x28BD, 0x0071,     F::kUcLogicV1, 1, kXpPenV1,   kHidUclogic},
    {0x28BD, 0x0075,     F::kUcLogicV1, 1, kXpPenV1,   kHidUclogic},
    {0x28BD, 0x0078,     F::kUcLogicV1, 1, kXpPenV1,   "probe XP-Pen_Star_06, hid-uclogic"},
    {0x28BD, 0x0094,     F::kUcLogicV1, 1, kXpPenV1,   kHidUclogic},
    {0x28BD, 0,          F::kUcLogicV1, 2, kXpPen,     "OpenTabletDriver"},
    {0x28BD, 0,          F::kUgee,      2, kUgee,      "probe Ugee_M708_v2, hid-uclogic"},
    {0x28BD, 0,          F::kUgeeGen2,  2, kUgee,      "OpenTabletDriver"},
    {0x2FEB, 0,          F::kVeikk,     2, kVeikk,     "OpenTabletDriver"},
    {0x0458, 0,          F::kKye,       0, kKye,       "capture kye_mousepen_i608x_v1"},
};
// clang-format on

bool has_row(std::uint16_t vendor, std::uint16_t product, PenFamily family) noexcept {
  const auto rows = pen_specs();
  return std::any_of(rows.begin(), rows.end(), [=](const PenSpec& row) {
    return row.vendor == vendor && row.product == product && row.family == family;
  });
}

/// The declared part of a string descriptor, or nothing.
Bytes declared(Bytes descriptor) noexcept {
  constexpr std::uint8_t kStringType = 3;
  if (descriptor.size() < 2 || descriptor[1] != kStringType || descriptor[0] < 2) return {};
  return descriptor.first(std::min<std::size_t>(descriptor.size(), descriptor[0]));
}

bool is_plain_text(Bytes descriptor) noexcept {
  for (std::size_t i = 2; i + 1 < descriptor.size(); i += 2) {
    if (descriptor[i] < 0x20 || descriptor[i] > 0x7E || descriptor[i + 1] != 0) return false;
  }
  return true;
}

std::int32_t le24(Bytes b, std::size_t at) noexcept { return le16(b, at) | b[at + 2] << 16; }

tl::unexpected<Error> refuse(ErrorCode code, std::uint8_t index, std::string what) {
  return fail(code, "string " + std::to_string(index), std::move(what),
              "use the device as its descriptor or its row explains it");
}

Expected<Bytes> parameter_bytes(Bytes raw, std::uint8_t index, std::size_t shortest) {
  const Bytes bytes = declared(raw);
  if (bytes.empty()) return refuse(ErrorCode::kSyntax, index, "this is no string descriptor");
  if (bytes.size() < shortest) {
    return refuse(ErrorCode::kSyntax, index,
                  std::to_string(bytes.size()) + " bytes are too short for pen parameters");
  }
  if (is_plain_text(bytes)) {
    return refuse(ErrorCode::kSyntax, index, "this is a text, not pen parameters");
  }
  return bytes;
}

Expected<PenParameters> checked(PenParameters parameters, std::int32_t lines_per_inch,
                                std::uint8_t index) {
  constexpr double kSmallestMm = 20;
  constexpr double kLargestMm = 2000;
  if (parameters.x_max == 0 || parameters.y_max == 0 || parameters.pressure_max == 0 ||
      lines_per_inch == 0) {
    return refuse(ErrorCode::kOutOfRange, index, "a range or the resolution is 0");
  }
  parameters.counts_per_mm = lines_per_inch / 25.4;
  const double width = parameters.x_max / parameters.counts_per_mm;
  const double height = parameters.y_max / parameters.counts_per_mm;
  if (std::min(width, height) < kSmallestMm || std::max(width, height) > kLargestMm) {
    return refuse(ErrorCode::kOutOfRange, index, "no tablet has the size that it tells");
  }
  return parameters;
}

}  // namespace

std::span<const PenInitialization> pen_initializations() noexcept { return kSequences; }

const PenInitialization* find_pen_initialization(std::uint16_t vendor,
                                                 std::uint16_t product) noexcept {
  for (const PenInitialization& sequence : kSequences) {
    if (sequence.vendor != vendor) continue;
    if (vendor == kHuionVendor || sequence.product == product) return &sequence;
    if (sequence.product == 0 && has_row(vendor, product, sequence.family)) return &sequence;
  }
  return nullptr;
}

Expected<PenParameters> pen_parameters_v1(Bytes string_descriptor, PenFamily family) {
  const auto bytes = parameter_bytes(string_descriptor, kParametersV1, 12);
  if (!bytes) return tl::unexpected(bytes.error());
  PenParameters parameters;
  parameters.family = family;
  parameters.x_max = le16(*bytes, 2);
  parameters.y_max = le16(*bytes, 4);
  parameters.pressure_max = le16(*bytes, 8);
  return checked(parameters, le16(*bytes, 10), kParametersV1);
}

Expected<PenParameters> pen_parameters_v2(Bytes string_descriptor) {
  const auto bytes = parameter_bytes(string_descriptor, kParametersV2, 18);
  if (!bytes) return tl::unexpected(bytes.error());
  PenParameters parameters;
  parameters.family = F::kUcLogicV2;
  parameters.x_max = le24(*bytes, 2);
  parameters.y_max = le24(*bytes, 5);
  parameters.pressure_max = le16(*bytes, 8);
  parameters.frame_buttons = true;
  return checked(parameters, le16(*bytes, 10), kParametersV2);
}

std::string text_of_string_descriptor(Bytes string_descriptor) {
  const Bytes bytes = declared(string_descriptor);
  std::string text;
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
    const bool ascii = bytes[i] >= 0x20 && bytes[i] <= 0x7E && bytes[i + 1] == 0;
    text += ascii ? static_cast<char>(bytes[i]) : '?';
  }
  return text;
}

bool PenInitializer::applies(const PenInitStep& step) const noexcept {
  switch (step.when) {
    case W::kAlways:
      return true;
    case W::kUnlessTransitional:
      return firmware_ != kTransitionalFirmware;
    case W::kUnlessParametersKnown:
      return !parameters_;
    case W::kWithParametersFromHere:
      return found_here_;
  }
  return false;
}

const PenInitStep* PenInitializer::next() noexcept {
  while (at_ < sequence_->steps.size()) {
    if (applies(sequence_->steps[at_])) return &sequence_->steps[at_];
    ++at_;
    found_here_ = false;
  }
  return nullptr;
}

void PenInitializer::done(Bytes answer) {
  const PenInitStep* step = next();
  if (step == nullptr) return;
  ++at_;
  found_here_ = false;
  if (step->action != A::kReadString) return;
  if (step->gives) {
    const auto found = *step->gives == F::kUcLogicV2 ? pen_parameters_v2(answer)
                                                     : pen_parameters_v1(answer, *step->gives);
    found_here_ = found.has_value();
    if (found) parameters_ = *found;
    return;
  }
  if (step->string_index == kFirmware) {
    firmware_ = text_of_string_descriptor(answer);
  } else if (step->string_index == kFrameButtons) {
    if (parameters_)
      parameters_->frame_buttons = text_of_string_descriptor(answer) == kFrameButtonsOn;
  }
}

}  // namespace limn
