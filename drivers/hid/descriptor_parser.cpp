#include "drivers/hid/descriptor_parser.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace limn::hid {
namespace {

using Bytes = std::span<const std::uint8_t>;

enum class ItemType : std::uint8_t { kMain = 0, kGlobal = 1, kLocal = 2, kReserved = 3 };

/// One short item (HID 1.11 section 6.2.2.2).
struct Item {
  std::uint32_t offset = 0;
  ItemType type = ItemType::kMain;
  std::uint8_t tag = 0;
  Bytes data;

  std::uint32_t as_unsigned() const noexcept {
    std::uint32_t value = 0;
    for (std::size_t i = data.size(); i-- > 0;) value = value << 8 | data[i];
    return value;
  }

  /// Two's complement of the item's own width.
  std::int32_t as_signed() const noexcept {
    switch (data.size()) {
      case 1:
        return static_cast<std::int8_t>(data[0]);
      case 2:
        return static_cast<std::int16_t>(as_unsigned());
      default:
        return static_cast<std::int32_t>(as_unsigned());
    }
  }
};

/// A Maximum item means one of two numbers, and only its Minimum tells which; either may come
/// first, so both are kept until a Main item needs the range.
struct MaximumItem {
  std::int32_t as_signed = 0;
  std::uint32_t as_unsigned = 0;
};

Range make_range(std::int32_t minimum, MaximumItem maximum) noexcept {
  const std::int64_t top = minimum < 0 ? static_cast<std::int64_t>(maximum.as_signed)
                                       : static_cast<std::int64_t>(maximum.as_unsigned);
  return {minimum, top};
}

/// The global item state table (section 6.2.2.7): what Push saves.
struct Globals {
  std::uint16_t usage_page = 0;
  std::uint8_t report_id = 0;
  std::int8_t unit_exponent = 0;
  std::int32_t logical_minimum = 0;
  MaximumItem logical_maximum;
  std::int32_t physical_minimum = 0;
  MaximumItem physical_maximum;
  std::uint32_t unit = 0;
  std::uint32_t report_size = 0;
  std::uint32_t report_count = 0;
};

/// A usage as a local item gives it: its page is only known at the Main item unless it brought one.
struct LocalUsage {
  std::uint16_t id = 0;
  std::uint16_t page = 0;
  bool has_page = false;
};

struct LocalRange {
  LocalUsage first;
  std::uint16_t last_id = 0;
};

struct Locals {
  std::vector<LocalRange> usages;
  std::optional<LocalUsage> minimum;
  std::optional<LocalUsage> maximum;
  std::uint32_t delimiter_sets = 0;
  bool in_delimiter = false;

  void clear() {
    usages.clear();
    minimum.reset();
    maximum.reset();
    delimiter_sets = 0;
    in_delimiter = false;
  }
};

constexpr const char* kWholeDescriptor = "check that these bytes are a whole report descriptor";
constexpr const char* kNotADescriptor =
    "the bytes are no usable report descriptor; read it from the device again";
constexpr std::size_t kKinds = 3;

std::string byte_place(std::uint32_t offset) { return "byte " + std::to_string(offset); }

class Parser {
 public:
  explicit Parser(Bytes bytes) : bytes_(bytes) {}

  Expected<ReportDescriptor> parse();

 private:
  using Result = Expected<void>;

  Expected<Item> take_short_item();
  Result skip_long_item();
  Result handle(const Item& item);
  Result handle_main(const Item& item);
  Result handle_global(const Item& item);
  Result handle_local(const Item& item);
  Result open_collection(const Item& item);
  Result close_collection(const Item& item);
  Result add_field(const Item& item, ReportKind kind);
  Result set_report_id(const Item& item);
  Result delimit(const Item& item);
  void set_unit_exponent(const Item& item);
  void add_usage(const Item& item);
  void set_usage_end(const Item& item, std::optional<LocalUsage>& end);
  std::uint16_t page_of(const LocalUsage& usage) const noexcept {
    return usage.has_page ? usage.page : globals_.usage_page;
  }
  void store_usages(Field& field);
  void finish();
  void note(std::uint32_t offset, std::string what);

  static tl::unexpected<Error> syntax(std::uint32_t offset, std::string what) {
    return fail(ErrorCode::kSyntax, byte_place(offset), std::move(what), kWholeDescriptor);
  }
  static tl::unexpected<Error> limit(std::uint32_t offset, std::string what) {
    return fail(ErrorCode::kLimit, byte_place(offset), std::move(what), kNotADescriptor);
  }

