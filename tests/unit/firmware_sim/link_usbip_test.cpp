#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "firmware_sim/link/usbip_server.hpp"
#include "firmware_sim/link/vhci.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/unit/firmware_sim/counting_device.hpp"
#include "tests/unit/firmware_sim/usbip_client.hpp"

namespace limn::firmware {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = UsbipNotice::Kind;

constexpr auto kForever = std::chrono::hours(24);
const Bytes kSetConfiguration = {0x00, 9, 1, 0, 0, 0, 0, 0};

/// A server on TCP, in a thread of its own.
class UsbipTest : public testing::Test {
 protected:
  ~UsbipTest() override { stop(); }

  void start(std::chrono::microseconds end = kForever) {
    const auto listening = server.listen(0);
    ASSERT_TRUE(listening.has_value()) << listening.error().what;
    port = *listening;
    run(end);
  }
  void run(std::chrono::microseconds end = kForever) {
    runner = std::thread([this, end] { result = server.run(end, waiter); });
  }
  LinkResult<LinkEnd> join() {
    if (runner.joinable()) runner.join();
    return result;
  }
  LinkResult<LinkEnd> stop() {
    waiter.stop();
    return join();
  }
  UsbipClient attached() {
    UsbipClient client = UsbipClient::connect(port);
    EXPECT_EQ(client.import("1-1").size(), 320U);
    EXPECT_EQ(client.control_out(kSetConfiguration).status, 0);
    return client;
  }
  /// What was told of a kind. Before the server has ended, it may be less than there is to come.
  std::vector<std::string> told(Kind kind) {
    const std::lock_guard lock(mutex);
    std::vector<std::string> texts;
    for (const UsbipNotice& notice : notices) {
      if (notice.kind == kind) texts.push_back(notice.text);
    }
    return texts;
  }

  CountingDevice device;
  std::mutex mutex;
  std::vector<UsbipNotice> notices;
  std::function<void(const UsbipNotice&)> on_notice;
  UsbipServer server{device, {}, [this](const UsbipNotice& notice) {
                       {
                         const std::lock_guard lock(mutex);
                         notices.push_back(notice);
                       }
                       if (on_notice) on_notice(notice);
                     }};
  Waiter waiter = *Waiter::make();
  std::uint16_t port = 0;
  std::thread runner;
  LinkResult<LinkEnd> result = LinkEnd::kStopped;
};

void expect_device(const Bytes& reply, std::size_t at) {
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(&reply[at + 256])), "1-1");
  EXPECT_EQ(number_at(reply, at + 288, 4), 1U) << "bus";
  EXPECT_EQ(number_at(reply, at + 292, 4), 2U) << "device";
  EXPECT_EQ(number_at(reply, at + 296, 4), 2U) << "full speed";
  EXPECT_EQ(number_at(reply, at + 300, 2), 0x1209U);
  EXPECT_EQ(number_at(reply, at + 302, 2), 0x0002U);
  EXPECT_EQ(number_at(reply, at + 304, 2), 0x0103U);
  EXPECT_THAT(Bytes(reply.begin() + at + 306, reply.begin() + at + 312),
              ElementsAre(0, 0, 0, 1, 1, 2))
      << "classes, configuration, of how many, interfaces";
}

TEST_F(UsbipTest, ListsTheDeviceAndItsInterfaces) {
  start();
  UsbipClient client = UsbipClient::connect(port);
  const Bytes reply = client.list();
  ASSERT_EQ(reply.size(), 12U + 312U + 8U);
  EXPECT_THAT(Bytes(reply.begin(), reply.begin() + 12),
              ElementsAre(0x01, 0x11, 0x00, 0x05, 0, 0, 0, 0, 0, 0, 0, 1));
  expect_device(reply, 12);
  EXPECT_THAT(Bytes(reply.end() - 8, reply.end()), ElementsAre(3, 0, 0, 0, 3, 0, 0, 0));
  EXPECT_TRUE(client.closed());
}

