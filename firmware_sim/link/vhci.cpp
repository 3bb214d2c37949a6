#include "firmware_sim/link/vhci.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "firmware_sim/link/file_descriptor.hpp"

namespace limn::firmware {
namespace {

LinkResult<void> vhci_fail(const std::string& path, int error) {
  const std::string what = "cannot write " + path + ": " + std::strerror(error);
  if (error == ENOENT || error == ENOTDIR) {
    return link_fail(what, "load it: sudo modprobe vhci-hcd");
  }
  if (error == EACCES || error == EPERM) return link_fail(what, "run it as root");
  if (error == EBUSY || error == EINVAL) {
    return link_fail(what, "see with 'usbip port' which port is free");
  }
  return link_fail(what, "see what the kernel log says of it");
}

/// One write: sysfs takes a value whole or not at all.
LinkResult<void> write_value(const std::string& path, const std::string& value) {
  const FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file) return vhci_fail(path, errno);
  const ssize_t put = ::write(file.get(), value.data(), value.size());
  if (put != static_cast<ssize_t>(value.size())) return vhci_fail(path, put < 0 ? errno : EIO);
  return {};
}

}  // namespace

LinkResult<void> attach_to_vhci(int socket, std::uint32_t port, const std::string& folder) {
  const std::string value = std::to_string(port) + ' ' + std::to_string(socket) + ' ' +
                            std::to_string(usbip::kDeviceId) + ' ' +
                            std::to_string(usbip::kFullSpeed);
  return write_value(folder + "/attach", value);
}

LinkResult<void> detach_from_vhci(std::uint32_t port, const std::string& folder) {
  return write_value(folder + "/detach", std::to_string(port));
}

}  // namespace limn::firmware
