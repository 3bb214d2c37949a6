#include "drivers/transport/hidraw_transport.hpp"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <utility>

#include "drivers/transport/file_handle.hpp"
#include "drivers/transport/hidraw_control.hpp"
#include "drivers/transport/node_error.hpp"
#include "drivers/transport/paced_reader.hpp"

namespace limn {
namespace {

class MessageTransport final : public Transport {
 public:
  /// `node`: where others open it, too; empty for a socket.
  MessageTransport(FileHandle file, std::string node, TraceDevice device, int queue)
      : file_(std::move(file)), node_(std::move(node)), device_(std::move(device)), queue_(queue) {}

  const TraceDevice& device() const noexcept override { return device_; }
  int poll_descriptor() const noexcept override { return file_.get(); }

  State drain(TransportSink& sink) noexcept override {
    for (int count = 0; count < kMostReports; ++count) {
      const ssize_t size = ::read(file_.get(), buffer_.data(), buffer_.size());
      if (size < 0 && errno == EINTR) continue;
      if (size < 0 && errno == EAGAIN) return State::kOpen;
      if (size <= 0) return State::kGone;
      const Timestamp now = monotonic_clock().now();
      sink.report(now, {buffer_.data(), static_cast<std::size_t>(size)});
      if (count + 1 == queue_) sink.lost(0, true);
    }
    return State::kOpen;
  }

  Expected<std::unique_ptr<DeviceControl>> open_control() const override {
    return node_.empty() ? Transport::open_control() : open_hidraw_control(node_);
  }

 private:
  FileHandle file_;
  std::string node_;
  TraceDevice device_;
  int queue_;  // reports that the other end keeps; 0: it waits for us instead
  std::array<std::uint8_t, kMaxReportBytes> buffer_;
};

/// A text that an ioctl of hidraw gives, empty where it gives none.
std::string text_of(int file, unsigned long request) {
  std::array<char, 256> text{};
  return ::ioctl(file, request, text.data()) > 0 ? std::string(text.data()) : std::string();
}

}  // namespace

Expected<std::unique_ptr<Transport>> open_hidraw(const std::string& node) {
  FileHandle file(::open(node.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!file) return node_error(node, "opened", errno);
  hidraw_devinfo info{};
  int size = 0;
  if (::ioctl(file.get(), HIDIOCGRAWINFO, &info) < 0 ||
      ::ioctl(file.get(), HIDIOCGRDESCSIZE, &size) < 0) {
    if (errno == ENOTTY || errno == EINVAL || errno == ENOSYS) {  // the last from qemu-user
      return fail(ErrorCode::kIo, node, "is no hidraw node", "give one that 'limn devices' names");
    }
    return node_error(node, "opened", errno);
  }
  if (size < 0 || size > HID_MAX_DESCRIPTOR_SIZE) {
    return fail(ErrorCode::kLimit, node,
                "a report descriptor of " + std::to_string(size) + " bytes is above 4 KiB",
                "this is no device that Linux supports");
  }
  hidraw_report_descriptor descriptor{};
  descriptor.size = static_cast<__u32>(size);
  if (::ioctl(file.get(), HIDIOCGRDESC, &descriptor) < 0) return node_error(node, "opened", errno);

  TraceDevice device;
  device.name = text_of(file.get(), HIDIOCGRAWNAME(256));
  device.physical_path = text_of(file.get(), HIDIOCGRAWPHYS(256));
  device.unique_id = text_of(file.get(), HIDIOCGRAWUNIQ(256));
  device.bus = static_cast<std::uint16_t>(info.bustype);
  device.vendor = static_cast<std::uint16_t>(info.vendor);
  device.product = static_cast<std::uint16_t>(info.product);
  device.report_descriptor.assign(descriptor.value, descriptor.value + size);
  constexpr int kHidrawQueue = 63;  // HIDRAW_BUFFER_SIZE is 64, of which one stays empty
  return std::make_unique<MessageTransport>(std::move(file), node, std::move(device), kHidrawQueue);
}

std::unique_ptr<Transport> open_messages(int descriptor, TraceDevice device, int queue) {
  ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) | O_NONBLOCK);
  return std::make_unique<MessageTransport>(FileHandle(descriptor), "", std::move(device), queue);
}

}  // namespace limn
