// Any messages from a transport, into a decoder of any row of the tables.
//
//   u16       number of the row, modulo theirs
//   messages: u16 length, bytes (repeated until it is reached); 0: the device goes away

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "drivers/devices/pen_decoder.hpp"
#include "drivers/transport/hidraw_transport.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/pen_laws.hpp"

namespace {

using namespace limn;

PenDecoder decoder_of(const PenSpec& row) {
  PenIdentity identity;
  identity.vendor = row.vendor;
  identity.product = row.product;
  identity.firmware = row.firmware;
  identity.product_name = row.product_name;
  identity.descriptor_bytes = row.descriptor_bytes;
  auto decoder = PenDecoder::make(identity, {});
  fuzz::require(decoder.has_value(), "a device of the tables needs no descriptor");
  return std::move(*decoder);
}

class Sink final : public TransportSink {
 public:
  explicit Sink(const PenSpec& row) : decoder(decoder_of(row)) {}
  void report(Timestamp time, std::span<const std::uint8_t> bytes) noexcept override {
    ++reports;
    last.assign(bytes.begin(), bytes.end());
    laws.check(decoder.decode(Report{0, time, bytes}).samples);
  }
  void frame(Timestamp, std::span<const EvdevEvent>) noexcept override {
    fuzz::require(false, "messages are no frames");
  }
  void lost(std::uint32_t, bool) noexcept override {
    fuzz::require(false, "the socket waits, and drops nothing");
  }
  PenDecoder decoder;
  fuzz::PenLaws laws;
  int reports = 0;
  std::vector<std::uint8_t> last;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) != 0) return 0;
  const auto transport = open_messages(ends[1], TraceDevice{});
  fuzz::Input input(data, size);
  Sink sink(pen_specs()[input.word() % pen_specs().size()]);
  std::vector<std::uint8_t> message;
  bool away = false;
  constexpr int kMostMessages = 64;
  for (int i = 0; i < kMostMessages && !input.empty() && !away; ++i) {
    constexpr std::size_t kLongest = kMaxReportBytes + 100;
    const std::size_t length = input.word() % kLongest;
    const auto bytes = input.take(length);
    message.assign(length, 0);
    for (std::size_t k = 0; k < length && !bytes.empty(); ++k) message[k] = bytes[k % bytes.size()];
    const int before = sink.reports;
    const ssize_t sent = ::send(ends[0], message.data(), message.size(), MSG_DONTWAIT);
    fuzz::require(sent == static_cast<ssize_t>(length), "an empty socket takes a message");
    away = transport->drain(sink) == Transport::State::kGone;
    fuzz::require(away == (length == 0), "an empty message is the end");
    if (away) break;
    message.resize(std::min(message.size(), kMaxReportBytes));
    fuzz::require(sink.reports == before + 1 && sink.last == message, "a message is one report");
  }
  ::close(ends[0]);
  fuzz::require(transport->drain(sink) == Transport::State::kGone, "it sees the far end close");
  sink.laws.check(sink.decoder.disconnect(0, Timestamp::max()));
  return 0;
}
