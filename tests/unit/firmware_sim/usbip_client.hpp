#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_sim/link/file_descriptor.hpp"
#include "tests/unit/firmware_sim/counting_device.hpp"

namespace limn::firmware {

/// A USB/IP client that makes and takes its packets byte by byte, from the protocol's description
/// alone: it shares nothing with the server.
class UsbipClient {
 public:
  /// What came back for a URB.
  struct Returned {
    std::uint32_t command = 0;
    std::uint32_t sequence = 0;
    std::int32_t status = 0;
    std::uint32_t actual = 0;
    Bytes data;
  };

  explicit UsbipClient(FileDescriptor socket);
  /// Over TCP, to 127.0.0.1.
  static UsbipClient connect(std::uint16_t port);

  /// Sends bytes as they are.
  void send(const Bytes& bytes);
  void send(std::string_view hex);  ///< blanks between them

  /// Takes `count` bytes; fewer where the server closes, or nothing comes in 20 s.
  Bytes take(std::size_t count);
  /// Whether the server has closed the connection, and nothing is left of it.
  bool closed();
  /// Ends it, in the middle of whatever it is.
  void close();

  /// Operations; give the reply's eight bytes and, where that says so, what follows.
  Bytes list();
  Bytes import(std::string_view busid);

  void submit_in(std::uint32_t sequence, std::uint32_t endpoint, std::uint32_t length,
                 const Bytes& setup = Bytes(8));
  void submit_out(std::uint32_t sequence, std::uint32_t endpoint, const Bytes& data,
                  const Bytes& setup = Bytes(8));
  void unlink(std::uint32_t sequence, std::uint32_t unlinked);

  /// The next return; `in` where it is of a transfer to the host, whose data follow.
  Returned take_return(bool in);

  /// A control transfer to the host, and from it.
  Returned control_in(const Bytes& setup);
  Returned control_out(const Bytes& setup, const Bytes& data = {});

 private:
  void header(std::uint32_t command, std::uint32_t sequence, std::uint32_t direction,
              std::uint32_t endpoint, Bytes& out) const;

  FileDescriptor socket_;
  std::uint32_t next_ = 1000;  // sequence of control transfers
};

/// A big-endian number of `size` bytes at `at`.
std::uint32_t number_at(const Bytes& bytes, std::size_t at, std::size_t size);

}  // namespace limn::firmware
