#include "input/trace/descriptor_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/recordings.hpp"
#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

const Bytes kMouse = {0x05, 0x01, 0x09, 0x02, 0xA1, 0x01, 0x15, 0x00, 0xC0};

Expected<std::vector<TraceDevice>> read(std::string_view text, TraceOptions options = {}) {
  return read_descriptors(memory_bytes(text), options);
}

Bytes only_descriptor(std::string_view text) {
  const auto devices = read(text);
  EXPECT_TRUE(devices) << at_and_what(devices.error()) << " in " << text;
  if (!devices || devices->size() != 1) return {};
  return devices->front().report_descriptor;
}

TEST(DescriptorFile, ReadsRawBytes) {
  const std::string raw(kMouse.begin(), kMouse.end());
  EXPECT_EQ(only_descriptor(raw), kMouse);
  const auto pieces = read_descriptors(dribble_bytes(raw, 2));
  ASSERT_TRUE(pieces);
  EXPECT_EQ(pieces->at(0).report_descriptor, kMouse);
}

TEST(DescriptorFile, ReadsHexadecimalTextInManyHands) {
  for (const char* text : {
           " 05 01 09 02 A1 01 15\n 00 C0\n",
           "05 01 09 02 a1 01 15 00 c0",
           "05010902a1011500c0\n",
           "0x05, 0x01, 0x09, 0x02, 0xA1, 0x01, 0x15, 0x00, 0xC0,\r\n",
           "05,01,09,02\na1,01,15,00\nc0",
           "# a mouse\n05 01 # Usage Page\n0X09,0x2 // Usage\n/* two\nlines */ a1 01/**/15 00\n"
           "0xC0 // End Collection",
       }) {
    EXPECT_EQ(only_descriptor(text), kMouse) << text;
  }
}

TEST(DescriptorFile, ReadsEveryDeviceOfAHidRecorderFile) {
  const auto devices = read(
      "D: 0\nR: 2 05 01\nN: pen\nI: 3 056a 0314\nD: 1\nR: 1 c0\nD: 0\nE: 0.0 1 01\n"
      "R: 2 05 01\nN: pen again\nE: 0.1 1 01\nR: 2 05 0d\nE: 0.2 1 01\n");
  ASSERT_TRUE(devices);
  ASSERT_EQ(devices->size(), 3U) << "the repeated one counts once";
  EXPECT_EQ((*devices)[0].report_descriptor, (Bytes{5, 1}));
  EXPECT_EQ((*devices)[0].name, "pen again");
  EXPECT_EQ((*devices)[0].vendor, 0x056A);
  EXPECT_EQ((*devices)[1].index, 1U);
  EXPECT_EQ((*devices)[1].report_descriptor, Bytes{0xC0});
  EXPECT_EQ((*devices)[2].report_descriptor, (Bytes{5, 0x0D}));
}

TEST(DescriptorFile, ReadsEveryInterfaceOfAUsbhidDump) {
  const auto devices =
      read("001:006:002:DESCRIPTOR 1.0\n 06 0A FF\n\n001:006:000:DESCRIPTOR 1.1\n 05 01\n");
  ASSERT_TRUE(devices);
  ASSERT_EQ(devices->size(), 2U);
  EXPECT_EQ((*devices)[0].index, 2U);
  EXPECT_EQ((*devices)[0].report_descriptor, (Bytes{6, 0x0A, 0xFF}));
  EXPECT_EQ((*devices)[1].index, 0U);
}

TEST(DescriptorFile, ARecordingWithoutADescriptorIsAnError) {
  struct Case {
    const char* text;
    const char* format;
  };
  for (const Case& each : {Case{"D: 0\nE: 0.0 1 01\n", "hid-recorder"},
                           Case{"001:006:002:STREAM 1.0\n 01\n\n", "usbhid-dump"},
                           Case{"# EVEMU 1.2\nN: pen\n", "evemu"}}) {
    const auto devices = read(each.text);
    ASSERT_FALSE(devices) << each.text;
    EXPECT_EQ(devices.error().code, ErrorCode::kMissing);
    EXPECT_THAT(devices.error().what, HasSubstr(each.format));
    EXPECT_FALSE(devices.error().remedy.empty());
  }
}

