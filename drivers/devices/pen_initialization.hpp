#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/devices/pen_parameters.hpp"
#include "drivers/devices/pen_spec.hpp"
#include "input/base/error.hpp"

namespace limn {

// Some tablets pose as mice until their driver has asked them something. What to ask is data here;
// a transport does it, to the rhythm of PenInitializer.

enum class PenInitAction : std::uint8_t {
  kReadString,      ///< GET_DESCRIPTOR of a string; a stall is an answer too
  kWriteInterrupt,  ///< bytes to an interrupt-out endpoint
  kSetFeature,      ///< SET_REPORT of a feature report, its ID the first byte
};

/// On what earlier answers a step depends.
enum class PenInitWhen : std::uint8_t {
  kAlways,
  kUnlessTransitional,      ///< string 201 does not name the firmware that is half v1, half v2
  kUnlessParametersKnown,   ///< none of the strings read so far held parameters
  kWithParametersFromHere,  ///< the step before gave them
};

struct PenInitStep {
  PenInitAction action = PenInitAction::kReadString;
  PenInitWhen when = PenInitWhen::kAlways;
  std::uint8_t string_index = 0;  ///< kReadString
  std::uint8_t endpoint = 0;      ///< kWriteInterrupt: its number, without the direction bit
  /// kReadString of parameters: how the pen reports from then on.
  std::optional<PenFamily> gives = std::nullopt;
  std::span<const std::uint8_t> bytes = {};  ///< what is written or set
};

/// Strings with parameters are read in US English.
inline constexpr std::uint16_t kPenStringLanguage = 0x0409;
/// As much as the vendors' drivers ask for: more than a descriptor can have.
inline constexpr std::uint16_t kPenStringLength = 0x0100;

/// What a device needs before it reports as its row says.
struct PenInitialization {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;  ///< 0: those of the vendor that have a row of `family`
  PenFamily family = kLastWacomFamily;
  std::uint8_t interface_number = 0;  ///< to which steps are sent and at which the pen then reports
  std::span<const PenInitStep> steps;
  std::string_view evidence;  ///< as PenSpec::evidence
};

/// All sequences of all vendors.
std::span<const PenInitialization> pen_initializations() noexcept;

/// The sequence of a device, or nullptr where it needs none or limn knows none. Every product of
/// Huion's vendor id has one: its many models share few ids.
const PenInitialization* find_pen_initialization(std::uint16_t vendor,
                                                 std::uint16_t product) noexcept;

/// Parameters of a string descriptor's raw bytes.
///
///     v1 (string 100)   le16 x max 2, y max 4, pressure max 8, lines per inch 10; 12 bytes or more
///     v2 (string 200)   le24 x max 2, y max 5, le16 pressure max 8, lines per inch 10; 18 or more
///
/// Error: kSyntax where it is no string descriptor, too short, or plain text (with which some
/// tablets answer to any index); kOutOfRange for a maximum or a resolution of 0, and for a size
/// that no tablet has (below 20 mm, above 2 m). Sources: kernel driver hid-uclogic, captures.
Expected<PenParameters> pen_parameters_v1(std::span<const std::uint8_t> string_descriptor,
                                          PenFamily family = PenFamily::kUcLogicV1);
Expected<PenParameters> pen_parameters_v2(std::span<const std::uint8_t> string_descriptor);

/// The text of a string descriptor; '?' for what is not ASCII. Empty where it is none.
std::string text_of_string_descriptor(std::span<const std::uint8_t> string_descriptor);

/// Goes through a sequence: a pure function of the answers.
///
///     PenInitializer initializer(sequence);
///     while (const PenInitStep* step = initializer.next()) initializer.done(execute(*step));
///     PenDecoder::make(identity with initializer.firmware(), .., initializer.parameters())
///
/// An answer that cannot be had (a stall, a timeout) is an empty one.
class PenInitializer {
 public:
  /// `sequence` must outlive the initializer (pen_initializations() does).
  explicit PenInitializer(const PenInitialization& sequence) noexcept : sequence_(&sequence) {}

  /// The step to do now, the same until done(); nullptr at the end.
  const PenInitStep* next() noexcept;

  /// The step was done. `answer`: the raw string descriptor of a kReadString step.
  void done(std::span<const std::uint8_t> answer = {});

  /// nullptr: the device told none; its row or its descriptor must do.
  const PenParameters* parameters() const noexcept { return parameters_ ? &*parameters_ : nullptr; }

  /// String 201 ("HUION_T164_170520"), where it was asked for and given.
  std::string_view firmware() const noexcept { return firmware_; }

 private:
  const PenInitialization* sequence_;
  std::size_t at_ = 0;
  bool found_here_ = false;  // the step before gave the parameters
  std::optional<PenParameters> parameters_;
  std::string firmware_;

  bool applies(const PenInitStep& step) const noexcept;
};

}  // namespace limn
