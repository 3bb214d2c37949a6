#include "firmware_sim/link/linux_name.hpp"

namespace limn::firmware {

std::string linux_name(const DeviceSpec& spec) {
  std::string name(spec.manufacturer);
  if (!name.empty() && !spec.product_name.empty()) name += ' ';
  return name += spec.product_name;
}

std::string physical_path(std::uint8_t interface, const std::string& link) {
  return "limn/simulated" + link + "/input" + std::to_string(interface);
}

}  // namespace limn::firmware
