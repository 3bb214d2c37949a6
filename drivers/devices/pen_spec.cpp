#include "drivers/devices/pen_spec.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include "drivers/devices/pen_tables.hpp"

namespace limn {
namespace {

bool before(const PenSpec& a, const PenSpec& b) noexcept {
  return std::tuple(a.vendor, a.product, !a.unconditional()) <
         std::tuple(b.vendor, b.product, !b.unconditional());
}

std::vector<PenSpec> all_pens() {
  std::vector<PenSpec> rows;
  for (const auto& table : {wacom_pens(), kye_pens(), veikk_pens()}) {
    rows.insert(rows.end(), table.begin(), table.end());
  }
  append_uclogic_pens(rows);
  append_ugee_pens(rows);
  std::stable_sort(rows.begin(), rows.end(), before);
  return rows;
}

/// How well a row with that vendor fits; negative: not at all.
int fit(const PenSpec& row, const PenIdentity& device) noexcept {
  constexpr int kDescriptor = 1;
  constexpr int kName = 2;
  constexpr int kFirmware = 4;  // and the length, so that the longest wins
  int score = 0;
  if (!row.firmware.empty()) {
    if (device.firmware.substr(0, row.firmware.size()) != row.firmware) return -1;
    score += kFirmware * (1 + static_cast<int>(row.firmware.size()));
  } else if (row.product != device.product) {
    return -1;
  }
  if (!row.product_name.empty()) {
    if (device.product_name.find(row.product_name) == std::string_view::npos) return -1;
    score += kName;
  }
  if (row.descriptor_bytes != 0) {
    if (row.descriptor_bytes != device.descriptor_bytes) return -1;
    score += kDescriptor;
  }
  return score;
}

}  // namespace

std::string_view name(PenFamily family) noexcept {
  static constexpr std::array<std::string_view, kPenFamilyCount> kNames = {"PenPartner",
                                                                           "Graphire",
                                                                           "Graphire4",
                                                                           "Graphire Bluetooth",
                                                                           "PL",
                                                                           "Cintiq Partner",
                                                                           "DTU",
                                                                           "DTU-1031",
                                                                           "Intuos",
                                                                           "Intuos3",
                                                                           "Intuos4",
                                                                           "Intuos4 Bluetooth",
                                                                           "Intuos5",
                                                                           "Intuos Pro",
                                                                           "Cintiq",
                                                                           "Intuos Art",
                                                                           "Bamboo",
                                                                           "Intuos Pro 2 Bluetooth",
                                                                           "Intuos Bluetooth",
                                                                           "Tablet PC",
                                                                           "UC-Logic v1",
                                                                           "UC-Logic v2",
                                                                           "UGEE",
                                                                           "UGEE generation 2",
                                                                           "VEIKK",
                                                                           "KYE",
                                                                           "KYE as mouse",
                                                                           "pen as mouse"};
  return kNames[static_cast<std::size_t>(family)];
}

FamilyAxes family_axes(PenFamily family) noexcept {
  const bool intuos = family >= PenFamily::kIntuos && family <= PenFamily::kCintiq;
  if (intuos || family == PenFamily::kIntuosPro2Bluetooth) return {true, true, true};
  if (family == PenFamily::kIntuosArt || family == PenFamily::kIntuosSmallBluetooth) {
    return {false, false, true};
  }
  return {};
}

std::span<const PenSpec> pen_specs() noexcept {
  static const std::vector<PenSpec> kRows = all_pens();
  return kRows;
}

const PenSpec* find_pen_spec(std::uint16_t vendor, std::uint16_t product) noexcept {
  PenSpec wanted;
  wanted.vendor = vendor;
  wanted.product = product;
  const auto rows = pen_specs();
  const auto found = std::lower_bound(rows.begin(), rows.end(), wanted, before);
  if (found == rows.end() || before(wanted, *found)) return nullptr;
  return &*found;
}

PenForms find_pen_forms(const PenIdentity& identity) noexcept {
  PenForms forms;
  std::array<int, kMaxPenForms> scores{};
  for (const PenSpec& row : pen_specs()) {
    if (row.vendor != identity.vendor) continue;
    const int score = fit(row, identity);
    if (score < 0) continue;
    std::size_t place = 0;
    while (place < forms.count && form_report_id(*forms.rows[place]) != form_report_id(row)) {
      ++place;
    }
    if (place == kMaxPenForms) continue;
    if (place == forms.count) {
      ++forms.count;
    } else if (score <= scores[place]) {
      continue;
    }
    forms.rows[place] = &row;
    scores[place] = score;
  }
  return forms;
}

std::uint8_t form_report_id(const PenSpec& spec) noexcept {
  if (spec.report_id != 0) return spec.report_id;
  switch (spec.family) {
    case PenFamily::kUcLogicV1:
      return 0x07;
    case PenFamily::kUcLogicV2:
      return 0x08;
    case PenFamily::kUgee:
    case PenFamily::kUgeeGen2:
      return 0x02;
    case PenFamily::kVeikk:
    case PenFamily::kKyeMouse:
      return 0x09;
    case PenFamily::kKye:
      return 0x10;
    default:
      return 0;
  }
}

}  // namespace limn
