// The server before libspnav itself, and before clients of the test's own.

#include "drivers/spnav_server/spnav_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <list>
#include <string>
#include <thread>

#include "tests/support/temp_folder.hpp"

#define SPNAV_CONFIG_H_
#include <spnav.h>

namespace limn::test {
namespace {

using namespace std::chrono_literals;

SpnavMotion motion_of(std::int32_t x) { return {{x, 2, 3, 4, 5, 6}, 8}; }

/// Whether it comes true within ten seconds.
bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 10'000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

class SpnavServerTest : public testing::Test {
 protected:
  SpnavServerTest() { ::setenv("SPNAV_SOCKET", path_.c_str(), 1); }
  ~SpnavServerTest() override {
    spnav_close();
    ::unsetenv("SPNAV_SOCKET");
  }

  void listen() {
    auto listening = SpnavServer::listen({path_});
    ASSERT_TRUE(listening) << listening.error().what;
    server_ = *std::move(listening);
  }

  /// The next event for libspnav's client; type 0 where none comes.
  static spnav_event next() {
    spnav_event event{};
    pollfd polled{spnav_fd(), POLLIN, 0};
    if (::poll(&polled, 1, 10'000) == 1) spnav_poll_event(&event);
    return event;
  }

  TempFolder folder_;
  std::string path_ = (folder_.path() / "spnav.sock").string();
  std::unique_ptr<SpnavServer> server_;
};

/// A client that reads when the test says so.
class RawClient {
 public:
  explicit RawClient(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~RawClient() { ::close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  void write(std::string_view bytes) const {
    ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  /// The next event, or type -1 at the end.
  std::array<std::int32_t, 8> read() const {
    std::array<std::int32_t, 8> words{};
    const ssize_t size = ::recv(socket_, words.data(), sizeof words, MSG_WAITALL);
    if (size != static_cast<ssize_t>(sizeof words)) words[0] = -1;
    return words;
  }
  bool is_ended() const {
    pollfd polled{socket_, POLLIN, 0};
    char byte = 0;
    return ::poll(&polled, 1, 10'000) == 1 && ::recv(socket_, &byte, 1, MSG_DONTWAIT) <= 0;
  }

 private:
  int socket_;
};

TEST_F(SpnavServerTest, GivesLibspnavMotionsAndButtons) {
  listen();
  ASSERT_EQ(spnav_open(), 0);
  EXPECT_EQ(spnav_protocol(), 1);
  ASSERT_TRUE(server_->wait_for_client(10s));
  server_->motion({{10, -20, 30, -40, 50, -60}, 8});
  server_->button(1, true);
  server_->button(1, false);
  server_->motion({{}, 17});

  spnav_event event = next();
  ASSERT_EQ(event.type, SPNAV_EVENT_MOTION);
  EXPECT_THAT(std::vector<int>(event.motion.data, event.motion.data + 6),
              testing::ElementsAre(10, -20, 30, -40, 50, -60));
  EXPECT_EQ(event.motion.period, 8U);
  event = next();
  ASSERT_EQ(event.type, SPNAV_EVENT_BUTTON);
  EXPECT_EQ(event.button.press, 1);
  EXPECT_EQ(event.button.bnum, 1);
  event = next();
  ASSERT_EQ(event.type, SPNAV_EVENT_BUTTON);
  EXPECT_EQ(event.button.press, 0);
  event = next();
  ASSERT_EQ(event.type, SPNAV_EVENT_MOTION);
  EXPECT_EQ(event.motion.z, 0);
  EXPECT_EQ(event.motion.period, 17U);
}

TEST_F(SpnavServerTest, AnswersLibspnavsQuestions) {
  listen();
  ASSERT_EQ(spnav_open(), 0);
  EXPECT_EQ(spnav_dev_type(), -1) << "no device is here";
  const std::string name = "3Dconnexion SpaceMouse Enterprise, of a name that fills three pieces";
  server_->add_device({3, "SpaceNavigator", "", 0x046D, 0xC626, 2});
  server_->add_device({3, name, "/dev/hidraw12", 0x256F, 0xC633, 31});
  server_->add_device({4, "another", "", 1, 2, 3});
  EXPECT_EQ(next().type, SPNAV_EVENT_DEV);
  EXPECT_EQ(next().type, SPNAV_EVENT_DEV);
  std::array<char, 256> text{};
  EXPECT_EQ(spnav_dev_name(text.data(), text.size()), static_cast<int>(name.size()));
  EXPECT_EQ(std::string(text.data()), name);
  EXPECT_EQ(spnav_dev_path(text.data(), text.size()), 13);
  EXPECT_EQ(std::string(text.data()), "/dev/hidraw12");
  unsigned vendor = 0;
  unsigned product = 0;
  EXPECT_EQ(spnav_dev_usbid(&vendor, &product), 0);
  EXPECT_EQ(vendor, 0x256FU);
  EXPECT_EQ(product, 0xC633U);
  EXPECT_EQ(spnav_dev_axes(), 6);
  EXPECT_EQ(spnav_dev_buttons(), 31);
  EXPECT_EQ(spnav_dev_type(), SPNAV_DEV_SMENT);
  EXPECT_EQ(spnav_evmask(SPNAV_EVMASK_INPUT), 0);
  EXPECT_EQ(spnav_cfg_set_led(1), -1) << "no configuration of spacenavd's";
  spnav_client_name("a program whose name is longer than one piece");
  server_->remove_device(3);
  EXPECT_EQ(spnav_dev_buttons(), 3) << "the one that is left; and nothing answered the name";

  server_->motion(motion_of(1));
  EXPECT_EQ(next().motion.x, 1) << "the device's leaving was masked";
}

TEST_F(SpnavServerTest, BearsWhatLibspnavSendsForASensitivity) {
  listen();
  ASSERT_EQ(spnav_open(), 0);
  spnav_sensitivity(1.0);
  ASSERT_EQ(spnav_evmask(SPNAV_EVMASK_INPUT), 0);
  server_->motion(motion_of(100));
  const spnav_event event = next();
  ASSERT_EQ(event.type, SPNAV_EVENT_MOTION);
  EXPECT_EQ(event.motion.x, 100);
}

TEST_F(SpnavServerTest, ServesAnOldClientThatSaysNothing) {
  listen();
  const RawClient client(path_);
  ASSERT_TRUE(server_->wait_for_client(10s));
  server_->motion(motion_of(1));
  server_->button(0, true);
  EXPECT_EQ(client.read(), (std::array<std::int32_t, 8>{0, 1, 2, 3, 4, 5, 6, 8}));
  EXPECT_EQ(client.read(), (std::array<std::int32_t, 8>{1}));
}

TEST_F(SpnavServerTest, WaitsForNoClient) {
  listen();
  const RawClient sleeps(path_);
  ASSERT_TRUE(server_->wait_for_client(10s));
  ASSERT_EQ(spnav_open(), 0);
  ASSERT_EQ(spnav_evmask(SPNAV_EVMASK_INPUT), 0);  // it is greeted
  constexpr int kMotions = 5000;
  for (int i = 1; i <= kMotions; ++i) {
    server_->motion(motion_of(i));
    if (i % 10 != 0) continue;
    for (int read = 0; read < 10; ++read) ASSERT_EQ(next().motion.x, i - 9 + read);
  }
  server_->button(5, true);
  server_->motion({});
  server_->button(5, false);

  int seen = 0;
  int last = 0;
  bool released = false;
  while (!released) {
    const auto words = sleeps.read();
    ASSERT_NE(words[0], -1);
    ++seen;
    if (words[0] == 0 && words[1] != 0) {
      EXPECT_GT(words[1], last) << "in their order";
      last = words[1];
    } else if (words[0] == 0) {
      EXPECT_EQ(last, kMotions) << "rest comes after the newest motion";
    }
    released = words[0] == 2;
  }
  EXPECT_LT(seen, 1000) << "what nobody took was made one motion";
}

TEST_F(SpnavServerTest, ClosesWhatIsNoClientAndGoesOn) {
  listen();
  ASSERT_EQ(spnav_open(), 0);
  {
    const RawClient hostile(path_);
    const std::int32_t hello = 0x7FAA5501;
    hostile.write({reinterpret_cast<const char*>(&hello), sizeof hello});
    hostile.write(std::string(1000, 'x'));
    std::int32_t answer = 0;
    while (!hostile.is_ended()) ASSERT_LT(++answer, 8) << "the answer to its greeting, no more";
    const RawClient half(path_);
    half.write("ab");
    const RawClient noise(path_);
    for (int i = 0; i < 100; ++i) noise.write(std::string(997, static_cast<char>(i)));
  }
  ASSERT_TRUE(eventually([this] { return server_->clients() == 1; }));
  server_->motion(motion_of(4));
  EXPECT_EQ(next().type, SPNAV_EVENT_MOTION);
}

TEST_F(SpnavServerTest, AClientThatIsGoneIsNoneToStartFor) {
  listen();
  const std::array<std::int32_t, 9> hello_and_nonsense = {0x7FAA5501, 1};
  const RawClient hostile(path_);
  hostile.write(
      {reinterpret_cast<const char*>(hello_and_nonsense.data()), sizeof hello_and_nonsense});
  ASSERT_TRUE(hostile.is_ended());
  EXPECT_FALSE(server_->wait_for_client(0ms));
}

TEST_F(SpnavServerTest, LetsClientsBeyondTheMostWait) {
  listen();
  std::list<RawClient> clients;
  for (std::size_t i = 0; i < SpnavServer::kMostClients + 5; ++i) clients.emplace_back(path_);
  ASSERT_TRUE(eventually([this] { return server_->clients() == SpnavServer::kMostClients; }));
  for (int i = 0; i < 5; ++i) clients.pop_front();
  RawClient& last = clients.back();
  ASSERT_TRUE(eventually([this] { return server_->clients() == SpnavServer::kMostClients; }));
  std::this_thread::sleep_for(2 * SpnavServer::kGreeting);
  server_->motion(motion_of(9));
  EXPECT_EQ(last.read()[1], 9);
}

TEST_F(SpnavServerTest, ReplacesTheSocketOfADeadServer) {
  const int dead = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path_.c_str(), sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(dead, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ::close(dead);
  ASSERT_TRUE(std::filesystem::is_socket(path_));
  listen();
  EXPECT_EQ(spnav_open(), 0);
  EXPECT_EQ(spnav_protocol(), 1);
}

TEST_F(SpnavServerTest, LeavesALivingServerAlone) {
  listen();
  const auto second = SpnavServer::listen({path_});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::kIo);
  EXPECT_EQ(second.error().at, path_);
  EXPECT_EQ(second.error().what, "another server (spacenavd?) answers there");
  EXPECT_EQ(second.error().remedy, "stop it, or name another place by --socket PATH");
  EXPECT_EQ(spnav_open(), 0) << "the first one goes on";
}

TEST_F(SpnavServerTest, LeavesOtherFilesAlone) {
  std::ofstream(path_) << "text";
  const auto refused = SpnavServer::listen({path_});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what, "is there already and is no socket");
  EXPECT_EQ(std::filesystem::file_size(path_), 4U);
}

TEST_F(SpnavServerTest, SaysWhyItCannotListen) {
  const auto nowhere = SpnavServer::listen({"/nowhere/spnav.sock"});
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().what, "no socket could be made there: No such file or directory");
  const auto too_long = SpnavServer::listen({"/tmp/" + std::string(103, 'x')});
  ASSERT_FALSE(too_long);
  EXPECT_EQ(too_long.error().code, ErrorCode::kLimit);
}

TEST_F(SpnavServerTest, ItsFileIsTheUsersAndGoesWithIt) {
  listen();
  struct stat status {};
  ASSERT_EQ(::stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  server_.reset();
  EXPECT_FALSE(std::filesystem::exists(path_));
  auto open_to_all = SpnavServer::listen({path_, 0666});
  ASSERT_TRUE(open_to_all);
  ASSERT_EQ(::stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0666U);
}

TEST_F(SpnavServerTest, LeavesAnothersFileOfItsName) {
  listen();
  std::filesystem::remove(path_);
  std::ofstream(path_) << "another's";
  server_.reset();
  EXPECT_TRUE(std::filesystem::exists(path_));
}

TEST_F(SpnavServerTest, EndsItsClientsWithIt) {
  listen();
  const RawClient client(path_);
  ASSERT_TRUE(server_->wait_for_client(10s));
  server_->motion({});
  server_.reset();
  EXPECT_EQ(client.read()[0], 0);
  EXPECT_EQ(client.read()[0], -1);
}

}  // namespace
}  // namespace limn::test
