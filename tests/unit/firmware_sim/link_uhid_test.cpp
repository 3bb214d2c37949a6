// UHID with a packet socket in place of /dev/uhid: the same events, at the same borders.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/uhid.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "firmware_sim/link/uhid.hpp"
#include "tests/unit/firmware_sim/counting_device.hpp"

namespace limn::firmware {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

constexpr auto kForever = std::chrono::hours(24);

/// The kernel's end of the files, one an interface, and the link running in a thread of its own.
class UhidLinkTest : public testing::Test {
 protected:
  ~UhidLinkTest() override { stop(); }

  void start(std::chrono::microseconds end = kForever, UhidOptions options = {}) {
    const auto opener = [this]() -> LinkResult<FileDescriptor> {
      int ends[2];
      EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends), 0);
      const timeval patience{20, 0};  // a hang fails instead
      ::setsockopt(ends[0], SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
      kernel.emplace_back(ends[0]);
      return FileDescriptor(ends[1]);
    };
    auto opened = UhidLink::open(device, options, opener);
    ASSERT_TRUE(opened.has_value()) << opened.error().what;
    link.emplace(*std::move(opened));
    runner = std::thread([this, end] { result = link->run(end, waiter); });
  }
  LinkResult<LinkEnd> stop() {
    waiter.stop();
    return join();
  }
  LinkResult<LinkEnd> join() {
    if (runner.joinable()) runner.join();
    return result;
  }

  uhid_event read(std::size_t interface = 0) {
    uhid_event event{};
    const ssize_t got = ::recv(kernel[interface].get(), &event, sizeof event, 0);
    EXPECT_GE(got, 4) << "no event came";
    return event;
  }
  void write(const uhid_event& event, std::size_t interface = 0) {
    EXPECT_EQ(::send(kernel[interface].get(), &event, sizeof event, 0),
              static_cast<ssize_t>(sizeof event));
  }
  void write(__u32 type, std::size_t interface = 0) {
    uhid_event event{};
    event.type = type;
    write(event, interface);
  }
  /// The number in the next report.
  int read_report(std::size_t interface = 0) {
    const uhid_event event = read(interface);
    EXPECT_EQ(event.type, static_cast<__u32>(UHID_INPUT2));
    EXPECT_EQ(event.u.input2.size, 3);
    EXPECT_EQ(event.u.input2.data[0], 1);
    return event.u.input2.data[1] | event.u.input2.data[2] << 8;
  }
  void expect_created(std::size_t interface) {
    const uhid_event event = read(interface);
    ASSERT_EQ(event.type, static_cast<__u32>(UHID_CREATE2));
    const auto& created = event.u.create2;
    EXPECT_STREQ(reinterpret_cast<const char*>(created.name), "limn Counter");
    const std::string phys = reinterpret_cast<const char*>(created.phys);
    EXPECT_THAT(phys, StartsWith("limn/simulated/" + std::to_string(::getpid()) + "."));
    EXPECT_THAT(phys, EndsWith("/input" + std::to_string(interface)));
    if (place.empty()) place = phys.substr(0, phys.rfind('/'));
    EXPECT_THAT(phys, StartsWith(place)) << "it stays where it was";
    EXPECT_STREQ(reinterpret_cast<const char*>(created.uniq), "7");
    EXPECT_EQ(created.bus, 3);
    EXPECT_EQ(created.vendor, 0x1209U);
    EXPECT_EQ(created.product, 0x0002U);
    EXPECT_EQ(created.version, 0x0103U);
    EXPECT_THAT(Bytes(created.rd_data, created.rd_data + created.rd_size),
                ElementsAreArray(kCountingDescriptor));
  }
  void expect_created() {
    expect_created(0);
    expect_created(1);
  }

  CountingDevice device;
  std::vector<FileDescriptor> kernel;
  std::string place;  // of the link, as Linux was told
  std::optional<UhidLink> link;
  Waiter waiter = *Waiter::make();
  std::thread runner;
  LinkResult<LinkEnd> result = LinkEnd::kStopped;
};

TEST_F(UhidLinkTest, CreatesADeviceForEachInterfaceAndDestroysItAtTheEnd) {
  start();
  expect_created();
  EXPECT_EQ(*stop(), LinkEnd::kStopped);
  EXPECT_EQ(read(0).type, static_cast<__u32>(UHID_DESTROY));
  EXPECT_EQ(read(1).type, static_cast<__u32>(UHID_DESTROY));
}

TEST_F(UhidLinkTest, GivesEveryReportToTheOneWhoOpensIt) {
  device.function.count = {500, 0};
  device.function.period = 1ms;
  start(1100ms);
  expect_created();
  write(UHID_START);
  std::this_thread::sleep_for(20ms);  // time stands still until somebody reads
  write(UHID_OPEN);
  for (int i = 1; i <= 500; ++i) ASSERT_EQ(read_report(), i);
  EXPECT_EQ(*join(), LinkEnd::kTimeUp);
  EXPECT_EQ(link->reports(), 500U);
  EXPECT_EQ(read(0).type, static_cast<__u32>(UHID_DESTROY));
}

TEST_F(UhidLinkTest, RunsAtOnceWhereItShould) {
  device.function.count = {0, 3};
  UhidOptions options;
  options.wait_for_reader = false;
  start(20ms, options);
  expect_created();
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(read_report(1), i);
  EXPECT_EQ(*join(), LinkEnd::kTimeUp);
}

