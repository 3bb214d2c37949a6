#include "tests/unit/firmware_sim/recording_host.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "drivers/transport/pen_setup.hpp"
#include "input/trace/hid_recorder_writer.hpp"

namespace limn::test {

using firmware::BusDevice;
using firmware::SetupPacket;
using firmware::TransferStatus;
using Bytes = std::vector<std::uint8_t>;

Bytes ask(BusDevice& bus, const SetupPacket& setup, std::chrono::microseconds now) {
  Bytes data(setup.length);
  const auto result = bus.control(setup, now, data);
  data.resize(result.status == TransferStatus::kDone ? std::min(result.bytes, data.size()) : 0);
  return data;
}

/// What limn's initialisation asks, as control requests and interrupt transfers.
class RecordingHost::Control final : public DeviceControl {
 public:
  Control(BusDevice& bus, std::uint8_t interface, std::chrono::microseconds now)
      : bus_(bus), interface_(interface), now_(now) {}

  Expected<Bytes> read_string(std::uint8_t index, std::uint16_t language,
                              std::uint16_t length) override {
    return ask(bus_, {0x80, 6, static_cast<std::uint16_t>(0x0300 | index), language, length}, now_);
  }
  Expected<void> write_interrupt(std::uint8_t endpoint,
                                 std::span<const std::uint8_t> bytes) override {
    return done(bus_.interrupt_out(endpoint, now_, bytes).status);
  }
  Expected<void> set_output(std::span<const std::uint8_t> bytes) override {
    return set_report(0x0200, bytes);
  }
  Expected<void> set_feature(std::span<const std::uint8_t> bytes) override {
    return set_report(0x0300, bytes);
  }
  Expected<Bytes> get_feature(std::uint8_t id, std::size_t length) override {
    const auto value = static_cast<std::uint16_t>(0x0300 | id);
    return ask(bus_, {0xA1, 1, value, interface_, static_cast<std::uint16_t>(length)}, now_);
  }

 private:
  Expected<void> set_report(unsigned kind, std::span<const std::uint8_t> bytes) {
    Bytes data(bytes.begin(), bytes.end());
    const auto value = static_cast<std::uint16_t>(kind | (data.empty() ? 0U : data[0]));
    const auto length = static_cast<std::uint16_t>(data.size());
    return done(bus_.control({0x21, 9, value, interface_, length}, now_, data).status);
  }
  static Expected<void> done(TransferStatus status) {
    if (status == TransferStatus::kDone) return {};
    return fail(ErrorCode::kIo, "simulated device", "the request was refused", "");
  }

  BusDevice& bus_;
  std::uint8_t interface_;
  std::chrono::microseconds now_;
};

void RecordingHost::run(std::chrono::microseconds until) {
  for (; now_ <= until; now_ += std::chrono::milliseconds(1)) {
    const bool plugged = bus_.plugged(now_);
    if (plugged_ && !plugged) {
      HidRecorderWriter writer(sink_);
      for (std::size_t i = 0; i < descriptors_.size(); ++i) {
        EXPECT_TRUE(writer.note("gone", static_cast<DeviceIndex>(i)));
      }
    }
    if (!plugged_ && plugged) enumerate();
    plugged_ = plugged;
    if (plugged_) poll();
  }
}

Bytes RecordingHost::read_report_descriptor(std::uint16_t interface) {
  return ask(bus_, {0x81, 6, 0x2200, interface, 4096}, now_);
}

void RecordingHost::enumerate() {
  ++plugged_in_;
  bus_.reset();
  const firmware::DeviceSpec& spec = bus_.spec();
  ask(bus_, {0x80, 6, 0x0100, 0, 18}, now_);
  ask(bus_, {0x80, 6, 0x0200, 0, 255}, now_);
  ask(bus_, {0x00, 9, 1, 0, 0}, now_);
  HidRecorderWriter writer(sink_);
  descriptors_.clear();
  for (std::size_t i = 0; i < spec.interfaces.size(); ++i) {
    const auto interface = static_cast<std::uint16_t>(i);
    ask(bus_, {0x21, 10, 0, interface, 0}, now_);
    descriptors_.push_back(read_report_descriptor(interface));
    TraceDevice device;
    device.index = interface;
    device.name = spec.product_name;
    device.bus = static_cast<std::uint16_t>(spec.bus);
    device.vendor = spec.vendor;
    device.product = spec.product;
    device.version = spec.version;
    device.report_descriptor = descriptors_.back();
    EXPECT_TRUE(writer.describe(device));
  }
  set_up();
}

void RecordingHost::set_up() {
  constexpr std::uint16_t kWacom = 0x056A;
  const firmware::DeviceSpec& spec = bus_.spec();
  if (spec.vendor == kWacom) {  // what the kernel's driver does for all of them
    Control control(bus_, 0, now_);
    const Bytes pen_mode = {2, 2};
    (void)control.set_feature(pen_mode);
  }
  const PenInitialization* sequence = find_pen_initialization(spec.vendor, spec.product);
  if (sequence == nullptr) return;
  Control control(bus_, sequence->interface_number, now_);
  const PenSetup setup = set_up_pen(*sequence, control);
  HidRecorderWriter writer(sink_);
  for (const std::string& note : setup.notes) {
    EXPECT_TRUE(writer.note(note, sequence->interface_number));
  }
}

void RecordingHost::poll() {
  constexpr int kMostAtOnce = 4096;  // of a flood
  HidRecorderWriter writer(sink_);
  const auto& interfaces = bus_.spec().interfaces;
  Bytes room(1024);
  for (std::size_t i = 0; i < interfaces.size(); ++i) {
    for (const firmware::EndpointSpec& endpoint : interfaces[i].endpoints) {
      if ((endpoint.address & 0x80) == 0) continue;
      for (int left = kMostAtOnce; left > 0; --left) {
        const auto result = bus_.interrupt_in(endpoint.address, now_, room);
        if (result.status == TransferStatus::kStall) {
          ++stalls_;
          ask(bus_, {0x02, 1, 0, endpoint.address, 0}, now_);
        }
        if (result.status != TransferStatus::kDone) break;
        const Bytes bytes(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(result.bytes));
        reports_.push_back({static_cast<std::uint8_t>(i), now_, bytes});
        EXPECT_TRUE(writer.write(Report{static_cast<DeviceIndex>(i), now_, bytes}));
      }
    }
  }
}

}  // namespace limn::test
