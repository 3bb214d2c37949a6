// What is asked of a device beside its stream, where no device is needed for that.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "drivers/transport/control_request.hpp"
#include "drivers/transport/file_handle.hpp"
#include "drivers/transport/hidraw_control.hpp"
#include "drivers/transport/hidraw_transport.hpp"
#include "drivers/transport/live_reader.hpp"
#include "drivers/transport/usb_control.hpp"
#include "tests/support/temp_folder.hpp"

namespace limn::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using testing::ElementsAre;

constexpr std::array<std::uint8_t, 2> kLightOn = {4, 1};

/// Keeps what it is told as a wire would carry it.
class KeptRequests final : public UsbControl {
 public:
  explicit KeptRequests(std::uint8_t number) : UsbControl(number) {}
  Expected<void> write_interrupt(std::uint8_t, std::span<const std::uint8_t>) override {
    return {};
  }
  ControlRequest request;
  Bytes data;

 private:
  Expected<Bytes> read(const ControlRequest& asked, std::uint16_t length,
                       UsbDevice::Silence) override {
    request = asked;
    return Bytes(length, 9);
  }
  Expected<void> write(const ControlRequest& told, std::span<const std::uint8_t> bytes) override {
    request = told;
    data.assign(bytes.begin(), bytes.end());
    return {};
  }
};

// HID 1.11, 7.2.2: wValue has the report's type (2: output, 3: feature) high and its ID low.
TEST(UsbControl, SendsReportsByTheirTypeAndId) {
  KeptRequests control(1);
  EXPECT_TRUE(control.set_output(kLightOn));
  EXPECT_EQ(control.request.type, 0x21);
  EXPECT_EQ(control.request.request, 9);
  EXPECT_EQ(control.request.value, 0x0204);
  EXPECT_EQ(control.request.index, 1);
  EXPECT_THAT(control.data, ElementsAre(4, 1));
  EXPECT_TRUE(control.set_feature(Bytes{7, 0}));
  EXPECT_EQ(control.request.value, 0x0307);
  EXPECT_THAT(control.data, ElementsAre(7, 0));
}

TEST(UsbControl, AnIdOfZeroDoesNotTravel) {
  KeptRequests control(0);
  EXPECT_TRUE(control.set_output(Bytes{0, 1, 2}));
  EXPECT_EQ(control.request.value, 0x0200);
  EXPECT_THAT(control.data, ElementsAre(1, 2));
  EXPECT_THAT(*control.get_feature(0, 3), ElementsAre(0, 9, 9)) << "three with the ID";
  EXPECT_EQ(control.request.value, 0x0300);
  EXPECT_THAT(*control.get_feature(5, 2), ElementsAre(9, 9)) << "the device sends it itself";
}

TEST(HidrawControl, WritesOutputReportsToTheNode) {
  const TempFolder folder;
  const std::string node = (folder.path() / "node").string();
  ASSERT_EQ(::mkfifo(node.c_str(), 0600), 0);
  const FileHandle far_end(::open(node.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  const auto control = open_hidraw_control(node);
  ASSERT_TRUE(control) << control.error().what;
  EXPECT_TRUE((*control)->set_output(kLightOn));
  std::array<std::uint8_t, 8> taken{};
  ASSERT_EQ(::read(far_end.get(), taken.data(), taken.size()), 2);
  EXPECT_EQ(taken[0], 4);
  EXPECT_EQ(taken[1], 1);
}

/// A device that only streams, and its far end.
std::unique_ptr<Transport> socket_device(FileHandle& far_end) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) != 0) std::abort();
  far_end = FileHandle(ends[0]);
  TraceDevice device;
  device.name = "A Mouse";
  return open_messages(ends[1], std::move(device));
}

TEST(OpenControl, ATransportThatOnlyStreamsSaysWhatElseToRead) {
  FileHandle far_end;
  const auto control = socket_device(far_end)->open_control();
  ASSERT_FALSE(control);
  EXPECT_EQ(control.error().code, ErrorCode::kMissing);
  EXPECT_EQ(control.error().at, "A Mouse");
  EXPECT_EQ(control.error().remedy, "read it by hidraw or USB");
}

/// Streams nothing, but can be told things.
class ToldTransport final : public Transport {
 public:
  ToldTransport(std::unique_ptr<Transport> stream, int* told)
      : stream_(std::move(stream)), told_(told) {}
  const TraceDevice& device() const noexcept override { return stream_->device(); }
  int poll_descriptor() const noexcept override { return stream_->poll_descriptor(); }
  State drain(TransportSink& sink) noexcept override { return stream_->drain(sink); }
  Expected<std::unique_ptr<DeviceControl>> open_control() const override {
    ++*told_;
    return std::make_unique<KeptRequests>(0);
  }

 private:
  std::unique_ptr<Transport> stream_;
  int* told_;
};

TEST(LiveReader, OpensTheControlOfADeviceWhileItIsThere) {
  FileHandle far_end;
  int opened = 0;
  std::vector<std::unique_ptr<Transport>> devices;
  devices.push_back(std::make_unique<ToldTransport>(socket_device(far_end), &opened));
  const auto reader = *LiveReader::start(std::move(devices));
  const auto control = reader->open_control(0);
  ASSERT_TRUE(control);
  EXPECT_TRUE((*control)->set_output(kLightOn));
  EXPECT_EQ(opened, 1);
  EXPECT_EQ(reader->open_control(1).error().code, ErrorCode::kMissing) << "no such device";

  far_end = FileHandle();
  for (;;) {
    const auto event = *reader->next();
    const auto* note = std::get_if<TraceNote>(&event);
    if (note != nullptr && note->text == "gone") break;
  }
  const auto away = reader->open_control(0);
  ASSERT_FALSE(away);
  EXPECT_EQ(away.error().code, ErrorCode::kMissing);
  EXPECT_EQ(away.error().remedy, "plug it in");
  EXPECT_EQ(opened, 1);
}

}  // namespace
}  // namespace limn::test
