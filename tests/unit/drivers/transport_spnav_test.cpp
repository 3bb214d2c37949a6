// libspnav against a server that speaks spacenavd's protocol on a socket of the test's own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include "drivers/transport/spnav_transport.hpp"
#include "tests/support/spacenavd_server.hpp"

namespace limn::test {
namespace {

using Server = SpacenavdServer;

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
