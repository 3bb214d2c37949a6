#include "input/trace_import/usb_capture.hpp"

#include <pcap/pcap.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <string>
#include <utility>

#include "input/trace_import/trace_import.hpp"

namespace limn {
namespace {

/// What libpcap reads from, and why that failed if it did.
struct Source {
  std::unique_ptr<ByteSource> bytes;
  std::optional<Error> failure;
};

ssize_t read_source(void* cookie, char* out, std::size_t size) {
  Source& source = *static_cast<Source*>(cookie);
  auto count = source.bytes->read({out, size});
  if (count) return static_cast<ssize_t>(*count);
  source.failure = std::move(count.error());
  errno = EIO;
  return -1;
}

std::string place(std::uint64_t number) { return "packet " + std::to_string(number); }

/// libpcap's words, fit for one line.
std::string one_line(const char* message) {
  std::string text = message;
  for (char& c : text) {
    if (c < ' ' || c > '~') c = ' ';
  }
  return text;
}

std::string name_of_link(int link) {
  const char* const name = pcap_datalink_val_to_name(link);
  return "link type " + std::to_string(link) + (name ? " (" + one_line(name) + ")" : "");
}

struct Close {
  void operator()(pcap_t* capture) const noexcept { pcap_close(capture); }
};

}  // namespace

struct UsbCapture::Impl {
  Source source;  // before capture, which reads from it until it is closed
  std::unique_ptr<pcap_t, Close> capture;
  UsbLink link = UsbLink::kUsbPcap;
  std::uint64_t count = 0;
  std::optional<Timestamp> first;
  bool ended = false;
};

UsbCapture::UsbCapture(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
UsbCapture::UsbCapture(UsbCapture&&) noexcept = default;
UsbCapture& UsbCapture::operator=(UsbCapture&&) noexcept = default;
UsbCapture::~UsbCapture() = default;

bool UsbCapture::ended() const noexcept { return impl_->ended; }
std::uint64_t UsbCapture::packet_count() const noexcept { return impl_->count; }

Expected<UsbCapture> UsbCapture::open(std::unique_ptr<ByteSource> bytes) {
  auto impl = std::make_unique<Impl>();
  impl->source.bytes = std::move(bytes);
  cookie_io_functions_t functions{};
  functions.read = read_source;
  std::FILE* const file = ::fopencookie(&impl->source, "rb", functions);
  if (file == nullptr) {
    return fail(ErrorCode::kIo, "", "no memory to read with", "free some memory");
  }
  std::array<char, PCAP_ERRBUF_SIZE> message{};
  impl->capture.reset(
      pcap_fopen_offline_with_tstamp_precision(file, PCAP_TSTAMP_PRECISION_NANO, message.data()));
  if (!impl->capture) {
    std::fclose(file);
    if (impl->source.failure) return tl::unexpected(*std::move(impl->source.failure));
    return fail(ErrorCode::kSyntax, "packet 1",
                "the head of the capture is damaged: " + one_line(message.data()),
                "capture again, or save it anew with the program that made it");
  }
  const int link = pcap_datalink(impl->capture.get());
  impl->link = static_cast<UsbLink>(link);
  switch (impl->link) {
    case UsbLink::kUsbmon48:
    case UsbLink::kUsbmon64:
    case UsbLink::kUsbPcap:
      return UsbCapture(std::move(impl));
  }
  return fail(ErrorCode::kUnknown, "", "this is no capture of USB, but of " + name_of_link(link),
              "capture USB: usbmon1, usbmon2 .. on Linux, USBPcap on Windows");
}

Expected<std::optional<UsbPacket>> UsbCapture::next() {
  constexpr int kEnd = PCAP_ERROR_BREAK;
  constexpr std::int64_t kMostSeconds = std::int64_t{1} << 33;  // the year 2242
  constexpr std::int64_t kNanosecond = 1'000'000'000;
  if (impl_->ended) return std::nullopt;
  pcap_pkthdr* header = nullptr;
  const unsigned char* bytes = nullptr;
  const int result = pcap_next_ex(impl_->capture.get(), &header, &bytes);
  if (result != 1) {
    impl_->ended = true;
    if (impl_->source.failure) return tl::unexpected(*std::move(impl_->source.failure));
    if (result == kEnd) return std::nullopt;
    return fail(ErrorCode::kSyntax, place(impl_->count + 1),
                "the capture is damaged: " + one_line(pcap_geterr(impl_->capture.get())),
                "add --salvage to keep what stands before it");
  }
  const std::uint64_t number = ++impl_->count;
  const std::int64_t seconds = header->ts.tv_sec;
  const std::int64_t nanoseconds = header->ts.tv_usec;
  if (seconds < 0 || seconds > kMostSeconds || nanoseconds < 0 || nanoseconds >= kNanosecond) {
    return fail(ErrorCode::kOutOfRange, place(number), "the packet's time is none",
                "add --salvage to skip it");
  }
  auto packet = parse_usb_packet(impl_->link, {bytes, header->caplen});
  if (!packet) {
    packet.error().at = place(number);
    return tl::unexpected(std::move(packet.error()));
  }
  const Timestamp time(seconds * kNanosecond + nanoseconds);
  if (!impl_->first) impl_->first = time;
  packet->number = number;
  packet->time = std::max(Timestamp(0), time - *impl_->first);
  return std::optional<UsbPacket>(*packet);
}

bool has_usb_captures() noexcept { return true; }

}  // namespace limn
