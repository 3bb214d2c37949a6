#include "drivers/devices/pen_tables.hpp"

namespace limn {
namespace {

using F = PenFamily;

constexpr std::uint16_t kUcLogic = 0x5543;
constexpr std::uint16_t kHuion = 0x256C;

constexpr double per_mm(double lines_per_inch) { return lines_per_inch / 25.4; }

constexpr std::string_view kOtd = "OpenTabletDriver";
// These ids are shared by dozens of models. A tablet that limn initialises says its range (string
// 200) and its model (201); for the reports of another the resolution is right whatever it is,
// because all have 5080 lines an inch, and the range is the recorded tablet's.
constexpr std::string_view kAnyModel = "recording Huion_New_1060_Plus";

/// Speaks with report 8 (kUcLogicV2), at 5080 lines an inch.
struct V2Row {
  std::uint16_t product;
  std::string_view firmware;
  std::string_view name;
  std::int32_t x_max;
  std::int32_t y_max;
  std::int32_t pressure_max;
  bool tilt;
  std::string_view evidence;
};

// clang-format off
constexpr V2Row kV2[] = {
    // product, firmware (string 201), name, x max, y max, pressure max, tilt, evidence
    {0x0060, "",             "Huion Q630M",                   53340, 33340,  8191, true,  kOtd},
    {0x0061, "",             "Huion G930L",                   69088, 43180,  8191, true,  kOtd},
    {0x0066, "",             "Huion H641P",                   32000, 20000,  8191, true,  kOtd},
    {0x0067, "",             "Huion H951P",                   44200, 27600,  8191, true,  kOtd},
    {0x0068, "",             "Huion H1061P",                  53340, 33340,  8191, true,  kOtd},
    {0x006B, "",             "Huion Kamvas Pro 19 (4K)",      81792, 46006, 16383, true,  kOtd},
    {0x006C, "",             "Huion Kamvas Pro 27",          119347, 67132, 16383, true,  kOtd},
    {0x2008, "",             "Huion Kamvas 13 (Gen 3)",       58760, 33040, 16383, true,  kOtd},
    {0x2009, "",             "Huion Kamvas 16 (Gen 3)",       69920, 39340, 16383, true,  kOtd},
    {0x2011, "",             "Huion L310",                    32000, 20000, 16383, true,  kOtd},
    {0x2012, "",             "Huion L610",                    50800, 31750, 16383, true,  kOtd},
    {0x0064, "",             "Huion tablet",                  50800, 31750,  8191, false, kAnyModel},
    {0x006D, "",             "Huion tablet",                  50800, 31750,  8191, false, kAnyModel},
    {0x006E, "",             "Huion tablet",                  50800, 31750,  8191, false, kAnyModel},
    {0x006F, "",             "Huion tablet",                  50800, 31750,  8191, false, kAnyModel},
    {0x006E, "HUION_M165_",  "Huion GT-220 V2",               95336, 53629,  8191, true,  kOtd},
    {0x006E, "HUION_M167_",  "Huion GT-221 Pro",              95346, 53641,  8191, true,  kOtd},
    {0x006E, "HUION_M168_",  "Huion GT-191 V2",               86976, 47736,  8191, true,  kOtd},
    {0x006E, "HUION_M171_",  "Huion Kamvas Pro 12",           53580, 33640,  8191, true,  kOtd},
    {0x006E, "HUION_M174_",  "Huion GT-156HD V2",             68780, 38710,  8191, true,  kOtd},
    {0x006E, "HUION_M175_",  "Huion GT-221",                  95346, 53641,  8191, true,  kOtd},
    {0x006D, "HUION_M182_",  "Huion Kamvas Pro 13",           58752, 33048,  8191, true,  kOtd},
    {0x006D, "HUION_M183_",  "Huion Kamvas Pro 16",           68840, 38720,  8191, true,  kOtd},
    {0x006E, "HUION_M184_",  "Huion Kamvas Pro 24",          105379, 59236,  8191, true,  kOtd},
    {0x006E, "HUION_M189_",  "Huion Kamvas Pro 20",           87075, 47750,  8191, true,  kOtd},
    {0x006D, "HUION_M18e_",  "Huion Kamvas 16",               68840, 38720,  8191, true,  kOtd},
    {0x006E, "HUION_M192_",  "Huion Kamvas 20",               86950, 47750,  8191, true,  kOtd},
    {0x006E, "HUION_M193_",  "Huion Kamvas Pro 20",           87075, 47750,  8191, true,  kOtd},
    {0x006E, "HUION_M194_",  "Huion Kamvas Pro 22 (2019)",    95350, 53644,  8191, true,  kOtd},
    {0x006D, "HUION_M19f_",  "Huion Kamvas 13",               58752, 33048,  8191, true,  kOtd},
    {0x006D, "HUION_M19g_",  "Huion Kamvas 22",               95352, 53645,  8191, true,  kOtd},
    {0x006D, "HUION_M19p_",  "Huion Kamvas 12",               53580, 33640,  8191, true,  kOtd},
    {0x006D, "HUION_M19s_",  "Huion Kamvas 16 (2021)",        68840, 38720,  8191, true,  kOtd},
    {0x006D, "HUION_M19t_",  "Huion Kamvas 22 Plus",          95328, 53622,  8191, true,  kOtd},
    {0x006D, "HUION_M202_",  "Huion Kamvas Pro 16 (4k)",      68840, 38720,  8191, true,  kOtd},
    {0x006D, "HUION_M205_",  "Huion Kamvas 24 Plus",         105370, 59270,  8191, true,  kOtd},
    {0x006D, "HUION_M206_",  "Huion Kamvas 24",              105370, 59270,  8191, true,  kOtd},
    {0x006D, "HUION_M207_",  "Huion Kamvas Pro 24 (4K)",     105370, 59270,  8191, true,  kOtd},
    {0x006D, "HUION_M20a_",  "Huion Kamvas Pro 16 Plus (4k)",  68840, 38720,  8191, true,  kOtd},
    {0x006D, "HUION_M20h_",  "Huion Kamvas 13",               58752, 33048,  8191, true,  kOtd},
    {0x006D, "HUION_M20j_",  "Huion Kamvas Pro 12",           53580, 33640,  8191, true,  kOtd},
    {0x006D, "HUION_M20k_",  "Huion Kamvas Pro 13",           58752, 33048,  8191, true,  kOtd},
    {0x006D, "HUION_M20m_",  "Huion Kamvas Pro 16",           68840, 38720,  8191, true,  kOtd},
    {0x006D, "HUION_M20q_",  "Huion Kamvas Pro 16 (2.5k)",    69926, 39333,  8191, true,  kOtd},
    {0x006D, "HUION_M210_",  "Huion Kamvas Pro 13 (2.5k)",    57293, 35808,  8191, true,  kOtd},
    {0x006D, "HUION_M211_",  "Huion RDS-160",                 68840, 38720,  8191, true,  kOtd},
    {0x006D, "HUION_M213_",  "Huion Kamvas Pro 13 (2.5k)",    57293, 35808,  8191, true,  kOtd},
    {0x006D, "HUION_M214_",  "Huion Kamvas Pro 16 (2.5k)",    69926, 39333,  8191, true,  kOtd},
    {0x006D, "HUION_M215_",  "Huion Kamvas 13",               58752, 33048,  8191, true,  kOtd},
    {0x006E, "HUION_T153_",  "Huion WH1409",                  70000, 43600,  8191, true,  kOtd},
    {0x006E, "HUION_T161_",  "Huion G10T",                    50800, 31750,  8191, false, kOtd},
    {0x006D, "HUION_T164_",  "Huion Q11K",                    55880, 34925,  8191, false, "capture huion_q11k"},
    {0x006E, "HUION_T166_",  "Huion GC610",                   50800, 31750,  8191, false, kOtd},
    {0x006D, "HUION_T167_",  "Huion H1060P",                  50800, 31750,  8191, true,  kOtd},
    {0x006D, "HUION_T172_",  "Huion H950P",                   44200, 27600,  8191, true,  kOtd},
    {0x006D, "HUION_T173_",  "Huion H640P",                   32000, 20000,  8191, true,  kOtd},
    {0x006D, "HUION_T174_",  "Huion New 1060 Plus",           50800, 31750,  8191, false, "recording Huion_New_1060_Plus"},
    {0x006D, "HUION_T175_",  "Huion H610 Pro",                50800, 31750,  8191, false, kOtd},
    {0x006D, "HUION_T176_",  "Huion H430P",                   24384, 15240,  4095, false, kOtd},
    {0x006D, "HUION_T181_",  "Huion HS64",                    32000, 20400,  8191, false, kOtd},
    {0x006D, "HUION_T184_",  "Huion H610 Pro V2",             50800, 31750,  8191, true,  kOtd},
    {0x006E, "HUION_T185_",  "Huion Q11K V2",                 55880, 34925,  8191, true,  kOtd},
    {0x006E, "HUION_T188_",  "Huion WH1409 V2",               70000, 43600,  8191, true,  kOtd},
    {0x006D, "HUION_T18C_",  "Huion HC16",                    50800, 31750,  8191, true,  kOtd},
    {0x006D, "HUION_T18a_",  "Huion H430P",                   24384, 15240,  4095, false, kOtd},
    {0x006D, "HUION_T18d_",  "Huion Q620M",                   53340, 33020,  8191, true,  kOtd},
    {0x006D, "HUION_T191_",  "Huion H1161",                   55880, 34925,  8191, true,  kOtd},
    {0x006D, "HUION_T193_",  "Huion HS64",                    32000, 20400,  8191, false, kOtd},
    {0x006D, "HUION_T194_",  "Huion HS610",                   50800, 31750,  8191, true,  kOtd},
    {0x006D, "HUION_T198_",  "Huion H320M",                   45700, 28580,  8191, true,  kOtd},
    {0x006D, "HUION_T19c_",  "Huion HS611",                   51680, 32300,  8191, true,  kOtd},
    {0x006D, "HUION_T19g_",  "Huion H642",                    32004, 19812,  8191, true,  kOtd},
    {0x006D, "HUION_T19h_",  "Huion RTM-500",                 44199, 27599,  8191, true,  kOtd},
    {0x006D, "HUION_T19k_",  "Huion RTP-700",                 55880, 34920,  8191, true,  kOtd},
    {0x006D, "HUION_T203_",  "Huion H640P",                   32000, 20000,  8191, true,  kOtd},
    {0x006D, "HUION_T204_",  "Huion H950P",                   44200, 27600,  8191, true,  kOtd},
    {0x006D, "HUION_T205_",  "Huion H1060P",                  50800, 31750,  8191, true,  kOtd},
    {0x006D, "HUION_T206_",  "Huion HS95",                    40638, 25398,  8191, true,  kOtd},
    {0x006D, "HUION_T210_",  "Huion H420X",                   21200, 13200,  8191, false, kOtd},
    {0x0064, "HUION_T211_",  "Huion H580X",                   40640, 25400,  8191, true,  kOtd},
    {0x0064, "HUION_T212_",  "Huion H610X",                   50800, 31760,  8191, true,  kOtd},
    {0x0064, "HUION_T217_",  "Huion RTE-100",                 24384, 15238,  8191, false, kOtd},
    {0x006D, "HUION_T218_",  "Huion Note X10",                37400, 28200,  8191, true,  kOtd},
    {0x0064, "HUION_T219_",  "Huion H1060P",                  50800, 31750,  8191, true,  kOtd},
    {0x006D, "HUION_T21c_",  "Huion H430P",                   24384, 15240,  4095, false, kOtd},
    {0x0064, "HUION_T223_",  "Huion H420X",                   21200, 13200,  8191, false, kOtd},
    {0x0064, "HUION_T224_",  "Huion H580X",                   40640, 25400,  8191, true,  kOtd},
    {0x006F, "HUION_T225_",  "Huion HS64",                    32000, 20400,  8191, false, kOtd},
    {0x0064, "HUION_T226_",  "Huion HC16 (Variant 2)",        50800, 31750, 16383, true,  kOtd},
    {0x0064, "HUION_T227_",  "Huion HS610",                   50800, 31750,  8191, true,  kOtd},
    {0x0064, "HUION_T229_",  "Huion H610X",                   50800, 31760,  8191, true,  kOtd},
    {0x0064, "HUION_T22d_",  "Huion H950P",                   44200, 27600,  8191, true,  kOtd},
};

constexpr PenSpec kOthers[] = {
    {.vendor = kHuion,   .product = 0x006E, .name = "Huion tablet",         .family = F::kUcLogicV1,  .x_max = 40000, .y_max = 25000, .pressure_max = 2047, .counts_per_mm = per_mm(4000), .evidence = "OpenTabletDriver (1060 Plus)"},
    {.vendor = kHuion,   .product = 0x006E, .name = "Huion WH1409",         .family = F::kUcLogicV1,  .x_max = 55200, .y_max = 34498, .pressure_max = 2047, .counts_per_mm = per_mm(4000), .firmware = "HUION_T153_160607", .evidence = kOtd},
    {.vendor = kHuion,   .product = 0x006E, .name = "Huion tablet",         .family = F::kPenAsMouse, .x_max = 32767, .y_max = 32767, .pressure_max = 2047, .counts_per_mm = 32767 / 203.2, .counts_per_mm_y = 32767 / 127.0, .leaves_silently = true, .report_id = 0x0A, .evidence = "recording Huion_W58"},
    {.vendor = kHuion,   .product = 0x006E, .name = "Huion W58",            .family = F::kPenAsMouse, .x_max = 32767, .y_max = 32767, .pressure_max = 2047, .counts_per_mm = 32767 / 203.2, .counts_per_mm_y = 32767 / 127.0, .leaves_silently = true, .report_id = 0x0A, .descriptor_bytes = 244, .evidence = "recording Huion_W58"},
    {.vendor = kHuion,   .product = 0x006E, .name = "Huion New 1060 Plus",  .family = F::kPenAsMouse, .x_max = 32767, .y_max = 32767, .pressure_max = 2047, .counts_per_mm = 32767 / 254.0, .counts_per_mm_y = 32767 / 158.75, .leaves_silently = true, .report_id = 0x0A, .descriptor_bytes = 83, .evidence = "probe Huion_New_1060_Plus"},
    {.vendor = kUcLogic, .product = 0x0047, .name = "XP-Pen Artist 22HD",   .family = F::kUcLogicV1,  .x_max = 38161, .y_max = 21458, .pressure_max = 2047, .counts_per_mm = 38161 / 476.64, .evidence = kOtd},
    {.vendor = kUcLogic, .product = 0x004A, .name = "XP-Pen Artist 10S",    .family = F::kUcLogicV1,  .x_max = 21696, .y_max = 13560, .pressure_max = 2047, .counts_per_mm = per_mm(2540), .evidence = kOtd},
    {.vendor = kUcLogic, .product = 0x004D, .name = "XP-Pen Artist 16",     .family = F::kUcLogicV1,  .x_max = 34416, .y_max = 19359, .pressure_max = 2047, .counts_per_mm = per_mm(2540), .evidence = kOtd},
    {.vendor = kUcLogic, .product = 0x0050, .name = "XP-Pen Star 02",       .family = F::kUcLogicV1,  .x_max = 32000, .y_max = 20000, .pressure_max = 2047, .counts_per_mm = per_mm(4000), .evidence = kOtd},
    {.vendor = kUcLogic, .product = 0x0081, .name = "UGEE M708",            .family = F::kUcLogicV1,  .x_max = 40000, .y_max = 24000, .pressure_max = 2047, .counts_per_mm = per_mm(4000), .evidence = kOtd},
    {.vendor = kUcLogic, .product = 0x0781, .name = "UC-Logic TWHA60",      .family = F::kUcLogicV1,  .x_max = 40000, .y_max = 25000, .pressure_max = 2047, .counts_per_mm = per_mm(4000), .evidence = "probe UC-Logic_TWHA60_v3"},
};
// clang-format on

}  // namespace

void append_uclogic_pens(std::vector<PenSpec>& rows) {
  for (const V2Row& row : kV2) {
    rows.push_back({.vendor = kHuion,
                    .product = row.product,
                    .name = row.name,
                    .family = F::kUcLogicV2,
                    .x_max = row.x_max,
                    .y_max = row.y_max,
                    .pressure_max = row.pressure_max,
                    .counts_per_mm = 200,
                    .tilt = row.tilt,
                    .leaves_silently = true,
                    .firmware = row.firmware,
                    .evidence = row.evidence});
  }
  rows.insert(rows.end(), std::begin(kOthers), std::end(kOthers));
}

}  // namespace limn
