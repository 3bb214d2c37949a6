#include "firmware_sim/link/usbip_server.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "firmware_sim/link/frames.hpp"

namespace limn::firmware {
namespace {

using std::chrono::microseconds;
using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kAcceptPause{100};

LinkResult<std::uint16_t> listen_fail(std::uint16_t port, int error) {
  std::string what = "cannot listen on 127.0.0.1:" + std::to_string(port);
  if (error == EADDRINUSE) {
    return link_fail(what + ": the port is taken", "choose another one, or 0 for any that is free");
  }
  if (error == EACCES) return link_fail(what + ": not permitted", "choose a port from 1024 on");
  return link_fail(what + ": " + std::strerror(error), "see whether the loopback device is up");
}

}  // namespace

UsbipServer::UsbipServer(BusDevice& device, UsbipOptions options, Tell tell)
    : exported_{device}, options_(options), tell_(std::move(tell)) {
  if (!options_.wait_for_reader) clock_.start();
}

LinkResult<std::uint16_t> UsbipServer::listen(std::uint16_t port) {
  FileDescriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket) return listen_fail(port, errno);
  const int on = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto* const bound = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof address;
  if (::bind(socket.get(), bound, size) != 0 ||
      ::listen(socket.get(), static_cast<int>(kMostConnections)) != 0 ||
      ::getsockname(socket.get(), bound, &size) != 0) {
    return listen_fail(port, errno);
  }
  listener_ = std::move(socket);
  return ntohs(address.sin_port);
}

void UsbipServer::adopt(FileDescriptor socket) {
  const microseconds now = clock_.now();
  if (exported_.user != nullptr || !exported_.device.plugged(now)) {
    return tell(UsbipNotice::Kind::kRefused, "the device is in use or not plugged in");
  }
  auto client = std::make_unique<Client>(exported_, std::move(socket));
  client->connection.session().import(now);
  clients_.push_back(std::move(client));
}

LinkResult<LinkEnd> UsbipServer::run(microseconds end, Waiter& waiter) {
  while (!waiter.stopped()) {
    const microseconds now = std::min(clock_.now(), end);
    look_at_cable(now);
    accept_clients();
    serve_clients(now);
    if (now >= end) return LinkEnd::kTimeUp;
    auto files = watched();
    waiter.wait(files, deadline(now, end));
  }
  return LinkEnd::kStopped;
}

void UsbipServer::tell(UsbipNotice::Kind kind, std::string text) {
  if (tell_) tell_({kind, std::move(text)});
}

void UsbipServer::look_at_cable(microseconds now) {
  const bool was = std::exchange(plugged_, exported_.device.plugged(now));
  if (was == plugged_) return;
  if (plugged_) return tell(UsbipNotice::Kind::kPlugged, "the device is plugged in again");
  std::erase_if(clients_,
                [](const auto& client) { return client->connection.session().imported(); });
  tell(UsbipNotice::Kind::kUnplugged, "the device was unplugged");
}

void UsbipServer::accept_clients() {
  const auto wall = steady_clock::now();
  while (listener_ && wall >= accept_again_) {
    FileDescriptor socket(
        ::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!socket) {
      if (errno == EINTR || errno == ECONNABORTED) continue;
      if (errno == EAGAIN) return;
      accept_again_ = wall + kAcceptPause;
      return tell(UsbipNotice::Kind::kRefused,
                  std::string("a client cannot be taken: ") + std::strerror(errno));
    }
    if (clients_.size() >= kMostConnections) {
      tell(UsbipNotice::Kind::kRefused,
           "a client is one too many: " + std::to_string(kMostConnections) + " are connected");
      continue;
    }
    const int on = 1;
    ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    clients_.push_back(std::make_unique<Client>(exported_, std::move(socket)));
    clients_.back()->deadline = wall + kPatience;
  }
}

void UsbipServer::serve_clients(microseconds now) {
  // tell() may add clients: only those that are here now are looked at, by their place.
  const std::size_t count = clients_.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!serve(*clients_[i], now)) clients_[i].reset();
  }
  std::erase(clients_, nullptr);
}

/// False: the client is to be dropped.
bool UsbipServer::serve(Client& client, microseconds now) {
  const auto state = client.connection.pump(now);
  const UsbipSession& session = client.connection.session();
  reports_ += session.reports() - std::exchange(client.reports, session.reports());
  if (session.imported() && !std::exchange(client.attached, true)) {
    tell(UsbipNotice::Kind::kAttached, "a client has the device");
  }
  if (!clock_.runs() && session.imported() && session.listening()) clock_.start();
  if (state && *state == UsbipConnection::State::kOpen) {
    if (session.imported() || steady_clock::now() < client.deadline) return true;
    tell(UsbipNotice::Kind::kRefused, "a client was closed: it took no device in 10 s");
    return false;
  }
  if (!state) {
    tell(UsbipNotice::Kind::kRefused, "a client was closed: " + state.error().what);
  }
  if (client.attached) tell(UsbipNotice::Kind::kDetached, "the client has left the device");
  return false;
}

std::vector<Watched> UsbipServer::watched() const {
  std::vector<Watched> files;
  for (const auto& client : clients_) files.push_back(client->connection.watched());
  if (listener_ && steady_clock::now() >= accept_again_) files.push_back({listener_.get()});
  return files;
}

std::optional<SimulationClock::Point> UsbipServer::deadline(microseconds now,
                                                            microseconds end) const {
  std::optional<SimulationClock::Point> next;
  const auto earlier = [&next](SimulationClock::Point point) {
    next = next ? std::min(*next, point) : point;
  };
  const auto wall = steady_clock::now();
  if (accept_again_ > wall) earlier(accept_again_);
  for (const auto& client : clients_) {
    if (!client->connection.session().imported()) earlier(client->deadline);
  }
  if (!clock_.runs()) return next;
  earlier(clock_.at(std::min(
      after_silence((now / kFrame + 1) * kFrame, now, exported_.device.silent_until(now)), end)));
  for (const auto& client : clients_) {
    const auto poll = client->connection.session().next_poll();
    if (poll) earlier(clock_.at(std::min(*poll, end)));
  }
  return next;
}

}  // namespace limn::firmware
