#include "drivers/spnav_server/spnav_server.hpp"

#include <poll.h>
#include <signal.h>  // pthread_sigmask is POSIX
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <list>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/spnav_server/spnav_session.hpp"
#include "drivers/spnav_server/spnav_socket.hpp"

namespace limn {
namespace {

using Clock = std::chrono::steady_clock;

/// What the kernel keeps for a client that does not read: some forty messages, so that it comes
/// upon the newest motion soon.
constexpr int kSendBufferBytes = 16 * 1024;

/// Read from one client before the others have their turn.
constexpr std::size_t kReadBytes = 256;

/// After the system had no descriptor for a client.
constexpr std::chrono::milliseconds kPause{100};

struct Client {
  explicit Client(FileHandle handle)
      : socket(std::move(handle)), greeted_by(Clock::now() + SpnavServer::kGreeting) {}
  FileHandle socket;
  SpnavSession session;
  std::optional<Clock::time_point> greeted_by;  ///< until it is greeted
  bool gone = false;
};

/// Signals are left to the caller's threads, whose handlers may use what they guard.
class BlockedSignals {
 public:
  BlockedSignals() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~BlockedSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t before_{};
};

/// Sends what there is and the socket takes, a message at a time: the kernel takes each whole or
/// not at all, and libspnav counts on whole ones.
void flush(Client& client) {
  while (!client.gone) {
    const auto bytes = client.session.output();
    if (bytes.empty()) return;
    const ssize_t size =
        ::send(client.socket.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (size >= 0) {
      client.session.sent(static_cast<std::size_t>(size));
    } else if (errno == EAGAIN) {
      return;
    } else if (errno != EINTR) {
      client.gone = true;
    }
  }
}

}  // namespace

/// All but the constants is behind one lock, which nobody holds while waiting.
class SpnavServer::Serving {
 public:
  Serving(SpnavSocket listening, FileHandle wake)
      : listening_(std::move(listening)), wake_(std::move(wake)) {}
  ~Serving() {
    if (!thread_.joinable()) return;
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    wake();
    thread_.join();
  }
  Serving(const Serving&) = delete;
  Serving& operator=(const Serving&) = delete;

  void start() {
    const BlockedSignals blocked;  // in the thread, which inherits that
    thread_ = std::thread([this] { run(); });
  }

  template <class Tell>
  void tell_all(Tell&& tell) {
    const std::lock_guard lock(mutex_);
    tell_clients(tell);
  }

  void add(SpnavDevice device) {
    const std::lock_guard lock(mutex_);
    const auto known = find(device.index);
    if (known != devices_.end()) {
      *known = std::move(device);
      return;
    }
    devices_.push_back(std::move(device));
    tell_clients([this](SpnavSession& session) { session.device(devices_.back(), true); });
  }

  void remove(DeviceIndex index) {
    const std::lock_guard lock(mutex_);
    const auto known = find(index);
    if (known == devices_.end()) return;
    tell_clients([&known](SpnavSession& session) { session.device(*known, false); });
    devices_.erase(known);
  }

  std::size_t clients() const {
    const std::lock_guard lock(mutex_);
    return clients_.size();
  }

  bool wait_for_client(std::chrono::milliseconds longest) const {
    std::unique_lock lock(mutex_);
    return greeted_.wait_for(lock, longest, [this] { return had_client_; });
  }

 private:
  std::vector<SpnavDevice>::iterator find(DeviceIndex index) {
    return std::find_if(devices_.begin(), devices_.end(),
                        [index](const SpnavDevice& one) { return one.index == index; });
  }

  template <class Tell>
  void tell_clients(Tell&& tell) {
    bool wait = false;
    for (Client& client : clients_) {
      tell(client.session);
      flush(client);
      wait |= client.gone || !client.session.output().empty();
    }
    if (wait) wake();  // for the sockets to take more
  }

  void wake() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(wake_.get(), &one, sizeof one);
  }

  void run() {
    std::vector<pollfd> polled;
    std::unique_lock lock(mutex_);
    while (!ends_) {
      const int timeout = choose_what_to_wait_for(polled);
      lock.unlock();
      ::poll(polled.data(), polled.size(), timeout);
      lock.lock();
      if (polled[0].revents != 0) {
        std::uint64_t count = 0;
        [[maybe_unused]] const ssize_t size = ::read(wake_.get(), &count, sizeof count);
      }
      // Only this thread adds and removes clients: they are those that were polled.
      auto event = polled.begin() + 2;
      for (Client& client : clients_) serve(client, (event++)->revents);
      clients_.remove_if([](const Client& client) { return client.gone; });
      if (polled[1].revents != 0) accept();
    }
    for (Client& client : clients_) flush(client);
  }