TEST_F(UsbipTest, IsImportedByOneClientAtATime) {
  start();
  UsbipClient first = UsbipClient::connect(port);
  const Bytes reply = first.import("1-1");
  ASSERT_EQ(reply.size(), 8U + 312U) << "no interfaces follow";
  EXPECT_THAT(Bytes(reply.begin(), reply.begin() + 8),
              ElementsAre(0x01, 0x11, 0x00, 0x03, 0, 0, 0, 0));
  expect_device(reply, 8);

  UsbipClient second = UsbipClient::connect(port);
  EXPECT_EQ(number_at(second.import("1-1"), 4, 4), 2U) << "busy";
  EXPECT_TRUE(second.closed());
  UsbipClient third = UsbipClient::connect(port);
  EXPECT_EQ(third.list().size(), 332U) << "others may still look";

  first.close();
  while (told(Kind::kDetached).empty()) std::this_thread::yield();
  UsbipClient fourth = UsbipClient::connect(port);
  EXPECT_EQ(fourth.import("1-1").size(), 320U);
}

TEST_F(UsbipTest, HasNoOtherDevice) {
  start();
  for (const char* busid : {"1-2", "1-11", "", "1-1-and-more-than-thirty-two-byte"}) {
    UsbipClient client = UsbipClient::connect(port);
    const Bytes reply = client.import(std::string_view(busid).substr(0, 32));
    EXPECT_EQ(number_at(reply, 4, 4), 4U) << busid;
    EXPECT_TRUE(client.closed());
  }
}

TEST_F(UsbipTest, AnswersControlRequestsAndCutsThemToWLength) {
  start();
  UsbipClient client = attached();
  const auto whole = client.control_in({0x81, 6, 0x00, 0x22, 0, 0, 0xFF, 0});
  EXPECT_EQ(whole.command, 3U);
  EXPECT_EQ(whole.status, 0);
  EXPECT_THAT(whole.data, ElementsAreArray(kCountingDescriptor));
  const auto device_descriptor = client.control_in({0x80, 6, 0x00, 0x01, 0, 0, 18, 0});
  ASSERT_EQ(device_descriptor.data.size(), 18U);
  EXPECT_EQ(device_descriptor.data[8], 0x09);
  EXPECT_EQ(device_descriptor.data[9], 0x12) << "USB's own numbers stay as USB has them";
  const auto cut = client.control_in({0x80, 6, 0x00, 0x01, 0, 0, 8, 0});
  EXPECT_THAT(cut.data, ElementsAreArray(device_descriptor.data.data(), 8));

  const auto set = client.control_out({0x21, 9, 2, 3, 1, 0, 4, 0}, {2, 0xA, 0xB, 0xC});
  EXPECT_EQ(set.status, 0);
  EXPECT_EQ(set.actual, 4U) << "all were taken, and none come back";
  const auto get = client.control_in({0xA1, 1, 2, 3, 1, 0, 64, 0});
  EXPECT_THAT(get.data, ElementsAre(2, 0xA, 0xB, 0xC));
}

TEST_F(UsbipTest, StallsWhatTheDeviceStalls) {
  start();
  UsbipClient client = attached();
  const auto qualifier = client.control_in({0x80, 6, 0x00, 0x06, 0, 0, 10, 0});
  EXPECT_EQ(qualifier.status, -32);
  EXPECT_EQ(qualifier.actual, 0U);
  EXPECT_EQ(client.control_out({0x21, 9, 9, 3, 0, 0, 1, 0}, {9}).status, -32);
  client.submit_in(7, 5, 8);
  const auto nowhere = client.take_return(true);
  EXPECT_EQ(nowhere.sequence, 7U);
  EXPECT_EQ(nowhere.status, -32);
}

TEST_F(UsbipTest, CompletesOneWaitingTransferAReport) {
  device.function.count = {6, 2};
  start();
  UsbipClient client = attached();
  for (std::uint32_t i = 1; i <= 4; ++i) client.submit_in(i, 1, 8);
  for (std::uint8_t i = 1; i <= 4; ++i) {
    const auto report = client.take_return(true);
    EXPECT_EQ(report.sequence, i);
    EXPECT_EQ(report.status, 0);
    EXPECT_THAT(report.data, ElementsAre(1, i, 0));
  }
  client.submit_in(21, 2, 2);
  EXPECT_THAT(client.take_return(true).data, ElementsAre(1, 1)) << "cut to what the host has";
}

