#include "tests/unit/firmware_sim/usbip_client.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <cerrno>
#include <cstdlib>
#include <utility>

namespace limn::firmware {
namespace {

void append(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(value >> shift & 0xFF);
}

}  // namespace

std::uint32_t number_at(const Bytes& bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = at; i < at + size && i < bytes.size(); ++i) value = value << 8 | bytes[i];
  return value;
}

UsbipClient::UsbipClient(FileDescriptor socket) : socket_(std::move(socket)) {
  const timeval patience{20, 0};  // a hang fails instead
  ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  ::setsockopt(socket_.get(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
}

UsbipClient UsbipClient::connect(std::uint16_t port) {
  FileDescriptor socket(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::connect(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  return UsbipClient(std::move(socket));
}

void UsbipClient::send(const Bytes& bytes) {
  std::size_t put = 0;
  while (put < bytes.size()) {
    const ssize_t count =
        ::send(socket_.get(), bytes.data() + put, bytes.size() - put, MSG_NOSIGNAL);
    if (count <= 0) return;  // the server has closed it: what a test then reads tells
    put += static_cast<std::size_t>(count);
  }
}

void UsbipClient::send(std::string_view hex) {
  Bytes bytes;
  const std::string text(hex);
  for (const char* at = text.c_str(); *at != 0;) {
    char* end = nullptr;
    bytes.push_back(static_cast<std::uint8_t>(std::strtoul(at, &end, 16)));
    at = end;
    while (*at == ' ') ++at;
  }
  send(bytes);
}

Bytes UsbipClient::take(std::size_t count) {
  Bytes bytes(count);
  std::size_t got = 0;
  while (got < count) {
    const ssize_t some = ::recv(socket_.get(), bytes.data() + got, count - got, 0);
    if (some <= 0) break;
    got += static_cast<std::size_t>(some);
  }
  bytes.resize(got);
  return bytes;
}

bool UsbipClient::closed() {
  std::uint8_t byte = 0;
  const ssize_t got = ::recv(socket_.get(), &byte, 1, 0);
  return got == 0 || (got < 0 && errno == ECONNRESET);
}

void UsbipClient::close() { socket_ = FileDescriptor(); }

Bytes UsbipClient::list() {
  send("01 11 80 05 00 00 00 00");
  Bytes reply = take(12);
  if (number_at(reply, 8, 4) == 0) return reply;
  const Bytes device = take(312);
  reply.insert(reply.end(), device.begin(), device.end());
  const Bytes interfaces = take(4 * std::size_t{device.empty() ? 0U : device.back()});
  reply.insert(reply.end(), interfaces.begin(), interfaces.end());
  return reply;
}

Bytes UsbipClient::import(std::string_view busid) {
  Bytes request = {0x01, 0x11, 0x80, 0x03, 0, 0, 0, 0};
  request.insert(request.end(), busid.begin(), busid.end());
  request.resize(40);
  send(request);
  Bytes reply = take(8);
  if (number_at(reply, 4, 4) != 0) return reply;
  const Bytes device = take(312);
  reply.insert(reply.end(), device.begin(), device.end());
  return reply;
}

void UsbipClient::header(std::uint32_t command, std::uint32_t sequence, std::uint32_t direction,
                         std::uint32_t endpoint, Bytes& out) const {
  for (const std::uint32_t value : {command, sequence, 0x00010002U, direction, endpoint}) {
    append(out, value);
  }
}

void UsbipClient::submit_in(std::uint32_t sequence, std::uint32_t endpoint, std::uint32_t length,
                            const Bytes& setup) {
  Bytes packet;
  header(1, sequence, 1, endpoint, packet);
  for (const std::uint32_t value : {0x200U, length, 0U, 0U, 1U}) append(packet, value);
  packet.insert(packet.end(), setup.begin(), setup.end());
  send(packet);
}

void UsbipClient::submit_out(std::uint32_t sequence, std::uint32_t endpoint, const Bytes& data,
                             const Bytes& setup) {
  Bytes packet;
  header(1, sequence, 0, endpoint, packet);
  const auto length = static_cast<std::uint32_t>(data.size());
  for (const std::uint32_t value : {0U, length, 0U, 0xFFFFFFFFU, 1U}) append(packet, value);
  packet.insert(packet.end(), setup.begin(), setup.end());
  packet.insert(packet.end(), data.begin(), data.end());
  send(packet);
}

void UsbipClient::unlink(std::uint32_t sequence, std::uint32_t unlinked) {
  Bytes packet;
  header(2, sequence, 0, 0, packet);
  append(packet, unlinked);
  packet.resize(48);
  send(packet);
}

UsbipClient::Returned UsbipClient::take_return(bool in) {
  const Bytes bytes = take(48);
  EXPECT_EQ(bytes.size(), 48U) << "the server closed the connection";
  Returned returned;
  returned.command = number_at(bytes, 0, 4);
  returned.sequence = number_at(bytes, 4, 4);
  returned.status = static_cast<std::int32_t>(number_at(bytes, 20, 4));
  returned.actual = number_at(bytes, 24, 4);
  if (in && returned.command == 3) returned.data = take(returned.actual);
  return returned;
}

UsbipClient::Returned UsbipClient::control_in(const Bytes& setup) {
  submit_in(++next_, 0, setup[6] | setup[7] << 8, setup);
  return take_return(true);
}

UsbipClient::Returned UsbipClient::control_out(const Bytes& setup, const Bytes& data) {
  submit_out(++next_, 0, data, setup);
  return take_return(false);
}

}  // namespace limn::firmware
