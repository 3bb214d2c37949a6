// Initialisations done to devices that answer as recorded ones did.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>

#include "drivers/transport/control_request.hpp"
#include "drivers/transport/pen_setup.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/usb_capture.hpp"

namespace limn::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

/// The eight bytes on the wire, which libusb makes of the same fields.
std::array<std::uint8_t, 8> setup_packet(const ControlRequest& request, std::size_t length) {
  const auto low = [](std::size_t value) { return static_cast<std::uint8_t>(value & 0xFF); };
  const auto high = [](std::size_t value) { return static_cast<std::uint8_t>(value >> 8 & 0xFF); };
  return {request.type,       request.request,     low(request.value), high(request.value),
          low(request.index), high(request.index), low(length),        high(length)};
}

/// Answers each control request as the device in a capture did, and keeps what was sent: the setup
/// packets of the requests that UsbInterface gives to libusb.
class CapturedDevice final : public DeviceControl {
 public:
  CapturedDevice(std::vector<UsbControl> controls, std::uint8_t interface_number)
      : controls_(std::move(controls)), interface_(interface_number) {}

  Expected<Bytes> read_string(std::uint8_t index, std::uint16_t language,
                              std::uint16_t length) override {
    return answer(setup_packet(string_request(index, language), length), {});
  }
  Expected<void> write_interrupt(std::uint8_t, std::span<const std::uint8_t>) override {
    ADD_FAILURE() << "no such request was captured";
    return {};
  }
  Expected<void> set_output(std::span<const std::uint8_t>) override {
    ADD_FAILURE() << "no such request was captured";
    return {};
  }
  Expected<void> set_feature(std::span<const std::uint8_t> bytes) override {
    const auto data = report_data(bytes);
    answer(setup_packet(set_feature_request(bytes[0], interface_), data.size()),
           {data.begin(), data.end()});
    return {};
  }
  Expected<Bytes> get_feature(std::uint8_t, std::size_t) override { return Bytes(); }

  /// The requests made, each with the bytes that went out.
  std::vector<std::pair<std::array<std::uint8_t, 8>, Bytes>> sent;

 private:
  Bytes answer(std::array<std::uint8_t, 8> setup, Bytes out) {
    const auto found = std::find_if(controls_.begin(), controls_.end(),
                                    [&](const UsbControl& one) { return one.setup == setup; });
    sent.emplace_back(setup, std::move(out));
    return found == controls_.end() ? Bytes() : found->data;
  }

  std::vector<UsbControl> controls_;
  std::uint8_t interface_;
};

/// What the vendor's driver sent: the requests of `controls` that `wanted` chooses, in order,
/// repetitions left out.
std::vector<std::pair<std::array<std::uint8_t, 8>, Bytes>> sent_by_vendor(
    const std::vector<UsbControl>& controls, const std::function<bool(const UsbControl&)>& wanted) {
  std::vector<std::pair<std::array<std::uint8_t, 8>, Bytes>> out;
  for (const UsbControl& control : controls) {
    const bool to_device = (control.setup[0] & 0x80) == 0;
    const std::pair one(control.setup, to_device ? control.data : Bytes());
    if (wanted(control) && std::find(out.begin(), out.end(), one) == out.end()) out.push_back(one);
  }
  return out;
}

TEST(SetUpPen, SendsWhatHuionsDriverSent) {
  LIMN_NEEDS_RECORDINGS();
  const auto controls =
      read_usb_controls(shared_folder() / "traces/init-captures/huion_q11k.pcapng");
  const PenInitialization* sequence = find_pen_initialization(0x256C, 0x006E);
  CapturedDevice device(controls, sequence->interface_number);
  const PenSetup setup = set_up_pen(*sequence, device);
  EXPECT_FALSE(setup.trouble);
  auto vendor = sent_by_vendor(controls, [](const UsbControl& control) {
    return control.setup[1] == 6 && control.setup[3] == 3 && control.setup[2] >= 200;
  });
  ASSERT_THAT(vendor, SizeIs(3));
  vendor.pop_back();  // string 202, of which limn needs nothing
  EXPECT_THAT(device.sent, SizeIs(2));
  EXPECT_EQ(device.sent, vendor);
  EXPECT_EQ(setup.initializer.firmware(), "HUION_T164_170520");
  ASSERT_NE(setup.initializer.parameters(), nullptr);
  EXPECT_EQ(setup.initializer.parameters()->x_max, 55880);
  ASSERT_THAT(setup.notes, SizeIs(2));
  EXPECT_TRUE(setup.notes[0].starts_with("string 201 24 03 48 00 55 00")) << setup.notes[0];
  EXPECT_TRUE(setup.notes[1].starts_with("string 200 ")) << setup.notes[1];
}

