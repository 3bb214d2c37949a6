#include "drivers/transport/hidraw_control.hpp"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <utility>

#include "drivers/transport/file_handle.hpp"
#include "drivers/transport/node_error.hpp"
#include "drivers/transport/sysfs.hpp"
#include "drivers/transport/usb_device.hpp"

namespace limn {
namespace {

namespace fs = std::filesystem;

class HidrawControl final : public DeviceControl {
 public:
  HidrawControl(std::string node, FileHandle file)
      : node_(std::move(node)), file_(std::move(file)) {}

  Expected<std::vector<std::uint8_t>> read_string(std::uint8_t index, std::uint16_t language,
                                                  std::uint16_t length) override {
    if (!usb_) {
      const auto above = usb_node_above(node_);
      if (!above) {
        return fail(ErrorCode::kMissing, node_, "is no USB device, which alone have such strings",
                    "connect it by USB");
      }
      auto opened = UsbDevice::open(*above);
      if (!opened) return tl::unexpected(std::move(opened.error()));
      usb_ = *std::move(opened);
    }
    return usb_->read_string(index, language, length);
  }

  Expected<void> write_interrupt(std::uint8_t, std::span<const std::uint8_t> bytes) override {
    return set_output(bytes);
  }

  Expected<void> set_output(std::span<const std::uint8_t> bytes) override {
    if (bytes.empty()) return {};
    const ssize_t written = ::write(file_.get(), bytes.data(), bytes.size());
    if (written < 0) return node_error(node_, "written to", errno);
    if (static_cast<std::size_t>(written) != bytes.size()) {
      return node_error(node_, "written to as a whole", EIO);
    }
    return {};
  }

  Expected<void> set_feature(std::span<const std::uint8_t> bytes) override {
    if (bytes.empty()) return {};
    std::vector<std::uint8_t> sent(bytes.begin(), bytes.end());  // ioctl takes no constant bytes
    if (::ioctl(file_.get(), HIDIOCSFEATURE(sent.size()), sent.data()) < 0) {
      return node_error(node_, "told", errno);
    }
    return {};
  }

  Expected<std::vector<std::uint8_t>> get_feature(std::uint8_t id, std::size_t length) override {
    std::vector<std::uint8_t> bytes(std::clamp<std::size_t>(length, 1, HID_MAX_DESCRIPTOR_SIZE));
    bytes[0] = id;
    const int size = ::ioctl(file_.get(), HIDIOCGFEATURE(bytes.size()), bytes.data());
    if (size < 0) return node_error(node_, "asked", errno);
    bytes.resize(std::min(bytes.size(), static_cast<std::size_t>(size)));
    return bytes;
  }

 private:
  std::string node_;
  FileHandle file_;
  std::unique_ptr<UsbDevice> usb_;
};

}  // namespace

Expected<std::unique_ptr<DeviceControl>> open_hidraw_control(const std::string& node) {
  FileHandle file(::open(node.c_str(), O_RDWR | O_CLOEXEC));
  if (!file) return node_error(node, "opened for writing", errno);
  return std::make_unique<HidrawControl>(node, std::move(file));
}

std::optional<std::string> usb_node_above(const std::string& hidraw_node) {
  const auto node = SysfsDevice::find("", "/class/hidraw", fs::path(hidraw_node).filename());
  const auto usb = node ? node->above("usb", "usb_device") : std::nullopt;
  return usb ? usb_node(*usb) : std::nullopt;
}

}  // namespace limn
