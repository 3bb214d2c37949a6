#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "drivers/hid/field_reader.hpp"

namespace limn::hid {
namespace {

using Bytes = std::vector<std::uint8_t>;

Field field(std::uint32_t bit_offset, std::uint32_t bit_size, Range logical,
            std::uint32_t flags = 2) {
  Field made;
  made.flags = FieldFlags(flags);
  made.bit_offset = bit_offset;
  made.bit_size = bit_size;
  made.count = 1;
  made.logical = logical;
  return made;
}

std::optional<std::int64_t> read(const Field& from, const Bytes& report) {
  return FieldReader::of_element(from, 0).read(report);
}

TEST(HidFieldReader, ReadsBytesAndWords) {
  const Bytes report = {0x02, 0xFE, 0x34, 0x92};
  EXPECT_EQ(read(field(8, 8, {0, 255}), report), 0xFE);
  EXPECT_EQ(read(field(8, 8, {-128, 127}), report), -2);
  EXPECT_EQ(read(field(16, 16, {0, 65535}), report), 0x9234);
  EXPECT_EQ(read(field(16, 16, {-32768, 32767}), report), 0x9234 - 0x10000);
  EXPECT_EQ(read(field(9, 1, {0, 1}), report), 1);
  EXPECT_EQ(read(field(8, 1, {0, 1}), report), 0);
}

TEST(HidFieldReader, SignIsDecidedByTheLogicalMinimumAlone) {
  const Bytes report = {0xFF};
  EXPECT_EQ(read(field(0, 8, {0, 127}), report), 255);
  EXPECT_EQ(read(field(0, 8, {-1, 127}), report), -1);
  EXPECT_EQ(read(field(0, 1, {-1, 0}), report), -1);
  EXPECT_EQ(read(field(3, 5, {-16, 15}), report), -1);
  EXPECT_EQ(read(field(3, 5, {0, 31}), report), 31);
}

TEST(HidFieldReader, ReadsUnalignedFieldsOfAnyWidth) {
  // Bits 3..: 0x123456789ABCDEF0 << 3 over nine bytes, low bits 101.
  const std::uint64_t value = 0x923456789ABCDEF0;
  Bytes report(9, 0);
  for (unsigned bit = 0; bit < 64; ++bit) {
    if ((value >> bit & 1) != 0)
      report[(bit + 3) / 8] |= static_cast<std::uint8_t>(1 << (bit + 3) % 8);
  }
  report[0] |= 5;
  for (std::uint32_t bits = 1; bits <= 64; ++bits) {
    const std::uint64_t mask = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    const auto reader = FieldReader::of_bits(3, bits, false);
    EXPECT_EQ(reader.read_bits(report), value & mask) << bits;
    EXPECT_EQ(reader.read(report), static_cast<std::int64_t>(value & mask)) << bits;
  }
}

TEST(HidFieldReader, UnsignedThirtyTwoBitValuesStayPositive) {
  EXPECT_EQ(read(field(0, 32, {0, 4294967295}), {0xFF, 0xFF, 0xFF, 0xFF}), 4294967295);
}

TEST(HidFieldReader, ChecksTheLengthOfItsOwnElementAlone) {
  const auto word = FieldReader::of_element(field(16, 16, {0, 65535}), 0);
  EXPECT_FALSE(word.read(Bytes{0, 0, 1}).has_value());
  EXPECT_EQ(word.read(Bytes{0, 0, 1, 2}), 0x201);
  EXPECT_EQ(word.read(Bytes{0, 0, 1, 2, 9, 9, 9}), 0x201);  // longer than declared
  EXPECT_FALSE(word.read_bits(Bytes{0, 0, 1}).has_value());
  EXPECT_FALSE(word.read({}).has_value());
  const auto odd = FieldReader::of_element(field(14, 11, {0, 2047}), 0);  // bits 14..24
  EXPECT_FALSE(odd.read(Bytes{0, 0, 0}).has_value());
  EXPECT_EQ(odd.read(Bytes{0, 0x80, 0x01, 0x01}), 0x406);
}

TEST(HidFieldReader, ElementsFollowEachOther) {
  Field three = field(8, 12, {0, 4095});
  three.count = 3;
  const Bytes report = {0, 0x21, 0x43, 0x65, 0x87, 0xA9};
  EXPECT_EQ(FieldReader::of_element(three, 0).read(report), 0x321);
  EXPECT_EQ(FieldReader::of_element(three, 1).read(report), 0x654);
  EXPECT_EQ(FieldReader::of_element(three, 2).read(report), 0x987);
  EXPECT_FALSE(FieldReader::of_element(three, 3).present());
}

TEST(HidFieldReader, NullStateMeansNoData) {
  constexpr std::uint32_t kNull = 0x42;
  EXPECT_FALSE(read(field(0, 8, {1, 100}, kNull), {0}).has_value());
  EXPECT_FALSE(read(field(0, 8, {1, 100}, kNull), {101}).has_value());
  EXPECT_EQ(read(field(0, 8, {1, 100}, kNull), {100}), 100);
  EXPECT_FALSE(read(field(3, 10, {-500, 500}, kNull), {0, 0x10}).has_value());  // -512
  EXPECT_EQ(read(field(0, 8, {1, 100}), {101}), 101);       // not clamped without Null State
  EXPECT_EQ(read(field(0, 8, {9, 1}, kNull), {101}), 101);  // a malformed range excludes nothing
  EXPECT_EQ(FieldReader::of_element(field(0, 8, {1, 100}, kNull), 0).read_bits(Bytes{200}), 200U);
}

TEST(HidFieldReader, SerialNumbersOfSixtyFourBits) {
  const auto serial = FieldReader::of_element(field(8, 64, {0, 255}), 0);
  const Bytes report = {2, 0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0xF1};
  EXPECT_EQ(serial.read_bits(report), 0xF122334455667788U);
  EXPECT_FALSE(FieldReader::of_element(field(8, 65, {0, 255}), 0).present());
}

TEST(HidFieldReader, AnAbsentReaderReadsNothing) {
  const FieldReader none;
  EXPECT_FALSE(none.present());
  EXPECT_FALSE(none.read(Bytes(100, 0xFF)).has_value());
  EXPECT_FALSE(none.read_bits(Bytes(100, 0xFF)).has_value());
  EXPECT_FALSE(none.is_set(Bytes(100, 0xFF)));
}

TEST(HidFieldReader, SelectionLooksThroughAnArray) {
  Field array = field(4, 4, {1, 9}, 0);
  array.count = 3;
  const auto second = FieldReader::of_selection(array, 2);
  EXPECT_EQ(second.read(Bytes{0x50, 0x21}), 1);
  EXPECT_EQ(second.read(Bytes{0x50, 0x12}), 1);
  EXPECT_EQ(second.read(Bytes{0x20, 0x00}), 1);
  EXPECT_EQ(second.read(Bytes{0x02, 0x31}), 0);  // bits before the field do not count
  EXPECT_EQ(second.read(Bytes{0x20}), 1);
  EXPECT_FALSE(second.read(Bytes{0x50}).has_value());  // it may be in the missing part
  EXPECT_FALSE(second.read_bits(Bytes{0x50}).has_value());
  EXPECT_EQ(second.read_bits(Bytes{0x50, 0x21}), 1U);
}

TEST(HidFieldReader, KnowsItsPlace) {
  const auto reader = FieldReader::of_element(field(21, 7, {-3, 60}), 0);
  EXPECT_EQ(reader.bit_offset(), 21U);
  EXPECT_EQ(reader.bit_size(), 7U);
  EXPECT_EQ(reader.logical(), (Range{-3, 60}));
}

}  // namespace
}  // namespace limn::hid