TEST_F(UhidLinkTest, AnswersGetReportFromTheDevice) {
  start();
  expect_created();
  uhid_event ask{};
  ask.type = UHID_GET_REPORT;
  ask.u.get_report.id = 77;
  ask.u.get_report.rnum = 2;
  ask.u.get_report.rtype = UHID_FEATURE_REPORT;
  write(ask, 1);
  const uhid_event got = read(1);
  ASSERT_EQ(got.type, static_cast<__u32>(UHID_GET_REPORT_REPLY));
  const auto& reply = got.u.get_report_reply;
  EXPECT_EQ(reply.id, 77U);
  EXPECT_EQ(reply.err, 0);
  EXPECT_THAT(Bytes(reply.data, reply.data + reply.size), ElementsAre(2, 0x11, 0x22, 0x33));

  ask.u.get_report.rnum = 5;
  write(ask, 1);
  const uhid_event stalled = read(1);
  EXPECT_EQ(stalled.u.get_report_reply.err, EIO);
  EXPECT_EQ(stalled.u.get_report_reply.size, 0);
}

TEST_F(UhidLinkTest, BringsSetReportAndOutputToTheDevice) {
  start();
  expect_created();
  uhid_event set{};
  set.type = UHID_SET_REPORT;
  set.u.set_report = {78, 2, UHID_FEATURE_REPORT, 4, {2, 9, 8, 7}};
  write(set);
  uhid_event got = read();
  ASSERT_EQ(got.type, static_cast<__u32>(UHID_SET_REPORT_REPLY));
  EXPECT_EQ(got.u.set_report_reply.id, 78U);
  EXPECT_EQ(got.u.set_report_reply.err, 0);
  set.u.set_report.rnum = 9;
  set.u.set_report.data[0] = 9;
  write(set);
  EXPECT_EQ(read().u.set_report_reply.err, EIO);

  uhid_event output{};
  output.type = UHID_OUTPUT;
  output.u.output.data[0] = 3;
  output.u.output.data[1] = 4;
  output.u.output.data[2] = 5;
  output.u.output.size = 3;
  output.u.output.rtype = UHID_OUTPUT_REPORT;
  write(output, 1);
  set.u.set_report = {79, 2, UHID_FEATURE_REPORT, 70, {2}};  // a wrong length, to be told as it is
  write(set, 1);
  read(1);  // its answer: so the output is with the device, too
  stop();
  EXPECT_THAT(device.function.feature, ElementsAre(2, 9, 8, 7));
  EXPECT_EQ(device.function.told.size(), 3U + 70U);
}

TEST_F(UhidLinkTest, TakesOffTheZeroThatStandsForNoReportId) {
  start();
  expect_created();
  uhid_event set{};
  set.type = UHID_SET_REPORT;
  set.u.set_report = {1, 0, UHID_OUTPUT_REPORT, 3, {0, 6, 7}};
  write(set);
  EXPECT_EQ(read().u.set_report_reply.err, 0);
  stop();
  EXPECT_THAT(device.function.told, ElementsAre(0, 2, 0, 6, 7));
}

TEST_F(UhidLinkTest, DestroysAndCreatesAgainWhereTheDeviceGoesAndComesBack) {
  device.function.count = {6, 0};
  device.gone = 12ms;
  device.back = 20ms;
  start(60ms);
  expect_created();
  write(UHID_OPEN);
  EXPECT_EQ(read_report(), 1);
  EXPECT_EQ(read_report(), 2);
  EXPECT_EQ(read(0).type, static_cast<__u32>(UHID_DESTROY));
  EXPECT_EQ(read(1).type, static_cast<__u32>(UHID_DESTROY));
  write(UHID_CLOSE);
  write(UHID_STOP);
  expect_created();
  for (int i = 3; i <= 6; ++i) EXPECT_EQ(read_report(), i);
  EXPECT_EQ(*join(), LinkEnd::kTimeUp);
  EXPECT_EQ(device.function.resets, 2);
}

TEST_F(UhidLinkTest, EndsWithAnErrorWhereLinuxClosesTheFile) {
  start();
  expect_created();
  kernel.clear();
  const auto ended = join();
  ASSERT_FALSE(ended.has_value());
  EXPECT_FALSE(ended.error().what.empty());
  EXPECT_FALSE(ended.error().remedy.empty());
}

TEST(UhidOpen, SaysWhatToLoadOrRunWhereItCannotBeOpened) {
  const auto opened = open_uhid();
  if (opened) GTEST_SKIP() << "/dev/uhid can be opened on this machine";
  EXPECT_THAT(opened.error().what, HasSubstr("cannot open /dev/uhid: "));
  const bool absent = ::access("/dev/uhid", F_OK) != 0;
  EXPECT_THAT(opened.error().remedy, HasSubstr(absent ? "modprobe uhid" : "root"));
}

TEST(UhidOpen, RefusesADescriptorThatUhidCannotHold) {
  class Huge final : public UsbFunction {
   public:
    Huge() { spec_.interfaces = std::span(&interface_, 1); }
    const DeviceSpec& spec() const noexcept override { return spec_; }
    void reset() noexcept override {}
    std::size_t next_report(std::uint8_t, std::chrono::microseconds,
                            std::span<std::uint8_t>) noexcept override {
      return 0;
    }

   private:
    Bytes descriptor_ = Bytes(4097, 0);
    InterfaceSpec interface_{descriptor_, 0, 0, kCountingEndpoints};
    DeviceSpec spec_;
  };
  Huge function;
  UsbDevice device(function);
  const auto opened = UhidLink::open(device, {}, []() -> LinkResult<FileDescriptor> {
    ADD_FAILURE() << "nothing is to be opened";
    return FileDescriptor();
  });
  ASSERT_FALSE(opened.has_value());
  EXPECT_THAT(opened.error().what, HasSubstr("4097"));
}

}  // namespace
}  // namespace limn::firmware
