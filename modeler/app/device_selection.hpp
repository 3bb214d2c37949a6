#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/devices/device_traits.hpp"
#include "drivers/transport/device_listing.hpp"

namespace limn::app {

/// What a listed device is to limn, or what its initialisation makes of it. Of event nodes only
/// what udev calls a tablet is a pen.
DeviceTraits traits_of(const ListedDevice& listed);

/// VID:PID[:N] as typed: N counts, from 0, those that `limn devices` lists with these ids.
struct DeviceId {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::optional<std::size_t> ordinal;
};

/// Nothing for text of another form.
std::optional<DeviceId> parse_device_id(const std::string& text);

/// What to open without being told a node: what `limn devices` lists with the ids, else all of
/// `kind`, and of spacenavd, asked for by name, whatever it has. Ids that no pen and no 3D mouse
/// has may still be of a device whose reports are to be recorded.
std::vector<ListedDevice> devices_named(const std::vector<ListedDevice>& listed,
                                        const std::optional<DeviceId>& id,
                                        std::optional<Backend> backend,
                                        DeviceKind kind = DeviceKind::kPen);

/// Without the rows of spacenavd, which a file may stand for that nobody listens to.
std::vector<ListedDevice> without_spacenavd(std::vector<ListedDevice> listed);

/// Of the interfaces of one USB device the pen's: the one of its initialisation, else one whose
/// reports are a pen's; all where neither is known.
std::vector<ListedDevice> pen_interfaces(std::vector<ListedDevice> rows);

/// What is opened when it comes later: on a backend that was asked for all that is wanted, else
/// what comes on hidraw; and what was read by another backend, by that again. Of VID:PID:N that
/// very device, known by its ids, name, place and backend, not its twin.
class LaterDevices {
 public:
  LaterDevices(std::optional<Backend> asked, std::optional<DeviceId> id,
               std::vector<ListedDevice> chosen, DeviceKind kind = DeviceKind::kPen);

  /// Where to wait; empty: nobody can be waited for.
  const std::vector<Backend>& backends() const noexcept { return backends_; }

  bool wants(const ListedDevice& one) const;

 private:
  void add(Backend backend);

  std::optional<Backend> asked_;
  std::optional<DeviceId> id_;
  DeviceKind kind_;
  std::vector<ListedDevice> chosen_;
  std::vector<Backend> backends_;
};

}  // namespace limn::app