TEST_F(UsbipTest, GivesEveryReportOfAThousandASecond) {
  device.function.count = {0, 1000};
  device.function.period = 1ms;
  start();
  UsbipClient client = attached();
  for (int i = 1; i <= 1000; ++i) {  // one at a time, as Linux's usbhid asks
    client.submit_in(i, 2, 8);
    const auto report = client.take_return(true);
    ASSERT_THAT(report.data, ElementsAre(1, i & 0xFF, i >> 8));
  }
  stop();
  EXPECT_EQ(server.reports(), 1000U);
}

TEST_F(UsbipTest, TakesOutputReports) {
  start();
  UsbipClient client = attached();
  client.submit_out(9, 2, {3, 1, 2});
  const auto sent = client.take_return(false);
  EXPECT_EQ(sent.status, 0);
  EXPECT_EQ(sent.actual, 3U);
  stop();
  EXPECT_THAT(device.function.told, ElementsAre(1, 2, 3, 3, 1, 2));
}

TEST_F(UsbipTest, UnlinksWhatWaits) {
  start();
  UsbipClient client = attached();
  client.submit_in(1, 1, 8);
  client.unlink(2, 1);
  const auto unlinked = client.take_return(false);
  EXPECT_EQ(unlinked.command, 4U);
  EXPECT_EQ(unlinked.sequence, 2U);
  EXPECT_EQ(unlinked.status, -104);
  client.unlink(3, 1);
  EXPECT_EQ(client.take_return(false).status, 0) << "it does not wait any more";
}

