#include "drivers/transport/open_device.hpp"

#include <utility>

#include "drivers/transport/hidraw_control.hpp"
#include "drivers/transport/hidraw_transport.hpp"
#include "drivers/transport/pen_setup.hpp"
#include "drivers/transport/usb_transport.hpp"

namespace limn {
namespace {

/// The sequence to which this interface of the device reports, if any.
const PenInitialization* initialization_of(const ListedDevice& listed) {
  const PenInitialization* sequence =
      find_pen_initialization(listed.device.vendor, listed.device.product);
  const bool here = sequence != nullptr && listed.interface_number == sequence->interface_number;
  return here ? sequence : nullptr;
}

/// What a set-up leaves for the stream.
struct Learnt {
  std::vector<std::string> notes;
  std::optional<Error> trouble;
};

Learnt set_up(const PenInitialization* sequence, DeviceControl& control) {
  if (sequence == nullptr) return {};
  PenSetup setup = set_up_pen(*sequence, control);
  return {std::move(setup.notes), std::move(setup.trouble)};
}

OpenedDevice told(std::unique_ptr<Transport> transport, Learnt learnt) {
  for (std::string& note : learnt.notes) transport->add_note(std::move(note));
  return {std::move(transport), std::move(learnt.trouble)};
}

Expected<OpenedDevice> open_by_hidraw(const ListedDevice& listed,
                                      const PenInitialization* sequence) {
  // A driver of the device's own has set it up, and its reports pass through that driver.
  if (listed.driver != "hid-generic") sequence = nullptr;
  Learnt learnt;
  if (sequence != nullptr) {
    auto control = open_hidraw_control(listed.node);
    if (control) {
      learnt = set_up(sequence, **control);
    } else {
      learnt.trouble = std::move(control.error());
    }
  }
  auto transport = open_hidraw(listed.node);  // last: no report from before the set-up
  if (!transport) return tl::unexpected(std::move(transport.error()));
  return told(*std::move(transport), std::move(learnt));
}

Expected<OpenedDevice> open_by_usb(const ListedDevice& listed, const PenInitialization* sequence) {
  auto interface = UsbInterface::claim(listed);
  if (!interface) return tl::unexpected(std::move(interface.error()));
  Learnt learnt = set_up(sequence, **interface);
  auto transport = open_usb(*std::move(interface));
  if (!transport) return tl::unexpected(std::move(transport.error()));
  return told(*std::move(transport), std::move(learnt));
}

}  // namespace

Expected<std::vector<ListedDevice>> list_devices_of(Backend backend) {
  return backend == Backend::kUsb ? list_usb_devices() : list_hid_devices();
}

Expected<OpenedDevice> open_device(const ListedDevice& listed, bool initialize) {
  const PenInitialization* sequence = initialize ? initialization_of(listed) : nullptr;
  return listed.backend == Backend::kUsb ? open_by_usb(listed, sequence)
                                         : open_by_hidraw(listed, sequence);
}

}  // namespace limn
