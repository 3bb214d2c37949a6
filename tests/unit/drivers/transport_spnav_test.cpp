// libspnav against a server that speaks spacenavd's protocol on a socket of the test's own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <thread>

#include "drivers/transport/spnav_transport.hpp"
#include "tests/support/temp_folder.hpp"

namespace limn::test {
namespace {

using Message = std::array<std::int32_t, 8>;

// spacenavd's proto.h
constexpr std::int32_t kTag = 0x7FAA0000;
constexpr std::int32_t kChangeProtocol = 0x5500;
constexpr std::int32_t kDeviceName = 0x2000;
constexpr std::int32_t kDeviceUsbId = 0x2004;

/// spacenavd's end: accepts one client, answers its requests until it has asked for the device's
/// name, and then sends what the test wants. Protocol 0 answers nothing, as before spacenavd 1.0.
class Server {
 public:
  explicit Server(int protocol) {
    path_ = (folder_.path() / "spnav.sock").string();
    listening_ = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path_.c_str(), sizeof address.sun_path - 1);
    if (::bind(listening_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(listening_, 1) != 0) {
      std::abort();
    }
    thread_ = std::thread([this, protocol] { serve(protocol); });
  }
  ~Server() {
    ::shutdown(listening_, SHUT_RDWR);  // where nobody came
    if (thread_.joinable()) thread_.join();
    leave();
    ::close(listening_);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  const std::string& path() const { return path_; }
  void wait_for_client() { thread_.join(); }
  void send(const Message& message) const { write_whole(message.data(), sizeof message); }
  void send_bytes(std::size_t count) const { write_whole(std::string(count, 'x').data(), count); }
  void leave() {
    if (client_ >= 0) ::close(client_);
    client_ = -1;
  }

 private:
  void write_whole(const void* data, std::size_t size) const {
    EXPECT_EQ(::send(client_, data, size, MSG_NOSIGNAL), static_cast<ssize_t>(size));
  }
  void serve(int protocol) {
    client_ = ::accept(listening_, nullptr, nullptr);
    std::int32_t hello = 0;
    EXPECT_EQ(::recv(client_, &hello, sizeof hello, MSG_WAITALL), ssize_t{sizeof hello});
    EXPECT_EQ(hello & ~0xFF, kTag | kChangeProtocol);
    if (protocol == 0) return;
    const std::int32_t answer = kTag | kChangeProtocol | protocol;
    write_whole(&answer, sizeof answer);
    for (Message request{}; request[0] != (kTag | kDeviceName);) {
      if (::recv(client_, request.data(), sizeof request, MSG_WAITALL) <= 0) return;
      Message reply{request[0]};
      if (request[0] == (kTag | kDeviceUsbId)) {
        reply[1] = 0x256F;
        reply[2] = 0xC635;
      } else if (request[0] == (kTag | kDeviceName)) {
        std::memcpy(&reply[1], "SpaceMouse Compact", 19);
        reply[7] = 18;  // bytes left, this packet's included
      }
      send(reply);
    }
  }

  TempFolder folder_;
  std::string path_;
  int listening_ = -1;
  int client_ = -1;
  std::thread thread_;
};

/// Frames as text: "3.0=1 3.1=2".
class TextSink final : public TransportSink {
 public:
  void report(Timestamp, std::span<const std::uint8_t>) noexcept override { ADD_FAILURE(); }
  void frame(Timestamp time, std::span<const EvdevEvent> events) noexcept override {
    std::string text;
    for (const EvdevEvent& event : events) {
      EXPECT_EQ(event.time, time);
      text += (text.empty() ? "" : " ") + std::to_string(event.type) + "." +
              std::to_string(event.code) + "=" + std::to_string(event.value);
    }
    frames.push_back(text);
  }
  void lost(std::uint32_t, bool) noexcept override { ADD_FAILURE(); }
  std::vector<std::string> frames;
};

/// Drains once the descriptor is readable.
Transport::State drain(Transport& transport, TransportSink& sink) {
  pollfd polled{transport.poll_descriptor(), POLLIN, 0};
  EXPECT_EQ(::poll(&polled, 1, 10'000), 1);
  return transport.drain(sink);
}

TEST(OpenSpnav, GivesMotionsAndButtonsAsFrames) {
  Server server(1);
  const auto opened = open_spnav(server.path());
  ASSERT_TRUE(opened.has_value()) << opened.error().what;
  server.wait_for_client();
  Transport& transport = **opened;
  EXPECT_EQ(transport.device().name, "SpaceMouse Compact");
  EXPECT_EQ(transport.device().vendor, 0x256F);
  EXPECT_EQ(transport.device().product, 0xC635);
  ASSERT_EQ(transport.device().axes.size(), 6u);
  EXPECT_EQ(transport.device().axes[5].code, 5);

  TextSink sink;
  server.send({0, 10, -20, 30, -40, 50, -60, 8});
  server.send({1, 2});
  server.send({2, 2});
  server.send({1, -1});
  server.send({1, 0x200});
  server.send({77, 1});  // no event that anybody knows
  server.send({0, 0, 0, 0, 0, 0, 0, 8});
  while (sink.frames.size() < 4) ASSERT_EQ(drain(transport, sink), Transport::State::kOpen);
  EXPECT_THAT(sink.frames,
              testing::ElementsAre("3.0=10 3.1=-20 3.2=30 3.3=-40 3.4=50 3.5=-60", "1.258=1",
                                   "1.258=0", "3.0=0 3.1=0 3.2=0 3.3=0 3.4=0 3.5=0"));
  server.leave();
  EXPECT_EQ(drain(transport, sink), Transport::State::kGone);
}

TEST(OpenSpnav, UnderstandsTheFirstProtocol) {
  Server server(0);
  const auto opened = open_spnav(server.path());
  ASSERT_TRUE(opened.has_value()) << opened.error().what;
  server.wait_for_client();
  EXPECT_EQ((*opened)->device().name, "3D mouse of spacenavd");
  EXPECT_EQ((*opened)->device().vendor, 0);
  TextSink sink;
  server.send({0, 1, 2, 3, 4, 5, 6, 8});
  EXPECT_EQ(drain(**opened, sink), Transport::State::kOpen);
  EXPECT_THAT(sink.frames, testing::ElementsAre("3.0=1 3.1=2 3.2=3 3.3=4 3.4=5 3.5=6"));
}

TEST(OpenSpnav, ATornMessageEndsIt) {
  Server server(1);
  const auto opened = open_spnav(server.path());
  ASSERT_TRUE(opened.has_value()) << opened.error().what;
  server.wait_for_client();
  server.send_bytes(5);
  TextSink sink;
  EXPECT_EQ(drain(**opened, sink), Transport::State::kGone);
}

TEST(OpenSpnav, OneConnectionAtATime) {
  Server server(1);
  {
    const auto first = open_spnav(server.path());
    ASSERT_TRUE(first.has_value()) << first.error().what;
    server.wait_for_client();
    const auto second = open_spnav(server.path());
    ASSERT_FALSE(second.has_value());
    EXPECT_EQ(second.error().what, "a connection to spacenavd is open already");
  }
  Server other(1);
  EXPECT_TRUE(open_spnav(other.path()).has_value()) << "the first one is closed";
}

TEST(OpenSpnav, SaysWhereNobodyAnswers) {
  if (::access("/run/spnav.sock", F_OK) == 0) GTEST_SKIP() << "a spacenavd runs here";
  const auto opened = open_spnav("/nowhere/spnav.sock");
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().what, "spacenavd does not answer");
  EXPECT_EQ(opened.error().at, "/nowhere/spnav.sock");
}

}  // namespace
}  // namespace limn::test