TEST_F(UsbipTest, ATransferThatTimesOutWaitsUntilItIsUnlinked) {
  start();
  UsbipClient client = attached();
  client.submit_out(5, 0, {}, {0x40, 0x77, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(client.control_in({0x80, 6, 0x00, 0x01, 0, 0, 8, 0}).data.size(), 8U);
  client.unlink(6, 5);
  EXPECT_EQ(client.take_return(false).status, -104);
}

TEST_F(UsbipTest, PacketsMayComeInPieces) {
  start();
  UsbipClient client = UsbipClient::connect(port);
  Bytes request = {0x01, 0x11, 0x80, 0x03, 0, 0, 0, 0, '1', '-', '1'};
  request.resize(40);
  for (const std::uint8_t byte : request) client.send(Bytes{byte});
  EXPECT_EQ(client.take(320).size(), 320U);
}

struct Malformed {
  const char* name;
  const char* hex;  // after an import
  const char* told;
};
const Malformed kMalformed[] = {
    {"command", "00 00 00 09", "command 0x0009"},
    {"isochronous",
     "00 00 00 01 00 00 00 01 00 01 00 02 00 00 00 01 00 00 00 01 00 00 00 00 00 00 00 08 "
     "00 00 00 00 00 00 00 05 00 00 00 00",
     "isochronous"},
    {"endpoint", "00 00 00 01 00 00 00 01 00 01 00 02 00 00 00 01 00 00 00 10", "endpoint 16"},
    {"direction", "00 00 00 01 00 00 00 01 00 01 00 02 00 00 00 02 00 00 00 01", "direction 2"},
    {"length",
     "00 00 00 01 00 00 00 01 00 01 00 02 00 00 00 01 00 00 00 01 00 00 00 00 7F FF FF FF",
     "2147483647 bytes"},
    {"negative length",
     "00 00 00 01 00 00 00 01 00 01 00 02 00 00 00 00 00 00 00 01 00 00 00 00 FF FF FF FF",
     "4294967295 bytes"},
    {"setup longer than its data",
     "00 00 00 01 00 00 00 01 00 01 00 02 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
     "00 00 00 00 00 00 00 00 00 00 00 00 21 09 02 03 00 00 04 00",
     "says 4 bytes, and 0 follow"},
    {"setup against its direction",
     "00 00 00 01 00 00 00 01 00 01 00 02 00 00 00 01 00 00 00 00 00 00 00 00 00 00 00 04 "
     "00 00 00 00 00 00 00 00 00 00 00 00 21 09 02 03 00 00 04 00",
     "contradicts"},
};

TEST_F(UsbipTest, ClosesAClientThatBreaksTheProtocolAndServesTheNext) {
  start();
  for (const Malformed& packet : kMalformed) {
    UsbipClient client = attached();
    client.send(packet.hex);
    client.send(Bytes(48));  // so that a packet is whole
    EXPECT_TRUE(client.closed()) << packet.name;
  }
  for (const char* hex : {"01 10 80 05 00 00 00 00", "01 11 80 09 00 00 00 00",
                          "47 45 54 20 2F 20 "
                          "48 54 54 50"}) {
    UsbipClient client = UsbipClient::connect(port);
    client.send(hex);
    EXPECT_TRUE(client.closed()) << hex;
  }
  EXPECT_EQ(UsbipClient::connect(port).list().size(), 332U);
  stop();
  const auto refused = told(Kind::kRefused);
  ASSERT_EQ(refused.size(), std::size(kMalformed) + 3);
  for (std::size_t i = 0; i < std::size(kMalformed); ++i) {
    EXPECT_THAT(refused[i], HasSubstr(kMalformed[i].told)) << kMalformed[i].name;
  }
}

TEST_F(UsbipTest, AClientThatLeavesInMidTransferHarmsNobody) {
  start();
  {
    UsbipClient half = UsbipClient::connect(port);
    half.send("01 11 80");
  }
  for (int i = 0; i < 3; ++i) {
    UsbipClient client = UsbipClient::connect(port);
    while (client.import("1-1").size() != 320U) client = UsbipClient::connect(port);
    client.submit_in(1, 1, 8);
    client.send(
        "00 00 00 01 00 00 00 02 00 01 00 02 00 00 00 00 00 00 00 02 00 00 00 00 "
        "00 00 10 00");  // 4096 bytes are to follow
  }
  UsbipClient last = UsbipClient::connect(port);
  EXPECT_EQ(last.list().size(), 332U);
  stop();
  EXPECT_THAT(told(Kind::kRefused), IsEmpty()) << "to leave is no mistake";
}

TEST_F(UsbipTest, ClosesAClientThatFloods) {
  start();
  {
    UsbipClient client = attached();
    for (std::uint32_t i = 0; i <= UsbipSession::kMostWaiting; ++i) client.submit_in(i, 1, 8);
    EXPECT_TRUE(client.closed());
  }
  stop();
  EXPECT_THAT(told(Kind::kRefused), ElementsAre(HasSubstr("more than 1024 transfers")));
}

TEST_F(UsbipTest, WaitsForAClientThatDoesNotRead) {
  start();
  UsbipClient client = attached();
  constexpr std::uint32_t kRequests = 20'000;  // 2.1 MB of answers, more than sockets hold
  std::thread sender([&client] {
    for (std::uint32_t i = 0; i < kRequests; ++i) {
      client.submit_in(i, 0, 255, {0x81, 6, 0x00, 0x22, 0, 0, 0xFF, 0});
    }
  });
  std::this_thread::sleep_for(50ms);
  for (std::uint32_t i = 0; i < kRequests; ++i) {
    const auto answer = client.take_return(true);
    ASSERT_EQ(answer.sequence, i);
    ASSERT_EQ(answer.data.size(), sizeof kCountingDescriptor);
  }
  sender.join();
}

TEST_F(UsbipTest, TakesNoMoreThanSoManyClients) {
  start();
  std::vector<UsbipClient> idle;
  for (std::size_t i = 0; i < UsbipServer::kMostConnections; ++i) {
    idle.push_back(UsbipClient::connect(port));
  }
  UsbipClient last = UsbipClient::connect(port);
  EXPECT_TRUE(last.closed());
  idle.pop_back();
  Bytes reply;
  while (reply.empty()) reply = UsbipClient::connect(port).list();
  EXPECT_EQ(reply.size(), 332U) << "there is room again";
}

TEST_F(UsbipTest, UnpluggingClosesTheConnectionUntilItIsAttachedAgain) {
  device.function.count = {9, 0};
  start();
  {
    UsbipClient client = attached();
    client.submit_in(1, 1, 8);
    client.submit_in(2, 1, 8);
    EXPECT_THAT(client.take_return(true).data, ElementsAre(1, 1, 0));
    EXPECT_THAT(client.take_return(true).data, ElementsAre(1, 2, 0));
    device.pulled = true;
    EXPECT_TRUE(client.closed());
  }
  EXPECT_EQ(number_at(UsbipClient::connect(port).list(), 8, 4), 0U) << "there is none to list";
  EXPECT_EQ(number_at(UsbipClient::connect(port).import("1-1"), 4, 4), 4U);
  device.pulled = false;
  while (told(Kind::kPlugged).empty()) std::this_thread::yield();
  UsbipClient again = attached();
  again.submit_in(1, 1, 8);
  EXPECT_THAT(again.take_return(true).data, ElementsAre(1, 3, 0));
  stop();
  EXPECT_EQ(told(Kind::kUnplugged).size(), 1U);
  EXPECT_EQ(device.function.resets, 2);
}

TEST_F(UsbipTest, ServesAnyConnectedSocket) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
  device.function.count = {1, 0};
  server.adopt(FileDescriptor(ends[1]));
  run();
  UsbipClient client{FileDescriptor(ends[0])};  // has the device from the beginning, as vhci
  EXPECT_EQ(client.control_out(kSetConfiguration).status, 0);
  client.submit_in(1, 1, 8);
  EXPECT_THAT(client.take_return(true).data, ElementsAre(1, 1, 0));
}

TEST_F(UsbipTest, ReplugsAreAttachedAgainFromTheNotice) {
  int again[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, again), 0);
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
  on_notice = [this, &again](const UsbipNotice& notice) {
    if (notice.kind == Kind::kPlugged) server.adopt(FileDescriptor(again[1]));
  };
  device.function.count = {9, 0};
  server.adopt(FileDescriptor(ends[1]));
  run();
  UsbipClient first{FileDescriptor(ends[0])};
  first.control_out(kSetConfiguration);
  first.submit_in(1, 1, 8);
  EXPECT_THAT(first.take_return(true).data, ElementsAre(1, 1, 0));
  device.pulled = true;
  EXPECT_TRUE(first.closed());
  device.pulled = false;
  UsbipClient second{FileDescriptor(again[0])};
  second.control_out(kSetConfiguration);
  second.submit_in(1, 1, 8);
  EXPECT_THAT(second.take_return(true).data, ElementsAre(1, 2, 0));
}

