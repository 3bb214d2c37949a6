#pragma once

#include <optional>
#include <string>

namespace limn::bench {

/// What another library, or a limit of the machine, needs for the same job.
struct Peer {
  double cost = 0;  ///< in the row's unit
  std::string name;
  bool recorded = false;  ///< a figure of an earlier measurement, not run beside limn
};

/// A wanted figure: at least `value` times the peer's speed, or at most `value` of limn's own cost.
struct Goal {
  enum class Of { kRatioAtLeast, kCostAtMost };
  Of of = Of::kCostAtMost;
  double value = 0;
};

/// One measured job. All figures are costs: less is better.
struct Row {
  std::string name;  ///< "decode/Wacom Intuos5 touch M"
  double limn = 0;
  std::string unit;
  std::optional<Peer> peer;
  std::optional<Goal> goal;

  /// peer / limn: above 1 limn is better. None without a peer; none where limn's cost is 0.
  std::optional<double> ratio() const;
  /// Whether the goal is met; none without a goal. A goal of the ratio fails where there is none.
  std::optional<bool> holds() const;
};

Goal at_most(double cost);
Goal at_least_ratio(double ratio);

/// {"row":..,"limn":..,"peer":..,"peer_name":..,"unit":..,"ratio":..,"goal":{..},"holds":..}
/// without a newline. "recorded":true marks a peer that was not run; what a row does not have is
/// left out.
std::string to_json(const Row& row);

/// The heading of the table for people, and its lines. Columns keep their places.
std::string table_heading();
std::string to_table_line(const Row& row);

}  // namespace limn::bench
