#include "tests/bench/row.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace limn::bench {

namespace {

/// Whole numbers as they are, others with three significant digits, never with an exponent.
std::string figure(double value) {
  if (!std::isfinite(value)) return "-";
  if (value == std::round(value)) return std::to_string(std::llround(value));
  const int digits = std::max(0, 2 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string goal_text(const Goal& goal) {
  return goal.of == Goal::Of::kRatioAtLeast ? "ratio >= " + figure(goal.value)
                                            : "<= " + figure(goal.value);
}

std::string line(const char* row, const std::string& limn, const std::string& peer,
                 const std::string& unit, const std::string& ratio, const std::string& goal,
                 const std::string& holds, const std::string& peer_name) {
  char text[320];
  std::snprintf(text, sizeof text, "%-44.60s %9s %9s  %-15s %8s  %-14s %-6s %s", row, limn.c_str(),
                peer.c_str(), unit.c_str(), ratio.c_str(), goal.c_str(), holds.c_str(),
                peer_name.c_str());
  std::string trimmed = text;
  trimmed.erase(trimmed.find_last_not_of(' ') + 1);
  return trimmed;
}

}  // namespace

std::optional<double> Row::ratio() const {
  if (!peer || limn == 0) return std::nullopt;
  return peer->cost / limn;
}

std::optional<bool> Row::holds() const {
  if (!goal) return std::nullopt;
  if (goal->of == Goal::Of::kCostAtMost) return limn <= goal->value;
  const auto r = ratio();
  return r && *r >= goal->value;
}

Goal at_most(double cost) { return {Goal::Of::kCostAtMost, cost}; }
Goal at_least_ratio(double ratio) { return {Goal::Of::kRatioAtLeast, ratio}; }

std::string to_json(const Row& row) {
  nlohmann::ordered_json json;
  json["row"] = row.name;
  json["limn"] = row.limn;
  if (row.peer) {
    json["peer"] = row.peer->cost;
    json["peer_name"] = row.peer->name;
    if (row.peer->recorded) json["recorded"] = true;
  }
  json["unit"] = row.unit;
  if (const auto ratio = row.ratio()) json["ratio"] = *ratio;
  if (row.goal) {
    json["goal"][row.goal->of == Goal::Of::kRatioAtLeast ? "min" : "max"] = row.goal->value;
    json["holds"] = *row.holds();
  }
  return json.dump();
}

std::string table_heading() {
  return line("row", "limn", "peer", "unit", "ratio", "goal", "holds", "peer is");
}

std::string to_table_line(const Row& row) {
  const auto ratio = row.ratio();
  const auto holds = row.holds();
  return line(row.name.c_str(), figure(row.limn), row.peer ? figure(row.peer->cost) : "", row.unit,
              ratio ? figure(*ratio) : "", row.goal ? goal_text(*row.goal) : "",
              holds ? (*holds ? "yes" : "NO") : "",
              row.peer ? row.peer->name + (row.peer->recorded ? " (recorded)" : "") : "");
}

}  // namespace limn::bench
