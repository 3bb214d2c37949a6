#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware_sim/usb/report_field.hpp"

namespace limn::firmware {

/// Kind of a Collection item [HID 1.11, 6.2.2.6].
enum class CollectionKind : std::uint8_t { kPhysical = 0x00, kApplication = 0x01 };

/// Data part of an Input, Output or Feature item [HID 1.11, 6.2.2.5], as a type of its own: it goes
/// into input(), output() and feature() and nowhere else.
enum class InputFlags : std::uint8_t {
  kArray = 0x00,     ///< each field holds the number of one of the usages
  kVariable = 0x02,  ///< each field is a usage, absolute
  kConstant = 0x03,
  kRelative = 0x06,  ///< each field is a usage, as its change since the last report
};

/// A report ID, 1 to 255. 0 is reserved and does not compile.
class ReportId {
 public:
  consteval explicit ReportId(unsigned id) : value_(static_cast<std::uint8_t>(id)) {
    if (id < 1 || id > 255) the_report_id_must_be_1_to_255();
  }
  constexpr std::uint8_t value() const noexcept { return value_; }

 private:
  static void the_report_id_must_be_1_to_255();  // not constexpr: calling it stops the compiler
  std::uint8_t value_;
};

/// Writes a HID report descriptor, item by item, at compile time:
///
///     constexpr auto kBuilt = DescriptorBuilder()
///                                 .application(usages::kPen).report_id(ReportId{1})
///                                 .input_fields(kFields, kBits).end_collection();
///     static_assert(kBuilt.is_well_formed());
///     constexpr auto kDescriptor = descriptor_bytes<kBuilt.size()>(kBuilt);
///
/// Wire layout [HID 1.11, 6.2.2.2]: a prefix byte (tag << 4 | type << 2 | size code), then 0, 1, 2
/// or 4 data bytes, little-endian. Each item is the shortest that is read the same whichever way a
/// reader takes the sign: ranges are written as signed numbers, so 255 has two data bytes and 65535
/// four. Global items are written only where they change; physical range and unit are 0 at first.
/// Memory: a fixed array inside the object; nothing of it is left in a program that keeps only
/// descriptor_bytes().
class DescriptorBuilder {
 public:
  static constexpr std::size_t kCapacity = 512;

  constexpr DescriptorBuilder& collection(CollectionKind kind, Usage what) noexcept {
    usage(what);
    if (usages_ > 1) sound_ = false;
    put(Prefix::kCollection, static_cast<std::uint8_t>(kind), 1);
    ++open_collections_;
    end_main_item();
    return *this;
  }

  constexpr DescriptorBuilder& application(Usage what) noexcept {
    return collection(CollectionKind::kApplication, what);
  }

  constexpr DescriptorBuilder& end_collection() noexcept {
    if (open_collections_ == 0 || usages_ > 0) sound_ = false;
    --open_collections_;
    put(Prefix::kEndCollection, 0, 0);
    end_main_item();
    return *this;
  }

  /// Begins a report. Error (seen by is_well_formed): an ID used before, or fields without an ID
  /// before the first one.
  constexpr DescriptorBuilder& report_id(ReportId id) noexcept {
    if (report_bits_[id.value()] != 0 || report_bits_[0] != 0) sound_ = false;
    report_ = id.value();
    put_unsigned(Prefix::kReportId, id.value());
    return *this;
  }

  /// Adds a usage to the next main item. The Usage Page follows by itself; a usage from another
  /// page than its main item's earlier ones is written in the four-byte form that carries its page,
  /// since shorter ones take the page in force at the main item [HID 1.11, 6.2.2.8].
  constexpr DescriptorBuilder& usage(Usage what) noexcept {
    ++usages_;
    if (what.page != page_ && usages_ > 1) {
      put(Prefix::kUsage, static_cast<std::uint32_t>(what.page) << 16 | what.id, 4);
      return *this;
    }
    if (what.page != page_) {
      page_ = what.page;
      put_unsigned(Prefix::kUsagePage, static_cast<std::uint32_t>(what.page));
    }
    put_unsigned(Prefix::kUsage, what.id);
    return *this;
  }

  /// Adds the usages of a page from one to another, `last` included, to the next main item.
  constexpr DescriptorBuilder& usage_range(Usage first, std::uint16_t last) noexcept {
    if (last < first.id || usages_ > 0) sound_ = false;
    usages_ += last - first.id + 1U;
    if (first.page != page_) {
      page_ = first.page;
      put_unsigned(Prefix::kUsagePage, static_cast<std::uint32_t>(page_));
    }
    put_unsigned(Prefix::kUsageMinimum, first.id);
    put_unsigned(Prefix::kUsageMaximum, last);
    return *this;
  }

