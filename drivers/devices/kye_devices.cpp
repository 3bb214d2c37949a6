#include "drivers/devices/pen_tables.hpp"

namespace limn {
namespace {

using F = PenFamily;

constexpr double per_mm(double lines_per_inch) { return lines_per_inch / 25.4; }

// Ranges: Linux's hid-kye and the DIGImend drivers, which replace these tablets' descriptors.
// The reports of a tablet that was not initialised (kKyeMouse): recorded.
// clang-format off
constexpr PenSpec kPens[] = {
    {.vendor = 0x0458, .product = 0x5010, .name = "Genius EasyPen i405X",      .family = F::kKye,      .x_max = 14080, .y_max = 10240, .pressure_max = 1023, .counts_per_mm = per_mm(2560), .evidence = "hid-kye"},
    {.vendor = 0x0458, .product = 0x5011, .name = "Genius MousePen i608X",     .family = F::kKye,      .x_max = 20480, .y_max = 15360, .pressure_max = 1023, .counts_per_mm = per_mm(2560), .evidence = "hid-kye, capture kye_mousepen_i608x_v1"},
    {.vendor = 0x0458, .product = 0x5013, .name = "Genius EasyPen M610X",      .family = F::kKye,      .x_max = 40960, .y_max = 25600, .pressure_max = 1023, .counts_per_mm = per_mm(4096), .evidence = "hid-kye"},
    {.vendor = 0x0458, .product = 0x5015, .name = "Genius PenSketch M912",     .family = F::kKye,      .x_max = 61440, .y_max = 46080, .pressure_max = 2047, .counts_per_mm = per_mm(5120), .evidence = "hid-kye"},
    {.vendor = 0x0458, .product = 0x5015, .name = "Genius PenSketch M912",     .family = F::kKyeMouse, .x_max = 30720, .y_max = 23040,                       .counts_per_mm = per_mm(2560), .evidence = "recording KYE_PenSketch_M912"},
    {.vendor = 0x0458, .product = 0x5019, .name = "Genius EasyPen M406XE",     .family = F::kKye,      .x_max = 15360, .y_max = 10240, .pressure_max = 1023, .counts_per_mm = per_mm(2560), .evidence = "DIGImend hid-kye"},
    {.vendor = 0x0458, .product = 0x501A, .name = "Genius MousePen i608X v2",  .family = F::kKye,      .x_max = 40960, .y_max = 30720, .pressure_max = 2047, .counts_per_mm = per_mm(5120), .evidence = "DIGImend hid-kye"},
};
// clang-format on

}  // namespace

std::span<const PenSpec> kye_pens() noexcept { return kPens; }

}  // namespace limn