TEST(SetUpPen, SendsWhatKyesDriverSent) {
  LIMN_NEEDS_RECORDINGS();
  const auto controls =
      read_usb_controls(shared_folder() / "traces/init-captures/kye_mousepen_i608x_v1.pcap");
  const PenInitialization* sequence = find_pen_initialization(0x0458, 0x5011);
  CapturedDevice device(controls, sequence->interface_number);
  const PenSetup setup = set_up_pen(*sequence, device);
  EXPECT_FALSE(setup.trouble);
  const auto vendor = sent_by_vendor(controls, [](const UsbControl& control) {
    return control.setup[0] == 0x21 && control.setup[1] == 9;
  });
  EXPECT_THAT(device.sent, SizeIs(1));
  EXPECT_EQ(device.sent, vendor);
  EXPECT_THAT(setup.notes, IsEmpty());
}

/// A device that is there but cannot be asked anything, or answers nothing.
class DeadDevice final : public DeviceControl {
 public:
  explicit DeadDevice(bool refuses) : refuses_(refuses) {}
  Expected<Bytes> read_string(std::uint8_t, std::uint16_t, std::uint16_t) override {
    ++requests;
    if (refuses_) return refusal();
    return Bytes();
  }
  Expected<void> write_interrupt(std::uint8_t, std::span<const std::uint8_t>) override {
    ++requests;
    if (refuses_) return refusal();
    return {};
  }
  Expected<void> set_output(std::span<const std::uint8_t>) override { return refusal(); }
  Expected<void> set_feature(std::span<const std::uint8_t>) override { return refusal(); }
  Expected<Bytes> get_feature(std::uint8_t, std::size_t) override { return refusal(); }

  int requests = 0;

 private:
  static tl::unexpected<Error> refusal() {
    return fail(ErrorCode::kIo, "", "no permission", "install the rules");
  }
  bool refuses_;
};

TEST(SetUpPen, ASilentDeviceIsAskedAllAndNotedAsSilent) {
  DeadDevice device(false);
  const PenSetup setup = set_up_pen(*find_pen_initialization(0x256C, 0x0999), device);
  EXPECT_FALSE(setup.trouble);
  EXPECT_THAT(setup.notes, ElementsAre("string 201", "string 200", "string 100"));
  EXPECT_EQ(setup.initializer.parameters(), nullptr);
}

/// A clock that each look at it moves on.
class HurryingClock final : public WaitingClock {
 public:
  Timestamp now() noexcept override { return time_ += std::chrono::seconds(2); }
  void wait_until(Timestamp) noexcept override {}

 private:
  Timestamp time_{};
};

TEST(SetUpPen, BeginsNoRequestAfterTheLongestTime) {
  DeadDevice device(false);
  HurryingClock clock;
  const PenSetup setup = set_up_pen(*find_pen_initialization(0x256C, 0x0999), device, clock);
  EXPECT_THAT(setup.notes, ElementsAre("string 201"));
  EXPECT_EQ(device.requests, 1);
  ASSERT_TRUE(setup.trouble);
  EXPECT_EQ(setup.trouble->what, "the device answers too slowly to be set up");
}

TEST(SetUpPen, EndsAtTheFirstTrouble) {
  DeadDevice device(true);
  const PenSetup setup = set_up_pen(*find_pen_initialization(0x28BD, 0x0907), device);
  ASSERT_TRUE(setup.trouble);
  EXPECT_EQ(setup.trouble->remedy, "install the rules");
  EXPECT_EQ(device.requests, 1);
  EXPECT_THAT(setup.notes, IsEmpty());
}

}  // namespace
}  // namespace limn::test
