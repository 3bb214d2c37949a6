#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "input/trace_import/trace_import.hpp"
#include "tests/unit/input/capture_bytes.hpp"
#include "tests/unit/input/trace_reading.hpp"

namespace limn::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = CaptureFile::Kind;
using namespace std::string_literals;

#define LIMN_NEEDS_LIBPCAP() \
  if (!has_usb_captures()) GTEST_SKIP() << "this limn was built without libpcap"

/// How packets of a link type are made.
struct Link {
  Kind kind;
  int type;
  bool big_endian;
};

std::string packet(const Link& link, const Transfer& transfer) {
  if (link.type == 249) return usbpcap_packet(transfer);
  return usbmon_packet(transfer, link.type == 189 ? 48 : 64, link.big_endian);
}

std::string get_descriptor(int type, int index, int interface = -1) {
  std::string setup = "\x80\x06\x00\x00\x00\x00\xff\x00"s;
  setup[2] = static_cast<char>(index);
  setup[3] = static_cast<char>(type);
  if (interface >= 0) {
    setup[0] = '\x81';
    setup[4] = static_cast<char>(interface);
  }
  return setup;
}

const std::string kDevice =
    "\x12\x01\x00\x02\x00\x00\x00\x08\x6c\x25\x6e\x00\x34\x12\x00\x02\x00\x01"s;
/// Two interfaces: 0 is no HID, 1 is, with endpoint 0x82 and a descriptor of 3 bytes.
const std::string kConfiguration =
    "\x09\x02\x32\x00\x02\x01\x00\xa0\x32"
    "\x09\x04\x00\x00\x01\xff\x00\x00\x00"
    "\x07\x05\x81\x03\x08\x00\x01"
    "\x09\x04\x01\x00\x01\x03\x00\x00\x00"
    "\x09\x21\x11\x01\x00\x01\x22\x03\x00"
    "\x07\x05\x82\x03\x08\x00\x01"s;
const std::string kReport = "\x05\x0d\xc0"s;

class Capture {
 public:
  explicit Capture(Link link) : link_(link), file_(link.kind, link.type, link.big_endian) {}
  Capture& answer(const std::string& setup, const std::string& data, bool failed = false) {
    ++request_;
    add({.kind = 2, .completed = false, .endpoint = 0x80, .request = request_, .setup = setup});
    return add({.kind = 2, .endpoint = 0x80, .request = request_, .data = data, .failed = failed});
  }
  Capture& report(int endpoint, const std::string& data, int device = 5) {
    return add({.device = device, .endpoint = endpoint, .data = data});
  }
  Capture& add(const Transfer& transfer, std::size_t left_out = 0) {
    file_.packet(packet(link_, transfer), left_out);
    return *this;
  }
  Capture& enumerate() {
    answer(get_descriptor(1, 0), kDevice.substr(0, 8));
    answer(get_descriptor(1, 0), kDevice);
    answer(get_descriptor(2, 0), kConfiguration.substr(0, 9));
    answer(get_descriptor(2, 0), kConfiguration);
    answer(get_descriptor(3, 2), "\x0a\x03P\0e\0n\0\xe9\0"s);
    return answer(get_descriptor(0x22, 0, 1), kReport);
  }
  const std::string& str() const { return file_.str(); }

 private:
  Link link_;
  CaptureFile file_;
  int request_ = 100;
};

constexpr Link kUsbmon{Kind::kPcap, 220, false};

Reading read(const std::string& bytes, TraceOptions options = {}) {
  return read_whole(open_import(memory_bytes(bytes), std::move(options)));
}

Reading salvage(const std::string& bytes) {
  TraceOptions options;
  options.salvage = true;
  return read(bytes, options);
}

class UsbCaptureLinks : public testing::TestWithParam<Link> {};

TEST_P(UsbCaptureLinks, GivesDevicesStringsAndReports) {
  LIMN_NEEDS_LIBPCAP();
  Capture capture(GetParam());
  capture.enumerate().answer(get_descriptor(3, 200), "\x04\x03\x68\x42"s);
  capture.answer(get_descriptor(3, 123), "", true);
  capture.report(0x81, "no HID").report(0x82, "\x01\x02"s).report(0x82, "\x03"s);
  const Reading reading = read(capture.str());
  EXPECT_EQ(reading.format, TraceFormat::kUsbCapture);
  EXPECT_EQ(reading.order, "dnnrr.") << reading.error.what;
  ASSERT_EQ(reading.devices.size(), 1U);
  const TraceDevice& device = reading.devices[0];
  EXPECT_EQ(device.index, 1U) << "the interface's number";
  EXPECT_EQ(device.bus, 3);
  EXPECT_EQ(device.vendor, 0x256C);
  EXPECT_EQ(device.product, 0x006E);
  EXPECT_EQ(device.version, 0x1234);
  EXPECT_EQ(device.name, "Pen\xC3\xA9");
  EXPECT_EQ(device.physical_path, "usb-1.5/input1");
  EXPECT_EQ(std::string(device.report_descriptor.begin(), device.report_descriptor.end()), kReport);
  EXPECT_THAT(reading.notes, ElementsAre("string 200 04 03 68 42", "string 123"));
  ASSERT_EQ(reading.reports.size(), 2U);
  EXPECT_EQ(reading.reports[0], (ReadReport{1, 17'000'000, {0x01, 0x02}}));
  EXPECT_EQ(reading.reports[1], (ReadReport{1, 18'000'000, {0x03}}));
  EXPECT_EQ(reading.places.back(), "packet 19");
}

