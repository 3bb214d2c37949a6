#include "drivers/devices/pen_tables.hpp"

namespace limn {
namespace {

using F = PenFamily;

constexpr std::uint16_t kUgee = 0x28BD;

constexpr std::string_view kOtd = "OpenTabletDriver";

struct Row {
  std::uint16_t product;
  std::string_view name;
  PenFamily family;
  std::int32_t x_max;
  std::int32_t y_max;
  std::int32_t pressure_max;
  int lines_per_inch;
  bool tilt;
  std::string_view evidence;
};

// Deco 01 V2, Deco 01 V3, Star G430S and G640 changed their resolution with their firmware: the
// rows have the older one (for Deco 01 V2 that of the tablet probed), and string 100 corrects them.
// clang-format off
constexpr Row kRows[] = {
    // product, name, family, x max, y max, pressure max, lines an inch, tilt, evidence
    {0x000B, "XP-Pen Artist 13.3",            F::kUcLogicV1,   29376, 16524,  8191, 2540, false, kOtd},
    {0x000C, "XP-Pen Artist 15.6",            F::kUcLogicV1,   34419, 19461,  8191, 2540, false, kOtd},
    {0x0042, "XP-Pen Deco 01",                F::kUcLogicV1,   25400, 15875,  8191, 2540, false, kOtd},
    {0x0062, "XP-Pen Star 06C",               F::kUcLogicV1,   50800, 30480,  8191, 5080, false, kOtd},
    {0x0071, "XP-Pen Star 05 V3",             F::kUcLogicV1,   40640, 25400,  8191, 5080, false, kOtd},
    {0x0077, "XP-Pen Star 03 Pro",            F::kUcLogicV1,   50800, 30480,  8191, 5080, false, kOtd},
    {0x0078, "XP-Pen Star 06",                F::kUcLogicV1,   50800, 30480,  8191, 5080, false, "probe XP-Pen_Star_06"},
    {0x0094, "XP-Pen Star G640",              F::kUcLogicV1,   32000, 20000,  8191, 5080, false, kOtd},
    {0x0096, "XP-Pen Deco 03",                F::kUcLogicV1,   50800, 28575,  8191, 5080, false, kOtd},
    {0x080A, "XP-Pen Artist 12",              F::kUgee,        25632, 14418,  8191, 2540, true,  kOtd},
    {0x0902, "XP-Pen Deco 01 V2",             F::kUgee,        50800, 31750,  8191, 5080, true,  kOtd},
    {0x0904, "XP-Pen Deco Pro Medium",        F::kUgee,        55798, 31399,  8191, 5080, true,  kOtd},
    {0x0905, "XP-Pen Deco 01 V2",             F::kUgee,        25400, 15875,  8191, 2540, true,  "probe XP-Pen_Deco_01_v2_revb"},
    {0x0906, "XP-Pen Star G640S",             F::kUgee,        32999, 20599,  8191, 5080, true,  kOtd},
    {0x0907, "UGEE M708 v2, XP-Pen Star 03",  F::kUgee,        50800, 30480,  8191, 5080, true,  "probe Ugee_M708_v2"},
    {0x0909, "XP-Pen Deco Pro Small",         F::kUgee,        46024, 25908,  8191, 5080, true,  kOtd},
    {0x090D, "XP-Pen Artist 15.6 Pro",        F::kUgee,        34416, 19359,  8191, 2540, true,  kOtd},
    {0x0913, "XP-Pen Star G430S",             F::kUgee,        20320, 15240,  8191, 5080, true,  kOtd},
    {0x0914, "XP-Pen Star G640",              F::kUgee,        32000, 20000,  8191, 5080, true,  kOtd},
    {0x0917, "XP-Pen Star G960S",             F::kUgee,        22860, 15240,  8191, 2540, true,  kOtd},
    {0x0918, "XP-Pen Star G960S Plus",        F::kUgee,        22860, 15240,  8191, 2540, true,  kOtd},
    {0x091A, "XP-Pen Artist 15.6",            F::kUgee,        34419, 19461,  8191, 2540, true,  kOtd},
    {0x091B, "XP-Pen Artist 22R Pro",         F::kUgee,        47664, 26778,  8191, 2540, true,  kOtd},
    {0x091F, "XP-Pen Artist 12 Pro",          F::kUgee,        25634, 14415,  8191, 2540, true,  kOtd},
    {0x0920, "XP-Pen Star G960",              F::kUgee,        22352, 13970,  8191, 2540, true,  kOtd},
    {0x0924, "UGEE M708 V2",                  F::kUgee,        50800, 30480,  8191, 5080, true,  kOtd},
    {0x0928, "XP-Pen Deco mini7",             F::kUgee,        35560, 22219,  8191, 5080, true,  kOtd},
    {0x0929, "XP-Pen Deco mini4",             F::kUgee,        20320, 15240,  8191, 5080, true,  kOtd},
    {0x092B, "XP-Pen Artist 13.3 Pro",        F::kUgee,        29362, 16510,  8191, 2540, true,  kOtd},
    {0x092C, "XP-Pen Innovator 16",           F::kUgee,        68783, 38709,  8191, 5080, true,  kOtd},
    {0x092D, "XP-Pen Artist 24 Pro",          F::kUgee,       105370, 59270,  8191, 5080, true,  kOtd},
    {0x092E, "XP-Pen Artist Pro 16TP",        F::kUgee,        69123, 38877,  8191, 5080, true,  kOtd},
    {0x092F, "XP-Pen Artist 22 (2nd Gen)",    F::kUgee,        47664, 26778,  8191, 2540, true,  kOtd},
    {0x0930, "XP-Pen Deco Fun XS",    F::kUgee,        24384, 15240,  8191, 5080, true,  kOtd},
    {0x0931, "XP-Pen Deco Fun S (CT640)",     F::kUgee,        32000, 20320,  8191, 5080, true,  kOtd},
    {0x0932, "XP-Pen Deco Fun L (CT1060)",    F::kUgee,        50901, 31861,  8191, 5080, true,  kOtd},
    {0x0933, "XP-Pen Deco Pro SW",            F::kUgee,        46024, 25908,  8191, 5080, true,  kOtd},
    {0x0934, "XP-Pen Deco Pro MW",            F::kUgee,        55798, 31399,  8191, 5080, true,  kOtd},
    {0x0935, "XP-Pen Deco L",                 F::kUgee,        50800, 30480,  8191, 5080, true,  kOtd},
    {0x0936, "XP-Pen Deco M",                 F::kUgee,        40640, 25400,  8191, 5080, true,  kOtd},
    {0x0937, "UGEE S640",                     F::kUgee,        31998, 19994,  8191, 5080, true,  kOtd},
    {0x0938, "UGEE S1060",                    F::kUgee,        50800, 32000,  8191, 5080, true,  kOtd},
    {0x093A, "XP-Pen Artist 24",              F::kUgee,       105370, 59270,  8191, 5080, true,  kOtd},
    {0x093B, "UGEE U1200",                    F::kUgee,        52644, 29611,  8191, 5080, true,  kOtd},
    {0x093C, "UGEE U1600",                    F::kUgee,        68828, 38714,  8191, 5080, true,  kOtd},
    {0x0942, "XP-Pen Deco Pro MW Gen2",       F::kUgeeGen2,    45801, 28600, 16383, 5080, true,  kOtd},
    {0x0943, "XP-Pen Deco Pro LW Gen2",       F::kUgeeGen2,    55798, 34798, 16383, 5080, true,  kOtd},
    {0x0944, "XP-Pen Deco Pro XLW Gen2",      F::kUgeeGen2,    76200, 45801, 16383, 5080, true,  kOtd},
    {0x0947, "XP-Pen Deco 01 V3",             F::kUgee,        50800, 31750, 16383, 5080, true,  kOtd},
    {0x0948, "XP-Pen Deco mini7 V2",          F::kUgee,        35595, 22219, 16383, 5080, true,  kOtd},
    {0x094A, "XP-Pen Artist 12 (2nd Gen)",    F::kUgee,        52638, 29616,  8191, 5080, true,  kOtd},
    {0x094B, "XP-Pen Artist 16 Pro",          F::kUgee,        68214, 38359,  8191, 5080, true,  kOtd},
    {0x094C, "XP-Pen Artist 16 (2nd Gen)",    F::kUgee,        68198, 38362,  8191, 5080, true,  kOtd},
    {0x094D, "XP-Pen Artist 10 (2nd Gen)",    F::kUgee,        44902, 25339,  8191, 5080, true,  kOtd},
    {0x094E, "XP-Pen Artist 13 (2nd Gen)",    F::kUgee,        58760, 33040,  8191, 5080, true,  kOtd},
    {0x095A, "XP-Pen Artist Pro 14 (Gen2)",   F::kUgeeGen2,    60320, 37698, 16383, 5080, true,  kOtd},
    {0x095B, "XP-Pen Artist Pro 16 (Gen2)",   F::kUgeeGen2,    68920, 43078, 16383, 5080, true,  kOtd},
    {0x095C, "XP-Pen Artist Pro 24 (Gen2)",   F::kUgeeGen2,   105216, 59182, 16383, 5080, true,  kOtd},
    {0x096A, "XP-Pen Artist Pro 19 (Gen2)",   F::kUgeeGen2,    81793, 46009, 16383, 5080, true,  kOtd},
    {0x096B, "XP-Pen Artist Pro 22 (Gen2)",   F::kUgeeGen2,    95213, 53557, 16383, 5080, true,  kOtd},
    {0x096F, "XP-Pen Artist 15.6 Pro V2",     F::kUgeeGen2,    68199, 38399, 16383, 5080, true,  kOtd},
    {0x2902, "UGEE M908",                     F::kUgee,        50800, 31750, 16383, 5080, true,  kOtd},
    {0x2903, "UGEE M808",                     F::kUgee,        50800, 31750,  8191, 5080, true,  kOtd},
    {0x2904, "XP-Pen Deco 640 (IT640)",       F::kUgee,        31998, 17998, 16383, 5080, true,  kOtd},
    {0x290C, "UGEE UE16",                     F::kUgee,        68199, 38399, 16383, 5080, true,  kOtd},
    {0x1903, "Parblo A610 Pro",               F::kUgee,        51100, 32000,  8191, 5080, true,  kOtd},
};

constexpr PenSpec kOthers[] = {
    {.vendor = kUgee, .product = 0x0075, .name = "XP-Pen Star G430S", .family = F::kUcLogicV1,  .x_max = 20320, .y_max = 15240, .pressure_max = 8191, .counts_per_mm = 200, .product_name = "G430S", .evidence = kOtd},
    {.vendor = kUgee, .product = 0x0075, .name = "XP-Pen Star G540",  .family = F::kUcLogicV1,  .x_max = 45720, .y_max = 29210, .pressure_max = 8191, .counts_per_mm = 200, .product_name = "TABLET G3 5x4", .evidence = kOtd},
    {.vendor = kUgee, .product = 0x0905, .name = "XP-Pen Deco 01 V2", .family = F::kUgee,     .x_max = 32767, .y_max = 32767, .pressure_max = 8191, .counts_per_mm = 32767 / 254.0, .counts_per_mm_y = 32767 / 158.75, .tilt = true, .report_id = 0x07, .evidence = "recording XP-Pen_Deco_01_v2_revb"},
    {.vendor = kUgee, .product = 0x0907, .name = "UGEE M708 v2",      .family = F::kUgee,     .x_max = 50794, .y_max = 30474, .pressure_max = 8191, .counts_per_mm = 200, .report_id = 0x07, .evidence = "recording Ugee_M708_v2"},
    {.vendor = kUgee, .product = 0x0078, .name = "XP-Pen Star 06",    .family = F::kPenAsMouse, .x_max = 32767, .y_max = 32767, .pressure_max = 8191, .counts_per_mm = 32767 / 254.0, .counts_per_mm_y = 32767 / 152.4, .leaves_silently = true, .report_id = 0x09, .evidence = "recording XP-Pen_Star_06"},
};
// clang-format on

}  // namespace

void append_ugee_pens(std::vector<PenSpec>& rows) {
  for (const Row& row : kRows) {
    rows.push_back({.vendor = kUgee,
                    .product = row.product,
                    .name = row.name,
                    .family = row.family,
                    .x_max = row.x_max,
                    .y_max = row.y_max,
                    .pressure_max = row.pressure_max,
                    .counts_per_mm = row.lines_per_inch / 25.4,
                    .tilt = row.tilt,
                    .evidence = row.evidence});
  }
  rows.insert(rows.end(), std::begin(kOthers), std::end(kOthers));
}

}  // namespace limn
