// Simulated devices against what real ones of the same model answered: strings, descriptors.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>

#include "firmware_sim/devices/catalogue.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/usb_capture.hpp"
#include "tests/unit/firmware_sim/recording_host.hpp"

namespace limn::firmware {
namespace {

using Bytes = std::vector<std::uint8_t>;
using test::ask;
using test::read_file;
using test::shared_folder;
using testing::SizeIs;

Bytes hex_bytes(const std::string& text) {
  Bytes bytes;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
  }
  return bytes;
}

/// The first "KEY INDEX BYTES" lines of a probe: M and P are the text alone, S a whole descriptor.
struct Probe {
  Bytes manufacturer;
  Bytes product;
  std::map<std::uint8_t, Bytes> strings;
};

Probe read_probe(const std::string& folder) {
  Probe probe;
  std::istringstream lines(
      read_file(shared_folder() / "traces/pens-usbhid-dump" / folder / "probe.txt"));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("M ")) probe.manufacturer = hex_bytes(line.substr(2));
    if (line.starts_with("P ")) probe.product = hex_bytes(line.substr(2));
    if (!line.starts_with("S ")) {
      if (probe.strings.empty()) continue;
      break;
    }
    const Bytes bytes = hex_bytes(line.substr(2));
    probe.strings[bytes.at(0)] = Bytes(bytes.begin() + 1, bytes.end());
  }
  return probe;
}

Bytes read_string(BusDevice& bus, std::uint8_t index) {
  return ask(bus, {0x80, 6, static_cast<std::uint16_t>(0x0300 | index), 0x0409, 255});
}

/// The report descriptors of a usbhid-dump, by interface.
std::map<int, Bytes> read_dump(const std::filesystem::path& path) {
  std::map<int, Bytes> descriptors;
  std::istringstream lines(read_file(path));
  int interface = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find(":DESCRIPTOR") != std::string::npos) {
      interface = std::stoi(line.substr(8, 3));
    } else {
      for (const std::uint8_t byte : hex_bytes(line)) descriptors[interface].push_back(byte);
    }
  }
  return descriptors;
}

TEST(ProbedDevices, TheHuionGivesTheStringsOfTheRealOne) {
  LIMN_NEEDS_RECORDINGS();
  const auto device = make_simulated_device("huion-1060", "circle", 1);
  const Probe probe = read_probe("Huion_New_1060_Plus");
  ASSERT_THAT(probe.strings, SizeIs(9));
  for (int index = 10; index < 256; ++index) {
    const auto at = static_cast<std::uint8_t>(index);
    const auto found = probe.strings.find(at);
    EXPECT_EQ(read_string(device->bus(), at),
              found == probe.strings.end() ? Bytes() : found->second)
        << index;
  }
}

TEST(ProbedDevices, TheHuionGivesTheDescriptorsOfTheRealOne) {
  LIMN_NEEDS_RECORDINGS();
  const auto device = make_simulated_device("huion-1060", "circle", 1);
  const auto folder = shared_folder() / "traces/pens-usbhid-dump/Huion_New_1060_Plus/rd";
  for (const std::uint16_t interface : {0, 1}) {
    const Bytes real =
        hex_bytes(read_file(folder / ("original" + std::to_string(interface) + ".txt")));
    EXPECT_EQ(ask(device->bus(), {0x81, 6, 0x2200, interface, 4096}), real);
  }
  // Of lsusb: bcdUSB 1.00, bcdDevice 30.00, manufacturer 5, product 6.
  EXPECT_EQ(ask(device->bus(), {0x80, 6, 0x0100, 0, 18}),
            hex_bytes("12 01 00 01 00 00 00 40 6c 25 6e 00 00 30 05 06 00 01"));
  EXPECT_EQ(
      ask(device->bus(), {0x80, 6, 0x0200, 0, 255}),
      hex_bytes("09 02 3b 00 02 01 00 a0 f0 "
                "09 04 00 00 01 03 01 02 00 09 21 11 01 00 01 22 12 00 07 05 81 03 10 00 02 "
                "09 04 01 00 01 03 01 02 00 09 21 11 01 00 01 22 53 00 07 05 82 03 10 00 02"));
}

