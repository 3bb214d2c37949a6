#include <cstdint>

#include "input/trace_import/trace_import.hpp"
#include "input/trace_import/usb_capture.hpp"

namespace limn {

struct UsbCapture::Impl {};

UsbCapture::UsbCapture(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
UsbCapture::UsbCapture(UsbCapture&&) noexcept = default;
UsbCapture& UsbCapture::operator=(UsbCapture&&) noexcept = default;
UsbCapture::~UsbCapture() = default;

Expected<UsbCapture> UsbCapture::open(std::unique_ptr<ByteSource> /*bytes*/) {
  return fail(ErrorCode::kMissing, "",
              "this limn was built without libpcap, so without USB captures",
              "install libpcap-dev and build limn again");
}

Expected<std::optional<UsbPacket>> UsbCapture::next() { return std::nullopt; }
bool UsbCapture::ended() const noexcept { return true; }
std::uint64_t UsbCapture::packet_count() const noexcept { return 0; }

bool has_usb_captures() noexcept { return false; }

}  // namespace limn
