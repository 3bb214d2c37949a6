#include "drivers/spnav_server/spnav_device.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace limn {
namespace {

struct Product {
  std::uint16_t vendor;
  std::uint16_t product;
  std::int32_t type;
};

constexpr std::uint16_t kLogitech = 0x046D;
constexpr std::uint16_t k3Dconnexion = 0x256F;

// Types as libspnav's spnav.h numbers them.
constexpr std::array kProducts = {
    Product{kLogitech, 0xC603, 0x200},     // SpaceMouse Plus XT
    Product{kLogitech, 0xC605, 0x201},     // CadMan
    Product{kLogitech, 0xC606, 0x202},     // SpaceMouse Classic
    Product{kLogitech, 0xC621, 0x203},     // Spaceball 5000
    Product{kLogitech, 0xC623, 0x204},     // Space Traveler
    Product{kLogitech, 0xC625, 0x205},     // SpacePilot
    Product{kLogitech, 0xC626, 0x206},     // SpaceNavigator
    Product{kLogitech, 0xC627, 0x207},     // SpaceExplorer
    Product{kLogitech, 0xC628, 0x208},     // SpaceNavigator for Notebooks
    Product{kLogitech, 0xC629, 0x209},     // SpacePilot Pro
    Product{kLogitech, 0xC62B, 0x20A},     // SpaceMouse Pro
    Product{kLogitech, 0xC640, 0x20B},     // NuLOOQ
    Product{k3Dconnexion, 0xC62E, 0x20C},  // SpaceMouse Wireless, by cable
    Product{k3Dconnexion, 0xC62F, 0x20C},  // and by its receiver
    Product{k3Dconnexion, 0xC631, 0x20D},  // SpaceMouse Pro Wireless, by cable
    Product{k3Dconnexion, 0xC632, 0x20D},  // and by its receiver
    Product{k3Dconnexion, 0xC633, 0x20E},  // SpaceMouse Enterprise
    Product{k3Dconnexion, 0xC635, 0x20F},  // SpaceMouse Compact
    Product{k3Dconnexion, 0xC636, 0x210},  // SpaceMouse Module
};

// The numbers of their buttons in the order in which spacenavd 1.2 counts them (dev.c, bnhack_..):
// keys 1 and so on, menu, fit, T, R, F, roll, ..
constexpr std::uint8_t kProButtons[] = {13, 14, 15, 16, 1, 2, 3, 5, 6, 9, 27, 23, 24, 25, 26};
constexpr std::uint8_t kEnterpriseButtons[] = {13, 14, 15, 16,  17,  18,  19,  20,  21, 22, 77,
                                               78, 1,  2,  3,   5,   6,   9,   23,  24, 25, 26,
                                               27, 36, 37, 175, 176, 103, 104, 105, 11};

std::span<const std::uint8_t> buttons_of(std::int32_t type) noexcept {
  constexpr std::int32_t kPro = 0x20A;
  constexpr std::int32_t kProWireless = 0x20D;
  constexpr std::int32_t kEnterprise = 0x20E;
  if (type == kPro || type == kProWireless) return kProButtons;
  if (type == kEnterprise) return kEnterpriseButtons;
  return {};
}

}  // namespace

std::optional<unsigned> spnav_button(std::uint16_t vendor, std::uint16_t product,
                                     unsigned number) noexcept {
  const auto known = buttons_of(spnav_device_type(vendor, product));
  if (known.empty()) return number - 1;
  const auto found = std::find(known.begin(), known.end(), number);
  if (found == known.end()) return std::nullopt;
  return static_cast<unsigned>(found - known.begin());
}

std::int32_t spnav_device_type(std::uint16_t vendor, std::uint16_t product) noexcept {
  const auto found = std::find_if(kProducts.begin(), kProducts.end(), [&](const Product& one) {
    return one.vendor == vendor && one.product == product;
  });
  return found != kProducts.end() ? found->type : 0;
}

}  // namespace limn