  constexpr DescriptorBuilder& logical(Range range) noexcept {
    if (range.minimum >= range.maximum) sound_ = false;
    // The specification gives no default for it, so the first one is told even where it is 0.
    if (!told_logical_ && range.minimum == 0) put_signed(Prefix::kLogicalMinimum, 0);
    told_logical_ = true;
    put_range(Prefix::kLogicalMinimum, Prefix::kLogicalMaximum, logical_, range);
    return *this;
  }

  /// kNoPhysical returns to "as logical".
  constexpr DescriptorBuilder& physical(Range range) noexcept {
    put_range(Prefix::kPhysicalMinimum, Prefix::kPhysicalMaximum, physical_, range);
    return *this;
  }

  constexpr DescriptorBuilder& unit(Unit unit, UnitExponent exponent = 0) noexcept {
    if (unit != unit_) put_unsigned(Prefix::kUnit, static_cast<std::uint32_t>(unit));
    if (exponent != exponent_) {
      // A nibble, not a signed byte: the form of the HID specification's own table.
      put_unsigned(Prefix::kUnitExponent, static_cast<std::uint32_t>(exponent.power()) & 0xFU);
    }
    unit_ = unit;
    exponent_ = exponent;
    return *this;
  }

  /// `count` fields of `bits` each (1 to 32).
  constexpr DescriptorBuilder& report_size(unsigned bits, unsigned count = 1) noexcept {
    if (bits < 1 || bits > 32 || count < 1) sound_ = false;
    if (bits != bits_) put_unsigned(Prefix::kReportSize, bits);
    if (count != count_) put_unsigned(Prefix::kReportCount, count);
    bits_ = bits;
    count_ = count;
    return *this;
  }

  /// Error (seen by is_well_formed): no size, counts that do not fit it, more usages than fields
  /// (but of an array), data without a usage, or a constant with one.
  constexpr DescriptorBuilder& input(InputFlags flags) noexcept {
    report_bits_[report_] += bits_ * count_;
    return main_item(Prefix::kInput, flags);
  }

  /// Errors as of input().
  constexpr DescriptorBuilder& output(InputFlags flags) noexcept {
    output_bits_[report_] += bits_ * count_;
    return main_item(Prefix::kOutput, flags);
  }

  /// Errors as of input().
  constexpr DescriptorBuilder& feature(InputFlags flags) noexcept {
    feature_bits_[report_] += bits_ * count_;
    return main_item(Prefix::kFeature, flags);
  }

  /// Constant fields that take up `bits` bits of the report.
  constexpr DescriptorBuilder& padding(unsigned bits) noexcept {
    return bits <= 32 ? report_size(bits).input(InputFlags::kConstant)
                      : padding(32).padding(bits - 32);
  }

  /// Writes a whole table: neighbours that differ in nothing but their usage share a main item, and
  /// gaps become padding. Precondition: is_well_formed(fields, report_bits).
  constexpr DescriptorBuilder& input_fields(std::span<const FieldSpec> fields,
                                            std::size_t report_bits) noexcept {
    if (!firmware::is_well_formed(fields, report_bits)) sound_ = false;
    std::size_t bit = 0;
    for (std::size_t first = 0; first < fields.size();) {
      const FieldSpec& field = fields[first];
      if (field.bit > bit) padding(static_cast<unsigned>(field.bit - bit));
      std::size_t last = first + 1;
      while (last < fields.size() && continues(fields[last - 1], fields[last])) ++last;
      for (std::size_t i = first; i < last; ++i) usage(fields[i].usage);
      logical(field.logical).physical(field.physical).unit(field.unit, field.exponent);
      report_size(field.width, static_cast<unsigned>(last - first)).input(InputFlags::kVariable);
      bit = fields[last - 1].end();
      first = last;
    }
    if (bit < report_bits) padding(static_cast<unsigned>(report_bits - bit));
    return *this;
  }

  /// Whether the descriptor stands as it is: every collection closed, every report of whole bytes,
  /// no usage left over, and none of the errors named above.
  constexpr bool is_well_formed() const noexcept {
    for (const auto* kind : {&report_bits_, &output_bits_, &feature_bits_}) {
      for (const std::size_t bits : *kind) {
        if (bits % 8 != 0) return false;
      }
    }
    return sound_ && open_collections_ == 0 && usages_ == 0;
  }

  /// Bytes of the input report with that ID, the ID byte included.
  constexpr std::size_t report_bytes(ReportId id) const noexcept {
    return 1 + report_bits_[id.value()] / 8;
  }