  int choose_what_to_wait_for(std::vector<pollfd>& polled) const {
    const auto now = Clock::now();
    auto until = Clock::time_point::max();
    const bool accepts = clients_.size() < kMostClients && now >= paused_until_;
    if (now < paused_until_) until = paused_until_;
    polled.clear();
    polled.push_back({wake_.get(), POLLIN, 0});
    polled.push_back({accepts ? listening_.get() : -1, POLLIN, 0});
    for (const Client& client : clients_) {
      int events = client.session.takes_requests() ? POLLIN : 0;
      if (!client.session.output().empty()) events |= POLLOUT;
      polled.push_back({client.socket.get(), static_cast<short>(events), 0});
      if (client.greeted_by) until = std::min(until, *client.greeted_by);
    }
    if (until == Clock::time_point::max()) return -1;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - now);
    return static_cast<int>(std::max<std::int64_t>(left.count(), 0));
  }

  void serve(Client& client, short events) {
    bool greets = false;
    if ((events & POLLIN) != 0) {
      read(client);
    } else if ((events & (POLLHUP | POLLERR | POLLNVAL)) != 0) {
      client.gone = true;
    }
    if (client.greeted_by && (client.session.has_spoken() || Clock::now() >= *client.greeted_by)) {
      client.greeted_by.reset();
      client.session.start();
      greets = true;
    }
    flush(client);
    if (!greets || client.gone || (events & POLLHUP) != 0) return;
    had_client_ = true;
    greeted_.notify_all();
  }

  void read(Client& client) {
    std::array<std::uint8_t, kReadBytes> bytes;
    const ssize_t size = ::recv(client.socket.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) return;
    const SpnavDevice* const device = devices_.empty() ? nullptr : &devices_.front();
    client.gone = size <= 0 || !client.session.receive(
                                   std::span(bytes).first(static_cast<std::size_t>(size)), device);
  }

  void accept() {
    while (clients_.size() < kMostClients) {
      FileHandle socket(
          ::accept4(listening_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
      if (!socket) {
        const bool none = errno == EAGAIN || errno == EINTR || errno == ECONNABORTED;
        if (!none) paused_until_ = Clock::now() + kPause;
        return;
      }
      ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDBUF, &kSendBufferBytes, sizeof kSendBufferBytes);
      clients_.emplace_back(std::move(socket));
    }
  }

  const SpnavSocket listening_;
  const FileHandle wake_;
  std::thread thread_;
  mutable std::mutex mutex_;
  mutable std::condition_variable greeted_;
  std::list<Client> clients_;
  std::vector<SpnavDevice> devices_;
  Clock::time_point paused_until_{};
  bool had_client_ = false;
  bool ends_ = false;
};

Expected<std::unique_ptr<SpnavServer>> SpnavServer::listen(const SpnavServerOptions& options) {
  auto listening = SpnavSocket::listen(options.socket, options.mode);
  if (!listening) return tl::unexpected(std::move(listening.error()));
  FileHandle wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!wake) {
    return fail(ErrorCode::kIo, options.socket,
                "the system gives no event: " + std::generic_category().message(errno),
                "end other programs");
  }
  auto serving = std::make_unique<Serving>(*std::move(listening), std::move(wake));
  try {
    serving->start();
  } catch (const std::system_error& error) {
    return fail(ErrorCode::kIo, options.socket,
                std::string("the system gives no thread: ") + error.what(), "end other programs");
  }
  return std::unique_ptr<SpnavServer>(new SpnavServer(std::move(serving)));
}

SpnavServer::SpnavServer(std::unique_ptr<Serving> serving) : serving_(std::move(serving)) {}
SpnavServer::~SpnavServer() = default;

void SpnavServer::add_device(SpnavDevice device) { serving_->add(std::move(device)); }
void SpnavServer::remove_device(DeviceIndex index) { serving_->remove(index); }

void SpnavServer::motion(const SpnavMotion& motion) {
  serving_->tell_all([&motion](SpnavSession& session) { session.motion(motion); });
}

void SpnavServer::button(unsigned number, bool pressed) {
  serving_->tell_all([number, pressed](SpnavSession& session) { session.button(number, pressed); });
}

std::size_t SpnavServer::clients() const { return serving_->clients(); }

bool SpnavServer::wait_for_client(std::chrono::milliseconds longest) const {
  return serving_->wait_for_client(longest);
}

}  // namespace limn
