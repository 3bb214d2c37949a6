#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/hid/usages.hpp"
#include "input/base/error.hpp"

namespace limn::hid {

enum class ReportKind : std::uint8_t { kInput, kOutput, kFeature };

/// Index of a collection in ReportDescriptor::collections, or kNoCollection.
using CollectionIndex = std::int32_t;
inline constexpr CollectionIndex kNoCollection = -1;

/// Collection types of HID 1.11 section 6.2.2.6; 0x80 and above are the vendor's.
enum class CollectionType : std::uint8_t {
  kPhysical = 0,
  kApplication = 1,
  kLogical = 2,
  kReport = 3,
  kNamedArray = 4,
  kUsageSwitch = 5,
  kUsageModifier = 6,
};

struct Collection {
  CollectionType type = CollectionType::kPhysical;
  Usage usage;  ///< the first usage before the Collection item; {0, 0} where there was none
  CollectionIndex parent = kNoCollection;
  std::uint32_t offset = 0;  ///< of the Collection item in the descriptor, bytes
};

/// The bits of an Input, Output or Feature item (HID 1.11 section 6.2.2.5); nine are defined.
class FieldFlags {
 public:
  constexpr FieldFlags() = default;
  constexpr explicit FieldFlags(std::uint32_t bits) noexcept : bits_(bits) {}
  constexpr bool constant() const noexcept { return (bits_ & 0x001) != 0; }
  constexpr bool variable() const noexcept { return (bits_ & 0x002) != 0; }
  constexpr bool array() const noexcept { return !variable(); }
  constexpr bool relative() const noexcept { return (bits_ & 0x004) != 0; }
  constexpr bool wrap() const noexcept { return (bits_ & 0x008) != 0; }
  constexpr bool nonlinear() const noexcept { return (bits_ & 0x010) != 0; }
  constexpr bool no_preferred() const noexcept { return (bits_ & 0x020) != 0; }
  constexpr bool null_state() const noexcept { return (bits_ & 0x040) != 0; }
  constexpr bool is_volatile() const noexcept { return (bits_ & 0x080) != 0; }
  constexpr bool buffered_bytes() const noexcept { return (bits_ & 0x100) != 0; }
  constexpr std::uint32_t bits() const noexcept { return bits_; }

 private:
  std::uint32_t bits_ = 0;
};

/// Both ends belong to it. 64 bits hold both signed and unsigned 32-bit ends.
struct Range {
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;

  constexpr bool contains(std::int64_t value) const noexcept {
    return minimum <= value && value <= maximum;
  }
  friend constexpr bool operator==(const Range&, const Range&) = default;
};

/// Usages first.id .. last_id of first.page.
struct UsageRange {
  Usage first;
  std::uint16_t last_id = 0;

  constexpr std::uint32_t count() const noexcept {
    return static_cast<std::uint32_t>(last_id - first.id) + 1;
  }
};

/// What one Main item declares: `count` elements of `bit_size` bits each, one after the other.
struct Field {
  ReportKind kind = ReportKind::kInput;
  std::uint8_t report_id = 0;  ///< 0 where reports of this kind are not numbered
  FieldFlags flags;
  std::uint32_t bit_offset = 0;  ///< from the report's first byte, the report ID byte included
  std::uint32_t bit_size = 0;    ///< of one element, 1 to kMaxFieldBits
  std::uint32_t count = 0;       ///< 1 or more
  CollectionIndex collection = kNoCollection;  ///< the innermost one around the item
  Range logical;                  ///< counts; minimum > maximum (malformed) means: no range
  Range physical;                 ///< as declared; 0..0 means: the logical range (physical_range)
  std::uint32_t unit = 0;         ///< HID unit code as declared, see units.hpp
  std::int8_t unit_exponent = 0;  ///< power of ten, -128 to 127
  std::uint32_t first_usage_range = 0;  ///< use ReportDescriptor::usages
  std::uint32_t usage_range_count = 0;
  std::uint32_t offset = 0;  ///< of the Main item in the descriptor, bytes