  Bytes bytes_;
  std::uint32_t position_ = 0;
  Globals globals_;
  std::vector<Globals> pushed_;
  std::vector<std::uint32_t> push_offsets_;
  Locals locals_;
  CollectionIndex open_ = kNoCollection;  // innermost open collection
  std::size_t depth_ = 0;
  // Payload bits of each report so far, and whether the report exists, by kind and ID.
  std::array<std::array<std::uint32_t, 256>, kKinds> bits_{};
  std::array<std::array<bool, 256>, kKinds> seen_{};
  ReportDescriptor out_;
};

void Parser::note(std::uint32_t offset, std::string what) {
  if (out_.notes.size() < kMaxNotes) out_.notes.push_back({offset, std::move(what)});
}

Expected<ReportDescriptor> Parser::parse() {
  if (bytes_.empty()) {
    return fail(ErrorCode::kMissing, byte_place(0), "the report descriptor is empty",
                kWholeDescriptor);
  }
  if (bytes_.size() > kMaxDescriptorBytes) {
    return limit(kMaxDescriptorBytes, "the report descriptor is longer than " +
                                          std::to_string(kMaxDescriptorBytes) +
                                          " bytes, the most that USB can announce");
  }
  out_.byte_length = static_cast<std::uint32_t>(bytes_.size());
  while (position_ < bytes_.size()) {
    constexpr std::uint8_t kLongItem = 0xFE;
    if (bytes_[position_] == kLongItem) {
      if (auto skipped = skip_long_item(); !skipped) return tl::unexpected(skipped.error());
      continue;
    }
    auto item = take_short_item();
    if (!item) return tl::unexpected(item.error());
    if (auto done = handle(*item); !done) return tl::unexpected(done.error());
  }
  if (open_ != kNoCollection) {
    const auto& collection = out_.collections[static_cast<std::size_t>(open_)];
    return syntax(out_.byte_length, "the collection opened at byte " +
                                        std::to_string(collection.offset) + " is never closed");
  }
  finish();
  return std::move(out_);
}

Expected<Item> Parser::take_short_item() {
  const std::uint8_t prefix = bytes_[position_];
  constexpr std::array<std::size_t, 4> kDataBytes = {0, 1, 2, 4};
  const std::size_t size = kDataBytes[prefix & 0x3];
  const std::size_t left = bytes_.size() - position_ - 1;
  if (left < size) {
    return syntax(position_, "the item has " + std::to_string(size) + " data bytes but " +
                                 std::to_string(left) + " follow");
  }
  const Item item{position_, static_cast<ItemType>((prefix >> 2) & 0x3),
                  static_cast<std::uint8_t>(prefix >> 4), bytes_.subspan(position_ + 1, size)};
  position_ += static_cast<std::uint32_t>(1 + size);
  return item;
}

Expected<void> Parser::skip_long_item() {
  const std::size_t left = bytes_.size() - position_ - 1;
  const std::size_t needed = left == 0 ? 2 : std::size_t{2} + bytes_[position_ + 1];
  if (left < needed) {
    return syntax(position_, "the long item has " + std::to_string(needed) + " further bytes but " +
                                 std::to_string(left) + " follow");
  }
  position_ += static_cast<std::uint32_t>(1 + needed);
  return {};
}

Expected<void> Parser::handle(const Item& item) {
  switch (item.type) {
    case ItemType::kMain:
      return handle_main(item);
    case ItemType::kGlobal:
      return handle_global(item);
    case ItemType::kLocal:
      return handle_local(item);
    case ItemType::kReserved:
      note(item.offset, "item of the reserved type skipped");
  }
  return {};
}

Expected<void> Parser::handle_main(const Item& item) {
  Result done;
  switch (item.tag) {
    case 0x8:
      done = add_field(item, ReportKind::kInput);
      break;
    case 0x9:
      done = add_field(item, ReportKind::kOutput);
      break;
    case 0xA:
      done = open_collection(item);
      break;
    case 0xB:
      done = add_field(item, ReportKind::kFeature);
      break;
    case 0xC:
      done = close_collection(item);
      break;
    default:
      note(item.offset, "unknown main item " + std::to_string(item.tag) + " skipped");
  }
  locals_.clear();  // local items end at every Main item
  return done;
}

Expected<void> Parser::open_collection(const Item& item) {
  if (out_.collections.size() == kMaxCollections) {
    return limit(item.offset, "more than " + std::to_string(kMaxCollections) + " collections");
  }
  if (depth_ == kMaxCollectionDepth) {
    return limit(item.offset,
                 "collections nested deeper than " + std::to_string(kMaxCollectionDepth));
  }
  Collection collection;
  collection.type = static_cast<CollectionType>(item.as_unsigned() & 0xFF);
  collection.parent = open_;
  collection.offset = item.offset;
  if (!locals_.usages.empty()) {
    const LocalUsage& first = locals_.usages.front().first;
    collection.usage = {page_of(first), first.id};
  }
  open_ = static_cast<CollectionIndex>(out_.collections.size());
  out_.collections.push_back(collection);
  ++depth_;
  return {};
}

Expected<void> Parser::close_collection(const Item& item) {
  if (open_ == kNoCollection) return syntax(item.offset, "End Collection without a collection");
  open_ = out_.collections[static_cast<std::size_t>(open_)].parent;
  --depth_;
  return {};
}

Expected<void> Parser::add_field(const Item& item, ReportKind kind) {
  const Globals& g = globals_;
  if (g.report_size == 0 || g.report_count == 0) {
    note(item.offset, "field without bits skipped");
    return {};
  }
  auto& bits = bits_[static_cast<std::size_t>(kind)][g.report_id];
  const std::uint64_t id_bits = g.report_id == 0 ? 0 : 8;
  const std::uint64_t end = bits + std::uint64_t{g.report_size} * g.report_count;
  if (end + id_bits > std::uint64_t{kMaxReportBytes} * 8) {
    return limit(item.offset, std::to_string(g.report_count) + " elements of " +
                                  std::to_string(g.report_size) +
                                  " bits make the report longer than " +
                                  std::to_string(kMaxReportBytes) + " bytes");
  }
  if (out_.fields.size() == kMaxFields) {
    return limit(item.offset, "more than " + std::to_string(kMaxFields) + " fields");
  }
  if (locals_.in_delimiter) note(item.offset, "delimiter left open");
  if (open_ == kNoCollection) note(item.offset, "field outside all collections");

  Field field;
  field.kind = kind;
  field.report_id = g.report_id;
  field.flags = FieldFlags(item.as_unsigned());
  field.bit_offset = bits;
  field.bit_size = g.report_size;
  field.count = g.report_count;
  field.collection = open_;
  field.logical = make_range(g.logical_minimum, g.logical_maximum);
  field.physical = make_range(g.physical_minimum, g.physical_maximum);
  field.unit = g.unit;
  field.unit_exponent = g.unit_exponent;
  field.offset = item.offset;
  if (field.logical.minimum > field.logical.maximum) {
    note(item.offset, "logical minimum above the maximum: range ignored");
  }
  store_usages(field);
  out_.fields.push_back(field);
  bits = static_cast<std::uint32_t>(end);
  seen_[static_cast<std::size_t>(kind)][g.report_id] = true;
  return {};
}

void Parser::store_usages(Field& field) {
  if (locals_.minimum || locals_.maximum) {
    note(field.offset, "usage minimum or maximum without the other ignored");
  }
  field.first_usage_range = static_cast<std::uint32_t>(out_.usage_ranges.size());
  for (const LocalRange& range : locals_.usages) {
    out_.usage_ranges.push_back({{page_of(range.first), range.first.id}, range.last_id});
  }
  field.usage_range_count =
      static_cast<std::uint32_t>(out_.usage_ranges.size()) - field.first_usage_range;
}

Expected<void> Parser::handle_global(const Item& item) {
  Globals& g = globals_;
  switch (item.tag) {
    case 0x0:
      g.usage_page = static_cast<std::uint16_t>(item.as_unsigned());
      break;
    case 0x1:
      g.logical_minimum = item.as_signed();
      break;
    case 0x2:
      g.logical_maximum = {item.as_signed(), item.as_unsigned()};
      break;
    case 0x3:
      g.physical_minimum = item.as_signed();
      break;
    case 0x4:
      g.physical_maximum = {item.as_signed(), item.as_unsigned()};
      break;
    case 0x5:
      set_unit_exponent(item);
      break;
    case 0x6:
      g.unit = item.as_unsigned();
      break;
    case 0x7:
      if (item.as_unsigned() > kMaxFieldBits) {
        return limit(item.offset, "Report Size " + std::to_string(item.as_unsigned()) +
                                      " is above " + std::to_string(kMaxFieldBits) + " bits");
      }
      g.report_size = item.as_unsigned();
      break;
    case 0x8:
      return set_report_id(item);
    case 0x9:
      g.report_count = item.as_unsigned();
      break;
    case 0xA:
      if (pushed_.size() == kMaxPushDepth) {
        return limit(item.offset, "more than " + std::to_string(kMaxPushDepth) + " nested pushes");
      }
      pushed_.push_back(g);
      push_offsets_.push_back(item.offset);
      break;
    case 0xB:
      if (pushed_.empty()) return syntax(item.offset, "Pop without a Push");
      g = pushed_.back();
      pushed_.pop_back();
      push_offsets_.pop_back();
      break;
    default:
      note(item.offset, "unknown global item " + std::to_string(item.tag) + " skipped");
  }
  return {};
}

Expected<void> Parser::set_report_id(const Item& item) {
  const std::uint32_t id = item.as_unsigned();
  if (id == 0) return syntax(item.offset, "Report ID 0 is reserved");
  if (id > 255) {
    return syntax(item.offset, "Report ID " + std::to_string(id) + " does not fit one byte");
  }
  globals_.report_id = static_cast<std::uint8_t>(id);
  return {};
}

void Parser::set_unit_exponent(const Item& item) {
  // The specification's form is a nibble (0xD is -3); many devices send a signed byte instead.
  const std::uint32_t raw = item.as_unsigned();
  std::int32_t exponent = item.as_signed();
  if ((raw & ~std::uint32_t{0xF}) == 0) {
    exponent = static_cast<std::int32_t>(raw) - (raw >= 8 ? 16 : 0);
  }
  if (exponent < -128 || exponent > 127) {
    note(item.offset, "unit exponent " + std::to_string(exponent) + " read as 0");
    exponent = 0;
  }
  globals_.unit_exponent = static_cast<std::int8_t>(exponent);
}

Expected<void> Parser::handle_local(const Item& item) {
  switch (item.tag) {
    case 0x0:
      add_usage(item);
      break;
    case 0x1:
      set_usage_end(item, locals_.minimum);
      break;
    case 0x2:
      set_usage_end(item, locals_.maximum);
      break;
    case 0x3:  // Designator Index, Minimum, Maximum; String Index, Minimum, Maximum
    case 0x4:
    case 0x5:
    case 0x7:
    case 0x8:
    case 0x9:
      break;
    case 0xA:
      return delimit(item);
    default:
      note(item.offset, "unknown local item " + std::to_string(item.tag) + " skipped");
  }
  return {};
}

/// Delimited sets are alternatives to each other: only the first one counts.
Expected<void> Parser::delimit(const Item& item) {
  const bool opens = item.as_unsigned() != 0;
  if (opens == locals_.in_delimiter) {
    return syntax(item.offset, opens ? "delimiters are nested" : "delimiter closed but not open");
  }
  locals_.in_delimiter = opens;
  if (opens) ++locals_.delimiter_sets;
  return {};
}

LocalUsage usage_from(const Item& item) noexcept {
  const std::uint32_t value = item.as_unsigned();
  return {static_cast<std::uint16_t>(value), static_cast<std::uint16_t>(value >> 16),
          item.data.size() == 4};
}

void Parser::add_usage(const Item& item) {
  if (locals_.in_delimiter && locals_.delimiter_sets > 1) return;
  const LocalUsage usage = usage_from(item);
  locals_.usages.push_back({usage, usage.id});
}

/// A range is complete with both its ends, whichever comes first. It is on the page that either end
/// brings.
void Parser::set_usage_end(const Item& item, std::optional<LocalUsage>& end) {
  if (locals_.in_delimiter && locals_.delimiter_sets > 1) return;
  end = usage_from(item);
  if (!locals_.minimum || !locals_.maximum) return;
  LocalUsage first = *locals_.minimum;
  const LocalUsage last = *locals_.maximum;
  locals_.minimum.reset();
  locals_.maximum.reset();
  if (first.id > last.id) {
    note(item.offset, "usage minimum above the maximum: range ignored");
    return;
  }
  if (!first.has_page && last.has_page) {
    first.page = last.page;
    first.has_page = true;
  }
  locals_.usages.push_back({first, last.id});
}

void Parser::finish() {
  for (const std::uint32_t offset : push_offsets_) note(offset, "Push without a Pop");
  std::array<bool, kKinds> numbered{};
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    const auto& seen = seen_[kind];
    numbered[kind] = std::any_of(seen.begin() + 1, seen.end(), [](bool exists) { return exists; });
    for (std::size_t id = 0; id < seen.size(); ++id) {
      if (!seen[id]) continue;
      const std::uint32_t bits = bits_[kind][id] + (numbered[kind] ? 8 : 0);
      out_.reports.push_back(
          {static_cast<ReportKind>(kind), static_cast<std::uint8_t>(id), (bits + 7) / 8});
    }
  }
  for (Field& field : out_.fields) {
    if (!numbered[static_cast<std::size_t>(field.kind)]) continue;
    field.bit_offset += 8;
    if (field.report_id == 0) note(field.offset, "field before the first Report ID");
  }
}

}  // namespace

Expected<ReportDescriptor> parse_descriptor(Bytes bytes) { return Parser(bytes).parse(); }

}  // namespace limn::hid