INSTANTIATE_TEST_SUITE_P(
    All, UsbCaptureLinks,
    testing::Values(Link{Kind::kPcap, 189, false}, Link{Kind::kPcap, 189, true},
                    Link{Kind::kPcap, 220, false}, Link{Kind::kPcap, 220, true},
                    Link{Kind::kPcap, 249, false}, Link{Kind::kPcap, 249, true},
                    Link{Kind::kPcapng, 189, false}, Link{Kind::kPcapng, 189, true},
                    Link{Kind::kPcapng, 220, false}, Link{Kind::kPcapng, 220, true},
                    Link{Kind::kPcapng, 249, false}, Link{Kind::kPcapng, 249, true}));

TEST(UsbCaptureReader, WhatIsNotInTheCaptureMayBeSupplied) {
  LIMN_NEEDS_LIBPCAP();
  TraceOptions options;
  options.supplied = {{0x05, 0x0D, 0xC0}, 0x28BD, 0x0905};
  const Reading reading =
      read(Capture(kUsbmon).report(0x83, "a").report(0x83, "b", 6).str(), options);
  EXPECT_EQ(reading.order, "drdr.");
  EXPECT_EQ(reading.devices[0].index, 128U + 3U) << "the endpoint's interface is not known";
  EXPECT_EQ(reading.devices[1].index, 256U + 128U + 3U);
  EXPECT_EQ(reading.devices[0].vendor, 0x28BD);
  EXPECT_EQ(reading.devices[0].report_descriptor.size(), 3U);
}

TEST(UsbCaptureReader, ADeviceThatNeverReportsIsDescribed) {
  LIMN_NEEDS_LIBPCAP();
  EXPECT_EQ(read(Capture(kUsbmon).enumerate().str()).order, "d.");
}

TEST(UsbCaptureReader, WhatIsLearntAfterAReportIsDescribedAnew) {
  LIMN_NEEDS_LIBPCAP();
  Capture capture(kUsbmon);
  capture.enumerate().report(0x82, "a").answer(get_descriptor(3, 200), "\x04\x03\x68\x42"s);
  capture.answer(get_descriptor(3, 200), "\x04\x03\x68\x42"s);
  EXPECT_EQ(read(capture.report(0x82, "b").report(0x82, "c").str()).order, "drdnrr.");
}

TEST(UsbCaptureReader, HubsAndFailedTransfersGiveNoReports) {
  LIMN_NEEDS_LIBPCAP();
  std::string hub = kDevice;
  hub[4] = 9;
  Capture capture(kUsbmon);
  capture.answer(get_descriptor(1, 0), hub).report(0x81, "\x04"s);
  capture.add({.device = 7, .data = "x", .failed = true});
  capture.add({.completed = false, .device = 7});
  EXPECT_EQ(read(capture.str()).order, ".");
}

TEST(UsbCaptureReader, ACutPacketIsDamage) {
  LIMN_NEEDS_LIBPCAP();
  Capture capture(kUsbmon);
  capture.enumerate().report(0x82, "whole").add({.endpoint = 0x82, .data = "cut short"}, 5);
  capture.report(0x82, "whole");
  const Reading strict = read(capture.str());
  EXPECT_EQ(strict.order, "dr!");
  EXPECT_EQ(at_and_what(strict.error), "packet 14: the packet holds 4 of the report's 9 bytes");
  EXPECT_THAT(strict.error.remedy, HasSubstr("snapshot length"));
  EXPECT_EQ(salvage(capture.str()).order, "drxr.");
}

TEST(UsbCaptureReader, APacketShorterThanItsHeaderIsDamage) {
  LIMN_NEEDS_LIBPCAP();
  for (const int link : {189, 220, 249}) {
    CaptureFile file(Kind::kPcap, link);
    file.packet("short").packet(packet({Kind::kPcap, link, false}, {.data = "whole"}));
    const Reading strict = read(file.str());
    EXPECT_EQ(strict.order, "!");
    EXPECT_EQ(strict.error.at, "packet 1");
    EXPECT_THAT(strict.error.what, HasSubstr("fewer than the"));
    EXPECT_EQ(salvage(file.str()).order, "xdr.");
  }
}

TEST(UsbCaptureReader, ATornFileEndsAfterItsWholePackets) {
  LIMN_NEEDS_LIBPCAP();
  for (const Kind kind : {Kind::kPcap, Kind::kPcapng}) {
    const std::string whole = Capture({kind, 220, false}).report(0x81, "a").report(0x81, "b").str();
    const std::string torn = whole.substr(0, whole.size() - 3);
    const Reading strict = read(torn);
    EXPECT_EQ(strict.order, "dr!");
    EXPECT_EQ(strict.error.at, "packet 2");
    EXPECT_THAT(strict.error.what, HasSubstr("truncated"));
    EXPECT_EQ(salvage(torn).order, "drx.");
  }
}

TEST(UsbCaptureReader, AnotherLinkTypeIsAnError) {
  LIMN_NEEDS_LIBPCAP();
  const Reading reading = read(CaptureFile(Kind::kPcap, 1).packet("ethernet").str());
  EXPECT_EQ(reading.order, "!");
  EXPECT_EQ(reading.error.code, ErrorCode::kUnknown);
  EXPECT_THAT(reading.error.what, HasSubstr("link type 1 (EN10MB)"));
  EXPECT_THAT(reading.error.remedy, HasSubstr("USBPcap"));
}

TEST(UsbCaptureReader, WithoutLibpcapItSaysSo) {
  if (has_usb_captures()) GTEST_SKIP() << "this limn was built with libpcap";
  const Reading reading = read(CaptureFile(Kind::kPcap, 220).str());
  EXPECT_EQ(reading.error.code, ErrorCode::kMissing);
  EXPECT_THAT(reading.error.remedy, HasSubstr("libpcap-dev"));
}

}  // namespace
}  // namespace limn::test