  constexpr std::size_t size() const noexcept { return size_; }
  constexpr std::span<const std::uint8_t> bytes() const noexcept { return {bytes_.data(), size_}; }

 private:
  /// Item prefixes with size code 0: tag << 4 | type << 2.
  enum class Prefix : std::uint8_t {
    kInput = 0x80,
    kOutput = 0x90,
    kFeature = 0xB0,
    kCollection = 0xA0,
    kEndCollection = 0xC0,
    kUsagePage = 0x04,
    kLogicalMinimum = 0x14,
    kLogicalMaximum = 0x24,
    kPhysicalMinimum = 0x34,
    kPhysicalMaximum = 0x44,
    kUnitExponent = 0x54,
    kUnit = 0x64,
    kReportSize = 0x74,
    kReportId = 0x84,
    kReportCount = 0x94,
    kUsage = 0x08,
    kUsageMinimum = 0x18,
    kUsageMaximum = 0x28,
  };

  static constexpr bool continues(const FieldSpec& a, const FieldSpec& b) noexcept {
    return b.bit == a.end() && b.width == a.width && b.logical == a.logical &&
           b.physical == a.physical && b.unit == a.unit && b.exponent == a.exponent &&
           b.usage.page == a.usage.page;
  }

  constexpr void put_byte(std::uint8_t byte) noexcept {
    if (size_ == kCapacity) {
      sound_ = false;
      return;
    }
    bytes_[size_++] = byte;
  }

  /// `data_bytes` is 0, 1, 2 or 4.
  constexpr void put(Prefix prefix, std::uint32_t data, unsigned data_bytes) noexcept {
    const unsigned size_code = data_bytes == 4 ? 3 : data_bytes;
    put_byte(static_cast<std::uint8_t>(static_cast<unsigned>(prefix) | size_code));
    for (unsigned i = 0; i < data_bytes; ++i) put_byte(static_cast<std::uint8_t>(data >> (8 * i)));
  }

  constexpr void put_unsigned(Prefix prefix, std::uint32_t value) noexcept {
    put(prefix, value, value < 0x100 ? 1 : value < 0x10000 ? 2 : 4);
  }

  constexpr void put_signed(Prefix prefix, std::int32_t value) noexcept {
    const bool one = value >= -0x80 && value < 0x80;
    const bool two = value >= -0x8000 && value < 0x8000;
    put(prefix, static_cast<std::uint32_t>(value), one ? 1 : two ? 2 : 4);
  }

  constexpr void put_range(Prefix minimum, Prefix maximum, Range& held, Range wanted) noexcept {
    if (wanted.minimum != held.minimum) put_signed(minimum, wanted.minimum);
    if (wanted.maximum != held.maximum) put_signed(maximum, wanted.maximum);
    held = wanted;
  }

  constexpr DescriptorBuilder& main_item(Prefix prefix, InputFlags flags) noexcept {
    const bool is_data = flags != InputFlags::kConstant;
    if (bits_ == 0 || (usages_ > 0) != is_data) sound_ = false;
    if (usages_ > count_ && flags != InputFlags::kArray) sound_ = false;
    if (is_data && !fits(logical_, bits_)) sound_ = false;
    put(prefix, static_cast<std::uint8_t>(flags), 1);
    end_main_item();
    return *this;
  }

  constexpr void end_main_item() noexcept { usages_ = 0; }

  std::array<std::uint8_t, kCapacity> bytes_{};
  std::size_t size_ = 0;
  // By report ID; 0 where reports are not numbered.
  std::array<std::size_t, 256> report_bits_{};  // of input reports
  std::array<std::size_t, 256> output_bits_{};
  std::array<std::size_t, 256> feature_bits_{};
  std::uint8_t report_ = 0;
  int open_collections_ = 0;
  unsigned usages_ = 0;  // waiting for their main item
  UsagePage page_ = UsagePage::kNone;
  Range logical_;
  bool told_logical_ = false;
  Range physical_;
  Unit unit_ = Unit::kNone;
  UnitExponent exponent_ = 0;
  unsigned bits_ = 0;
  unsigned count_ = 0;
  bool sound_ = true;
};

/// The bytes alone, in an array of their own length. Precondition: kSize == built.size().
template <std::size_t kSize>
consteval std::array<std::uint8_t, kSize> descriptor_bytes(const DescriptorBuilder& built) {
  std::array<std::uint8_t, kSize> out{};
  for (std::size_t i = 0; i < kSize; ++i) out[i] = built.bytes()[i];
  return out;
}

}  // namespace limn::firmware
