#include "modeler/app/nearest_name.hpp"

#include <algorithm>
#include <vector>

namespace limn::app {
namespace {

/// Levenshtein distance by one row.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::string join_with_or(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

}  // namespace

std::string suggest(std::string_view mistyped, std::span<const std::string_view> known) {
  std::vector<std::string_view> near;
  for (const std::string_view name : known) {
    // A third of the letters wrong is still the same word to a person.
    const std::size_t tolerated = std::max<std::size_t>(1, name.size() / 3);
    if (edit_distance(mistyped, name) <= tolerated) near.push_back(name);
  }
  if (!near.empty()) return "did you mean " + join_with_or(near) + "?";
  return "choose " + join_with_or({known.begin(), known.end()});
}

}  // namespace limn::app
