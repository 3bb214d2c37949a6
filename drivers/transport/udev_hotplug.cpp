#include "drivers/transport/udev_hotplug.hpp"

#include <libudev.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <iterator>
#include <mutex>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "drivers/transport/file_handle.hpp"
#include "drivers/transport/open_device.hpp"

namespace limn {
namespace {

template <auto kRelease>
struct Release {
  template <class T>
  void operator()(T* object) const noexcept {
    kRelease(object);
  }
};
using Udev = std::unique_ptr<udev, Release<udev_unref>>;
using UdevMonitor = std::unique_ptr<udev_monitor, Release<udev_monitor_unref>>;
using UdevDevice = std::unique_ptr<udev_device, Release<udev_device_unref>>;

std::string_view text_of(const char* text) noexcept { return text == nullptr ? "" : text; }

/// Whether the event is about this device: about its node, or about its interface of a USB device.
bool is_about(udev_device* event, const ListedDevice& listed) {
  if (text_of(udev_device_get_devnode(event)) == listed.node) return true;
  udev_device* parent = udev_device_get_parent_with_subsystem_devtype(event, "usb", "usb_device");
  if (parent == nullptr || text_of(udev_device_get_devnode(parent)) != listed.node) return false;
  const std::string_view digits = text_of(udev_device_get_sysattr_value(event, "bInterfaceNumber"));
  int number = -1;
  std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
  return number == listed.interface_number;
}

/// The subsystem of udev whose devices are a backend's rows; "" where none is.
std::string_view subsystem_of(Backend backend) noexcept {
  switch (backend) {
    case Backend::kHidraw:
      return "hidraw";
    case Backend::kUsb:
      return "usb";
    case Backend::kEvdev:
      return "input";
    case Backend::kSpnav:
      break;
  }
  return "";
}

}  // namespace

class DeviceNews {
 public:
  DeviceNews(Udev context, UdevMonitor monitor)
      : context_(std::move(context)), monitor_(std::move(monitor)) {}

  int poll_descriptor() const noexcept { return udev_monitor_get_fd(monitor_.get()); }
  UdevDevice next() noexcept { return UdevDevice(udev_monitor_receive_device(monitor_.get())); }

 private:
  Udev context_;
  UdevMonitor monitor_;
};

namespace {

class UdevHotplug final : public Hotplug {
 public:
  UdevHotplug(std::shared_ptr<DeviceNews> news, DeviceWatch watch)
      : news_(std::move(news)), watch_(std::move(watch)) {}

  ~UdevHotplug() override {
    if (!thread_.joinable()) return;
    signal(stop_);
    thread_.join();
  }

  Expected<void> start() {
    if (!stop_ || !ready_) return refused("the system gives no event descriptor");
    try {
      thread_ = std::thread([this] { run(); });
    } catch (const std::system_error& error) {
      return refused(std::string("no thread: ") + error.what());
    }
    return {};
  }

  int poll_descriptor() const noexcept override { return ready_.get(); }

  std::vector<std::unique_ptr<Transport>> arrived() override {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t size = ::read(ready_.get(), &count, sizeof count);
    const std::lock_guard lock(mutex_);
    return std::exchange(opened_, {});
  }

 private:
  static tl::unexpected<Error> refused(std::string what) {
    return fail(ErrorCode::kIo, "", std::move(what), "close other programs");
  }

  static void signal(const FileHandle& descriptor) noexcept {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(descriptor.get(), &one, sizeof one);
  }

  void run() {
    pollfd polled[] = {{stop_.get(), POLLIN, 0}, {news_->poll_descriptor(), POLLIN, 0}};
    for (;;) {
      if (::poll(polled, std::size(polled), -1) < 0 && errno != EINTR) return;
      if (polled[0].revents != 0) return;
      if (polled[1].revents == 0) continue;
      const UdevDevice event = news_->next();
      if (event && text_of(udev_device_get_action(event.get())) == "add") take(event.get());
    }
  }

  void take(udev_device* event) {
    const std::string_view subsystem = text_of(udev_device_get_subsystem(event));
    for (const Backend backend : watch_.backends) {
      if (subsystem == subsystem_of(backend)) take(event, backend);
    }
  }

  void take(udev_device* event, Backend backend) {
    const std::string node(text_of(udev_device_get_devnode(event)));
    if (backend == Backend::kHidraw && node.empty()) return;  // the event is no node's
    const auto devices =
        backend == Backend::kHidraw ? list_hid_devices(node) : list_devices_of(backend);
    if (!devices) return;
    for (const ListedDevice& listed : *devices) {
      if (!is_about(event, listed) || !watch_.wanted(listed)) continue;
      if (is_full()) return;
      auto transport = watch_.open(listed);
      if (!transport) continue;
      const std::lock_guard lock(mutex_);
      opened_.push_back(std::move(transport));
      signal(ready_);
    }
  }

  bool is_full() {
    const std::lock_guard lock(mutex_);
    return opened_.size() >= kMaxTraceDevices;
  }

  std::shared_ptr<DeviceNews> news_;  // of the thread alone
  DeviceWatch watch_;
  FileHandle stop_{::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};   // to the thread
  FileHandle ready_{::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};  // from the thread
  std::mutex mutex_;
  std::vector<std::unique_ptr<Transport>> opened_;  // not taken yet
  std::thread thread_;
};

}  // namespace

Expected<std::shared_ptr<DeviceNews>> listen_for_devices() {
  Udev context(udev_new());
  UdevMonitor monitor(context ? udev_monitor_new_from_netlink(context.get(), "udev") : nullptr);
  bool heard = monitor != nullptr;
  for (const Backend backend : {Backend::kHidraw, Backend::kEvdev, Backend::kUsb}) {
    const char* const type = backend == Backend::kUsb ? "usb_interface" : nullptr;
    heard = heard && udev_monitor_filter_add_match_subsystem_devtype(
                         monitor.get(), subsystem_of(backend).data(), type) >= 0;
  }
  if (!heard || udev_monitor_enable_receiving(monitor.get()) < 0) {
    return fail(ErrorCode::kIo, "", "udev cannot be asked for new devices",
                "plug devices in beforehand");
  }
  return std::make_shared<DeviceNews>(std::move(context), std::move(monitor));
}

Expected<std::unique_ptr<Hotplug>> watch_devices(DeviceWatch watch,
                                                 std::shared_ptr<DeviceNews> heard) {
  if (!heard) {
    auto listening = listen_for_devices();
    if (!listening) return tl::unexpected(std::move(listening.error()));
    heard = *std::move(listening);
  }
  auto hotplug = std::make_unique<UdevHotplug>(std::move(heard), std::move(watch));
  if (auto started = hotplug->start(); !started) return tl::unexpected(std::move(started.error()));
  return hotplug;
}

}  // namespace limn