TEST_F(UsbipTest, EndsWithTheMovement) {
  device.function.count = {2, 0};
  start(300ms);
  UsbipClient client = attached();
  client.submit_in(1, 1, 8);
  client.submit_in(2, 1, 8);
  client.submit_in(3, 1, 8);
  client.take_return(true);
  client.take_return(true);
  EXPECT_EQ(*join(), LinkEnd::kTimeUp);
}

TEST_F(UsbipTest, SaysThatAPortIsTaken) {
  start();
  UsbipServer other(device);
  const auto taken = other.listen(port);
  ASSERT_FALSE(taken.has_value());
  EXPECT_EQ(taken.error().what,
            "cannot listen on 127.0.0.1:" + std::to_string(port) + ": the port is taken");
  EXPECT_THAT(taken.error().remedy, HasSubstr("another"));
}

TEST_F(UsbipTest, IsReachedByLoopbackAlone) {
  start();
  FileDescriptor socket(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(0x7F000002);  // 127.0.0.2: this machine, by another name
  EXPECT_NE(::connect(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
}

TEST(Vhci, GetsPortSocketDeviceAndSpeed) {
  const test::TempFolder folder;
  folder.write("attach", "");
  folder.write("detach", "");
  ASSERT_TRUE(attach_to_vhci(5, 3, folder.path()).has_value());
  ASSERT_TRUE(detach_from_vhci(3, folder.path()).has_value());
  EXPECT_EQ(test::read_file(folder.path() / "attach"), "3 5 65538 2");
  EXPECT_EQ(test::read_file(folder.path() / "detach"), "3");
}

TEST(Vhci, SaysWhatToLoadWhereItIsAbsent) {
  const test::TempFolder folder;
  const auto attached = attach_to_vhci(5, 0, folder.path() / "vhci_hcd.0");
  ASSERT_FALSE(attached.has_value());
  EXPECT_THAT(attached.error().what, HasSubstr("vhci_hcd.0/attach: No such file"));
  EXPECT_THAT(attached.error().remedy, HasSubstr("modprobe vhci-hcd"));
}

}  // namespace
}  // namespace limn::firmware
