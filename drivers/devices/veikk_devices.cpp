#include "drivers/devices/pen_tables.hpp"

namespace limn {
namespace {

using F = PenFamily;

constexpr double kPerMm = 200;  // 5080 lines an inch, all of them

// Ranges after initialisation: OpenTabletDriver's configurations. Its A15 and A30 differ by 1270
// counts of height between firmwares; the rows have the smaller, which the A30's maker states too.
// clang-format off
constexpr PenSpec kPens[] = {
    {.vendor = 0x2FEB, .product = 0x0001, .name = "VEIKK S640",      .family = F::kVeikk,      .x_max = 30480, .y_max = 20320, .pressure_max = 8191, .counts_per_mm = kPerMm, .evidence = "OpenTabletDriver"},
    {.vendor = 0x2FEB, .product = 0x0002, .name = "VEIKK A30",       .family = F::kVeikk,      .x_max = 50800, .y_max = 30480, .pressure_max = 8191, .counts_per_mm = kPerMm, .evidence = "OpenTabletDriver"},
    {.vendor = 0x2FEB, .product = 0x0002, .name = "VEIKK A30",       .family = F::kPenAsMouse, .x_max = 32767, .y_max = 32767, .pressure_max = 8191, .counts_per_mm = 32767 / 254.0, .counts_per_mm_y = 32767 / 152.4, .leaves_silently = true, .report_id = 0x01, .evidence = "recording VEIKK_A30"},
    {.vendor = 0x2FEB, .product = 0x0003, .name = "VEIKK A50",       .family = F::kVeikk,      .x_max = 50800, .y_max = 30480, .pressure_max = 8191, .counts_per_mm = kPerMm, .evidence = "OpenTabletDriver"},
    {.vendor = 0x2FEB, .product = 0x0004, .name = "VEIKK A15",       .family = F::kVeikk,      .x_max = 50800, .y_max = 30480, .pressure_max = 8191, .counts_per_mm = kPerMm, .evidence = "OpenTabletDriver"},
    {.vendor = 0x2FEB, .product = 0x0005, .name = "VEIKK VK640",     .family = F::kVeikk,      .x_max = 30480, .y_max = 20320, .pressure_max = 8191, .counts_per_mm = kPerMm, .tilt = true, .evidence = "OpenTabletDriver"},
    {.vendor = 0x2FEB, .product = 0x0006, .name = "VEIKK A15 Pro",   .family = F::kVeikk,      .x_max = 50800, .y_max = 30480, .pressure_max = 8191, .counts_per_mm = kPerMm, .tilt = true, .evidence = "OpenTabletDriver"},
    {.vendor = 0x2FEB, .product = 0x0007, .name = "VEIKK VK1060PRO", .family = F::kVeikk,      .x_max = 50800, .y_max = 31750, .pressure_max = 8191, .counts_per_mm = kPerMm, .evidence = "OpenTabletDriver"},
    {.vendor = 0x2FEB, .product = 0x0008, .name = "VEIKK VK1060",    .family = F::kVeikk,      .x_max = 50800, .y_max = 31750, .pressure_max = 8191, .counts_per_mm = kPerMm, .tilt = true, .evidence = "OpenTabletDriver"},
    {.vendor = 0x2FEB, .product = 0x0009, .name = "VEIKK VK430",     .family = F::kVeikk,      .x_max = 20320, .y_max = 15240, .pressure_max = 8191, .counts_per_mm = kPerMm, .evidence = "OpenTabletDriver"},
    {.vendor = 0x2FEB, .product = 0x000B, .name = "VEIKK Voila",     .family = F::kVeikk,      .x_max = 50800, .y_max = 31750, .pressure_max = 8191, .counts_per_mm = kPerMm, .evidence = "OpenTabletDriver"},
};
// clang-format on

}  // namespace

std::span<const PenSpec> veikk_pens() noexcept { return kPens; }

}  // namespace limn