TEST(DescriptorFile, BadTextIsAnErrorWithItsLine) {
  struct Case {
    const char* text;
    const char* at;
    const char* what;
  };
  for (const Case& each :
       {Case{"", "byte 0", "there is no content"},
        Case{"# nothing\n", "", "the text holds no bytes"},
        Case{"05 01\n09 0g\n", "line 2", "\"0g\" is no hexadecimal byte"},
        Case{"05 1\n", "line 1", "\"1\" is no hexadecimal byte"},
        Case{"05 012\n", "line 1", "\"012\" is no hexadecimal byte"},
        Case{"0x\n", "line 1", "is no hexadecimal byte"},
        Case{"0x0501\n", "line 1", "\"0x0501\" is no hexadecimal byte"},
        Case{"05 / 01\n", "line 1", "\"/\" is no hexadecimal byte"},
        Case{"05 +1\n", "line 1", "is no hexadecimal byte"}, Case{"05 /* 01\n", "", "has no end"},
        Case{"t,x,y,p\n0,1,2,0.5\n", "line 1", "\"t\" is no hexadecimal byte"},
        Case{"R: 5 05 01\n", "line 1", "the length says 5 bytes but 2 follow"}}) {
    const auto devices = read(each.text);
    ASSERT_FALSE(devices) << each.text;
    EXPECT_EQ(devices.error().at, each.at) << each.text;
    EXPECT_THAT(devices.error().what, HasSubstr(each.what)) << each.text;
    EXPECT_FALSE(devices.error().remedy.empty()) << each.text;
  }
}

TEST(DescriptorFile, ADescriptorIsLimited) {
  std::string raw(kMaxDescriptorBytes, '\x05');
  EXPECT_EQ(only_descriptor(raw).size(), kMaxDescriptorBytes);
  raw += '\x05';
  const auto longer = read(raw);
  ASSERT_FALSE(longer);
  EXPECT_EQ(longer.error().code, ErrorCode::kLimit);
  EXPECT_EQ(longer.error().at, "byte 65535");

  std::string collections;  // a million of them
  for (int i = 0; i < 1'000'000; ++i) collections += "\xA1\x01";
  EXPECT_EQ(read(collections).error().code, ErrorCode::kLimit);

  std::string text;
  for (std::size_t i = 0; i <= kMaxDescriptorBytes; ++i) text += "a1\n";
  const auto long_text = read(text);
  ASSERT_FALSE(long_text);
  EXPECT_EQ(long_text.error().code, ErrorCode::kLimit);
  EXPECT_EQ(long_text.error().at, "line 65536");

  const auto long_line = read("05 01\n#" + std::string(kMaxLineBytes, 'x') + "\nc0\n");
  ASSERT_FALSE(long_line);
  EXPECT_EQ(long_line.error().at, "line 2");
}

TEST(DescriptorFile, SalvageReadsDamagedRecordings) {
  const std::string text = std::string(100, '\0') + "x\nD: 0\nR: 2 05 01\nE: 0.0 9\n";
  EXPECT_EQ(read(text).error().at, "byte 0");
  TraceOptions options;
  options.salvage = true;
  const auto devices = read(text, options);
  ASSERT_TRUE(devices);
  EXPECT_EQ(devices->at(0).report_descriptor, (Bytes{5, 1}));
}

TEST(DescriptorFile, ReadsAllRealDescriptors) {
  LIMN_NEEDS_RECORDINGS();
  std::size_t files = 0;
  for (const auto& path : recordings("traces/descriptors", ".bin")) {
    const std::string raw = read_file(path);
    const auto devices = read(raw);
    ASSERT_TRUE(devices) << path;
    ASSERT_EQ(devices->size(), 1U) << path;
    EXPECT_EQ(devices->front().report_descriptor, Bytes(raw.begin(), raw.end())) << path;
    ++files;
  }
  EXPECT_GE(files, 413U);
}

TEST(DescriptorFile, ReadsTheDescriptorsThatLieBesideRealDumps) {
  LIMN_NEEDS_RECORDINGS();
  std::size_t devices_read = 0;
  for (const auto& path : recordings("traces/pens-usbhid-dump", ".txt")) {
    const std::string name = path.filename().string();
    const bool is_descriptor = path.parent_path().filename() == "rd" && name != "NOTE.txt";
    if (!is_descriptor && name != "hid_report_descriptors.txt") continue;
    const auto devices = read(read_file(path));
    ASSERT_TRUE(devices) << path << ' ' << at_and_what(devices.error());
    for (const TraceDevice& device : *devices) {
      EXPECT_EQ(device.report_descriptor.back(), 0xC0) << path << ": ends with End Collection";
      ++devices_read;
    }
  }
  EXPECT_GE(devices_read, 27U);
}

TEST(DescriptorFile, AControlByteMakesARecordingNoRawDescriptor) {
  EXPECT_EQ(only_descriptor("N: pen\x01\nR: 3 05 0d c0\n"),
            (std::vector<std::uint8_t>{0x05, 0x0D, 0xC0}));
}

}  // namespace
}  // namespace limn::test
