#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

#include "tests/support/temp_folder.hpp"

namespace limn::test {

/// spacenavd's end: accepts one client, answers its requests until it has asked for the device's
/// name, and then sends what the test wants. Protocol 0 answers nothing, as before spacenavd 1.0.
class SpacenavdServer {
 public:
  using Message = std::array<std::int32_t, 8>;

  explicit SpacenavdServer(int protocol) {
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
  ~SpacenavdServer() {
    stop_listening();
    if (thread_.joinable()) thread_.join();
    leave();
    ::close(listening_);
  }
  SpacenavdServer(const SpacenavdServer&) = delete;
  SpacenavdServer& operator=(const SpacenavdServer&) = delete;

  const std::string& path() const { return path_; }
  void wait_for_client() { thread_.join(); }
  /// Ends wait_for_client() where nobody came.
  void stop_listening() const { ::shutdown(listening_, SHUT_RDWR); }
  void send(const Message& message) const { write_whole(message.data(), sizeof message); }
  void send_bytes(std::size_t count) const { write_whole(std::string(count, 'x').data(), count); }
  void leave() {
    if (client_ >= 0) ::close(client_);
    client_ = -1;
  }

 private:
  // spacenavd's proto.h
  static constexpr std::int32_t kTag = 0x7FAA0000;
  static constexpr std::int32_t kChangeProtocol = 0x5500;
  static constexpr std::int32_t kDeviceName = 0x2000;
  static constexpr std::int32_t kDeviceUsbId = 0x2004;

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

}  // namespace limn::test
