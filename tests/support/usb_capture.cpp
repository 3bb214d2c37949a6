#include "tests/support/usb_capture.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>

#include "tests/support/recordings.hpp"

namespace limn::test {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// Numbers low byte first; 0 past the end.
std::uint64_t number(Bytes bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) {
    value = value << 8 | (at + i < bytes.size() ? bytes[at + i] : 0U);
  }
  return value;
}

Bytes part(Bytes bytes, std::size_t at, std::size_t size) {
  at = std::min(at, bytes.size());
  return bytes.subspan(at, std::min(size, bytes.size() - at));
}

constexpr unsigned kUsbmon48 = 189;
constexpr unsigned kUsbmon64 = 220;
constexpr unsigned kUsbPcap = 249;

using PacketSink = std::function<void(unsigned link, Bytes packet)>;

void for_each_packet(Bytes file, const PacketSink& sink) {
  constexpr std::uint32_t kPcap = 0xA1B2C3D4;
  constexpr std::uint32_t kSectionHeader = 0x0A0D0D0A;
  if (number(file, 0, 4) == kPcap) {
    const auto link = static_cast<unsigned>(number(file, 20, 4));
    for (std::size_t at = 24; at + 16 <= file.size();) {
      const auto size = static_cast<std::size_t>(number(file, at + 8, 4));
      sink(link, part(file, at + 16, size));
      at += 16 + size;
    }
    return;
  }
  ASSERT_EQ(number(file, 0, 4), kSectionHeader) << "neither pcap nor pcapng";
  constexpr std::uint32_t kInterface = 1;
  constexpr std::uint32_t kEnhancedPacket = 6;
  unsigned link = 0;
  for (std::size_t at = 0; at + 12 <= file.size();) {
    const auto size = static_cast<std::size_t>(number(file, at + 4, 4));
    if (size < 12) return;
    if (number(file, at, 4) == kInterface) link = static_cast<unsigned>(number(file, at + 8, 2));
    if (number(file, at, 4) == kEnhancedPacket) {
      sink(link, part(file, at + 28, static_cast<std::size_t>(number(file, at + 20, 4))));
    }
    at += size;
  }
}

/// One packet, whatever captured it.
struct Packet {
  std::uint64_t request = 0;  ///< ties a completion to its submission
  unsigned device = 0;
  unsigned endpoint = 0;
  bool control = false;
  bool submitted = false;
  Bytes setup;  ///< empty: none here
  Bytes data;
};

constexpr unsigned kControlType = 2;

Packet usbmon(Bytes packet, std::size_t header) {
  Packet out;
  out.request = number(packet, 0, 8);
  out.submitted = number(packet, 8, 1) == 'S';
  out.control = number(packet, 9, 1) == kControlType;
  out.endpoint = static_cast<unsigned>(number(packet, 10, 1));
  out.device = static_cast<unsigned>(number(packet, 11, 1));
  const bool has_setup = out.submitted && number(packet, 14, 1) == 0;
  if (has_setup) out.setup = part(packet, 40, 8);
  out.data = part(packet, header, packet.size());
  return out;
}

Packet usbpcap(Bytes packet) {
  constexpr unsigned kFromDevice = 1;
  constexpr unsigned kSetupStage = 0;
  Packet out;
  out.request = number(packet, 2, 8);
  out.submitted = (number(packet, 16, 1) & kFromDevice) == 0;
  out.device = static_cast<unsigned>(number(packet, 19, 2));
  out.endpoint = static_cast<unsigned>(number(packet, 21, 1));
  out.control = number(packet, 22, 1) == kControlType;
  const Bytes payload = part(packet, static_cast<std::size_t>(number(packet, 0, 2)), packet.size());
  if (out.control && number(packet, 27, 1) == kSetupStage) {
    out.setup = part(payload, 0, 8);
    out.data = part(payload, 8, payload.size());
  } else {
    out.data = payload;
  }
  return out;
}

void for_each_usb_packet(const std::filesystem::path& capture,
                         const std::function<void(const Packet&)>& sink) {
  const std::string text = read_file(capture);
  const std::vector<std::uint8_t> file(text.begin(), text.end());
  for_each_packet(file, [&sink](unsigned link, Bytes packet) {
    if (link == kUsbPcap) {
      sink(usbpcap(packet));
    } else if (link == kUsbmon48 || link == kUsbmon64) {
      sink(usbmon(packet, link == kUsbmon48 ? 48 : 64));
    } else {
      ADD_FAILURE() << "link type " << link;
    }
  });
}

}  // namespace

std::vector<UsbControl> read_usb_controls(const std::filesystem::path& capture) {
  std::vector<UsbControl> controls;
  std::map<std::uint64_t, std::size_t> open;  // by request
  for_each_usb_packet(capture, [&](const Packet& packet) {
    if (!packet.control) return;
    if (packet.setup.size() == 8) {
      UsbControl control;
      control.device = packet.device;
      std::copy(packet.setup.begin(), packet.setup.end(), control.setup.begin());
      control.data.assign(packet.data.begin(), packet.data.end());
      open[packet.request] = controls.size();
      controls.push_back(std::move(control));
    } else if (const auto found = open.find(packet.request);
               found != open.end() && !packet.submitted && !packet.data.empty()) {
      controls[found->second].data.assign(packet.data.begin(), packet.data.end());
    }
  });
  return controls;
}

std::vector<std::vector<std::uint8_t>> read_usb_reports(const std::filesystem::path& capture,
                                                        unsigned device) {
  constexpr unsigned kIn = 0x80;
  std::vector<std::vector<std::uint8_t>> reports;
  for_each_usb_packet(capture, [&](const Packet& packet) {
    const bool report = !packet.control && !packet.submitted && packet.device == device &&
                        (packet.endpoint & kIn) != 0 && !packet.data.empty();
    if (report) reports.emplace_back(packet.data.begin(), packet.data.end());
  });
  return reports;
}

}  // namespace limn::test