TEST(ProbedDevices, TheXpPenGivesTheStringsOfTheRealOne) {
  LIMN_NEEDS_RECORDINGS();
  const auto device = make_simulated_device("xppen", "circle", 1);
  const Probe probe = read_probe("XP-Pen_Deco_01_v2_revb");
  const auto text = [&](std::uint8_t index) {
    const Bytes whole = read_string(device->bus(), index);
    return Bytes(whole.begin() + 2, whole.end());
  };
  EXPECT_EQ(text(1), probe.manufacturer);
  EXPECT_EQ(text(2), probe.product);
  ASSERT_THAT(probe.strings, SizeIs(6));
  for (int index = 3; index < 256; ++index) {
    const auto at = static_cast<std::uint8_t>(index);
    const auto found = probe.strings.find(at);
    EXPECT_EQ(read_string(device->bus(), at),
              found == probe.strings.end() ? Bytes() : found->second)
        << index;
  }
}

TEST(ProbedDevices, TheXpPenGivesTheDescriptorsOfTheRealOne) {
  LIMN_NEEDS_RECORDINGS();
  const auto device = make_simulated_device("xppen", "circle", 1);
  const auto real = read_dump(shared_folder() /
                              "traces/pens-usbhid-dump/XP-Pen_Deco_01_v2_revb/rd/"
                              "hid_report_descriptors_without_uc_logic_probe.txt");
  ASSERT_THAT(real, SizeIs(3));
  for (const auto& [interface, descriptor] : real) {
    EXPECT_EQ(ask(device->bus(), {0x81, 6, 0x2200, static_cast<std::uint16_t>(interface), 4096}),
              descriptor)
        << interface;
  }
  // Of lsusb.
  EXPECT_EQ(ask(device->bus(), {0x80, 6, 0x0100, 0, 18}),
            hex_bytes("12 01 10 01 00 00 00 40 bd 28 05 09 00 00 01 02 00 01"));
  EXPECT_EQ(ask(device->bus(), {0x80, 6, 0x0200, 0, 255}),
            hex_bytes("09 02 5b 00 03 01 00 a0 32 "
                      "09 04 00 00 01 03 01 02 00 09 21 00 01 00 01 22 b1 00 07 05 81 03 08 00 04 "
                      "09 04 01 00 01 03 01 02 00 09 21 00 01 00 01 22 6b 00 07 05 82 03 40 00 03 "
                      "09 04 02 00 02 03 00 00 00 09 21 00 01 00 01 22 24 00 07 05 83 03 0c 00 03 "
                      "07 05 03 03 0a 00 0a"));
}

// All that a host asked a SpaceNavigator while it was plugged in, calibrated and lit.
TEST(ProbedDevices, TheSpaceNavigatorAnswersAsTheCapturedOne) {
  LIMN_NEEDS_RECORDINGS();
  constexpr unsigned kAddress = 12;
  const auto controls = test::read_usb_controls(
      shared_folder() / "traces/3d-mice/SpaceNavigator-Connected-Calibrate.pcapng");
  const auto device = make_simulated_device("spacenavigator", "push", 1);
  BusDevice& bus = device->bus();
  bus.reset();
  int compared = 0;
  for (const test::UsbControl& control : controls) {
    if (control.device != kAddress) continue;
    const auto le16 = [&](std::size_t at) {
      return static_cast<std::uint16_t>(control.setup[at] | control.setup[at + 1] << 8);
    };
    const SetupPacket setup{control.setup[0], control.setup[1], le16(2), le16(4), le16(6)};
    if ((setup.request_type & 0x80) == 0) {
      Bytes data = control.data;
      data.resize(setup.length);
      EXPECT_EQ(bus.control(setup, {}, data).status, TransferStatus::kDone)
          << int{setup.request} << " " << setup.value;
      continue;
    }
    EXPECT_EQ(ask(bus, setup), control.data) << int{setup.request} << " " << setup.value;
    ++compared;
  }
  EXPECT_GE(compared, 7);
}

}  // namespace
}  // namespace limn::firmware