  /// Values are two's complement; decided by the Logical Minimum alone.
  constexpr bool is_signed() const noexcept { return logical.minimum < 0; }
};

/// One report as a whole.
struct ReportShape {
  ReportKind kind = ReportKind::kInput;
  std::uint8_t id = 0;
  std::uint32_t byte_length = 0;  ///< on the wire, with the ID byte where numbered, rounded up
};

/// Something that the descriptor does wrongly and limn tolerates.
struct DescriptorNote {
  std::uint32_t offset = 0;  ///< bytes
  std::string what;
};

/// Limits that bound time and memory for any bytes. Real descriptors reach 2,580 bytes, 121 fields,
/// 60 collections in 4 levels, and reports of 7,488 bytes.
inline constexpr std::size_t kMaxDescriptorBytes = 65535;  ///< USB gives the length 16 bits
inline constexpr std::size_t kMaxCollections = 4096;
inline constexpr std::size_t kMaxCollectionDepth = 64;
inline constexpr std::size_t kMaxPushDepth = 64;
inline constexpr std::size_t kMaxFields = 8192;
inline constexpr std::uint32_t kMaxFieldBits = 256;      ///< Report Size; Linux has the same limit
inline constexpr std::uint32_t kMaxReportBytes = 16384;  ///< Linux's HID_MAX_BUFFER_SIZE
inline constexpr std::size_t kMaxNotes = 64;

/// A parsed report descriptor: plain data, a regular value. Fields are in descriptor order, padding
/// included (no usage, or constant); elements are never expanded, so its size is linear in the
/// descriptor's.
struct ReportDescriptor {
  std::vector<Collection> collections;  ///< in descriptor order: a parent precedes its children
  std::vector<Field> fields;
  std::vector<UsageRange> usage_ranges;  ///< all fields' usages; see usages()
  std::vector<ReportShape> reports;      ///< by kind, then ID
  std::vector<DescriptorNote> notes;     ///< at most kMaxNotes
  std::uint32_t byte_length = 0;         ///< of the descriptor itself

  /// Whether reports of `kind` start with an ID byte.
  bool numbered(ReportKind kind) const noexcept;

  /// The report, or nullptr. `id` 0 where not numbered.
  const ReportShape* report(ReportKind kind, std::uint8_t id) const noexcept;

  /// The usages as declared: not repeated and not cut to the field's count.
  std::span<const UsageRange> usages(const Field& field) const noexcept;

  /// Usage number `index` as declared, counted through the ranges; absent past the last one.
  std::optional<Usage> declared_usage(const Field& field, std::uint32_t index) const noexcept;

  /// The usage of element `element` < field.count of a variable field: the last one repeats where
  /// there are fewer usages than elements. Absent for padding and for arrays.
  std::optional<Usage> element_usage(const Field& field, std::uint32_t element) const noexcept;

  /// What `value` in an element of an array field selects: usage number value - Logical Minimum.
  /// Absent for values outside the logical range (nothing selected) or past the last usage.
  std::optional<Usage> selected_usage(const Field& field, std::int64_t value) const noexcept;

  /// Whether `collection` is `ancestor` or lies inside it. kNoCollection as ancestor contains all.
  bool inside(CollectionIndex collection, CollectionIndex ancestor) const noexcept;

  /// The outermost collection around `collection`; kNoCollection for kNoCollection.
  CollectionIndex top_level(CollectionIndex collection) const noexcept;
};

/// Parses a HID report descriptor (HID 1.11 section 6.2.2), linear in its length.
///
///   - Minimum items are signed. Maximum items are signed only where their Minimum is negative.
///   - Unit Exponent is a signed nibble (0xD is -3), or a signed byte where the upper bits are
///   used.
///   - A usage of up to two bytes takes the Usage Page in force at its Main item, one of four bytes
///     brings its own.
///   - Of delimited usages only the first set counts. Long items are skipped.
///   - Tolerated, with a note: pushes without a pop, unknown items, a logical minimum above the
///     maximum, a usage minimum above the maximum, fields outside a collection or without bits.
///
/// Error, with `at` = "byte N" of the item: kSyntax (an item cut short, a pop or an End Collection
/// too many, a collection left open, Report ID 0 or above 255, nested delimiters), kMissing (no
/// bytes), kLimit (one of the limits above).
Expected<ReportDescriptor> parse_descriptor(std::span<const std::uint8_t> bytes);

}  // namespace limn::hid
