#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "drivers/spnav_server/spnav_device.hpp"
#include "drivers/spnav_server/spnav_events.hpp"
#include "input/base/error.hpp"

namespace limn {

struct SpnavServerOptions {
  std::string socket;    ///< where to listen
  unsigned mode = 0600;  ///< of the socket's file: who may connect
};

/// Serves motions and buttons to programs that know spacenavd alone, over a UNIX stream socket in
/// spacenavd's protocol (SpnavSession), in a thread of its own.
///
/// Whoever calls motion() and button() is never made to wait for a client. Clients beyond
/// kMostClients wait until another leaves. A new client is told events once it has said which
/// version it speaks, or after kGreeting: a motion that came before the answer would be taken for
/// it.
///
/// All members may be called from any thread.
class SpnavServer final : public SpnavSink {
 public:
  static constexpr std::size_t kMostClients = 64;
  static constexpr std::chrono::milliseconds kGreeting{100};

  /// Listens. The file of a server that has ended is replaced. Errors: kIo: another server answers
  /// there, or the system refuses; kLimit: the path is longer than a socket's may be.
  static Expected<std::unique_ptr<SpnavServer>> listen(const SpnavServerOptions& options);

  /// Clients lose their connection, and the socket's file goes.
  ~SpnavServer() override;

  /// Questions are answered for the device that is there longest. One that is there already is
  /// described anew.
  void add_device(SpnavDevice device);
  void remove_device(DeviceIndex index);

  void motion(const SpnavMotion& motion) override;
  void button(unsigned number, bool pressed) override;

  /// Of those that are connected now.
  std::size_t clients() const;
  /// Whether a client has been there that was ready for events and had not left, waiting for the
  /// first no longer than so long.
  bool wait_for_client(std::chrono::milliseconds longest) const;

 private:
  class Serving;
  explicit SpnavServer(std::unique_ptr<Serving> serving);

  std::unique_ptr<Serving> serving_;
};

}  // namespace limn
