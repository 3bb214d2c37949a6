#include "modeler/app/device_selection.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <system_error>
#include <utility>

#include "drivers/devices/pen_initialization.hpp"
#include "drivers/devices/pen_spec.hpp"
#include "modeler/app/option_values.hpp"

namespace limn::app {
namespace {

bool has_ids(const ListedDevice& one, const DeviceId& id) {
  return one.device.vendor == id.vendor && one.device.product == id.product;
}

/// One that comes back comes to the same place.
bool is_in_place_of(const ListedDevice& one, const ListedDevice& other) {
  return one.device.vendor == other.device.vendor && one.device.product == other.device.product &&
         one.device.physical_path == other.device.physical_path;
}

}  // namespace

DeviceTraits traits_of(const ListedDevice& listed) {
  DeviceTraits traits = limn::traits_of(listed.device);
  if (listed.backend == Backend::kSpnav) traits = {DeviceKind::k3dMouse, "3D mouse", {}, {}};
  const bool mere_axes = listed.backend == Backend::kEvdev && !listed.tablet;
  if (mere_axes && traits.kind == DeviceKind::kPen) return {};
  if (traits.kind != DeviceKind::kOther) return traits;
  const PenInitialization* sequence =
      find_pen_initialization(listed.device.vendor, listed.device.product);
  const bool by_reports = listed.backend == Backend::kHidraw || listed.backend == Backend::kUsb;
  if (by_reports && sequence != nullptr && sequence->interface_number == listed.interface_number) {
    return {DeviceKind::kPen, name(sequence->family), {}, {}};
  }
  return traits;
}

std::optional<DeviceId> parse_device_id(const std::string& text) {
  DeviceId id;
  std::string ids = text;
  const auto first = text.find(':');
  const auto second = first == std::string::npos ? first : text.find(':', first + 1);
  if (second != std::string::npos) {
    const char* const end = text.data() + text.size();
    std::size_t ordinal = 0;
    const auto parsed = std::from_chars(text.data() + second + 1, end, ordinal);
    if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
    id.ordinal = ordinal;
    ids = text.substr(0, second);
  }
  if (!parse_id(ids, id.vendor, id.product).empty()) return std::nullopt;
  return id;
}

std::vector<ListedDevice> devices_named(const std::vector<ListedDevice>& listed,
                                        const std::optional<DeviceId>& id,
                                        std::optional<Backend> backend, DeviceKind kind) {
  if (backend == Backend::kSpnav) return listed;
  std::vector<ListedDevice> chosen;
  std::vector<ListedDevice> others;
  for (const ListedDevice& one : listed) {
    const DeviceKind its = traits_of(one).kind;
    if (id ? !has_ids(one, *id) : its != kind) continue;
    if (its != DeviceKind::kOther) {
      chosen.push_back(one);
    } else if (one.backend == Backend::kHidraw || one.backend == Backend::kUsb) {
      others.push_back(one);
    }
  }
  if (chosen.empty()) chosen = std::move(others);
  if (!id || !id->ordinal) return chosen;
  return *id->ordinal < chosen.size() ? std::vector{chosen[*id->ordinal]}
                                      : std::vector<ListedDevice>();
}

std::vector<ListedDevice> without_spacenavd(std::vector<ListedDevice> listed) {
  listed.erase(
      std::remove_if(listed.begin(), listed.end(),
                     [](const ListedDevice& one) { return one.backend == Backend::kSpnav; }),
      listed.end());
  return listed;
}

std::vector<ListedDevice> pen_interfaces(std::vector<ListedDevice> rows) {
  const auto keep = [&rows](auto is_pen) {
    std::vector<ListedDevice> kept;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(kept), is_pen);
    if (!kept.empty()) rows = std::move(kept);
  };
  keep([](const ListedDevice& one) { return traits_of(one).kind == DeviceKind::kPen; });
  keep([](const ListedDevice& one) {
    const PenInitialization* sequence =
        find_pen_initialization(one.device.vendor, one.device.product);
    return sequence != nullptr && sequence->interface_number == one.interface_number;
  });
  return rows;
}

LaterDevices::LaterDevices(std::optional<Backend> asked, std::optional<DeviceId> id,
                           std::vector<ListedDevice> chosen, DeviceKind kind)
    : asked_(asked), id_(id), kind_(kind), chosen_(std::move(chosen)) {
  add(asked_.value_or(Backend::kHidraw));
  for (const ListedDevice& one : chosen_) add(one.backend);
}

bool LaterDevices::wants(const ListedDevice& one) const {
  const bool came_back =
      std::any_of(chosen_.begin(), chosen_.end(), [&one](const ListedDevice& before) {
        return is_in_place_of(one, before) && one.backend == before.backend &&
               one.interface_number == before.interface_number &&
               one.device.name == before.device.name;
      });
  if (came_back) return true;
  if (id_ && id_->ordinal) return false;  // that very device
  if (!asked_ && one.backend != Backend::kHidraw) return false;
  const auto is_known = [](const ListedDevice& it) {
    return traits_of(it).kind != DeviceKind::kOther;
  };
  const bool any_known = std::any_of(chosen_.begin(), chosen_.end(), is_known);
  if (any_known && !is_known(one)) return false;  // another interface of it
  const bool on_other_side =
      std::any_of(chosen_.begin(), chosen_.end(), [&one](const ListedDevice& before) {
        return is_in_place_of(one, before) && one.backend != before.backend;
      });
  return !on_other_side && !devices_named({one}, id_, asked_, kind_).empty();
}

void LaterDevices::add(Backend backend) {
  const bool known = std::find(backends_.begin(), backends_.end(), backend) != backends_.end();
  if (backend != Backend::kSpnav && !known) backends_.push_back(backend);
}

}  // namespace limn::app
