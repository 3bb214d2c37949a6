#include "tests/examples/readme_blocks.hpp"

#include <algorithm>
#include <sstream>

namespace limn::test {

std::vector<FencedBlock> fenced_blocks(std::string_view markdown) {
  std::vector<FencedBlock> blocks;
  bool inside = false;
  for (std::size_t at = 0; at < markdown.size();) {
    const std::size_t newline = std::min(markdown.find('\n', at), markdown.size() - 1);
    const std::string_view line = markdown.substr(at, newline - at);
    if (line.starts_with("```")) {
      if (inside) {
        blocks.back().end = at;
      } else {
        blocks.push_back({std::string(line.substr(3)), newline + 1, markdown.size()});
      }
      inside = !inside;
    }
    at = newline + 1;
  }
  return blocks;
}

std::vector<ConsoleStep> console_steps(std::string_view content) {
  std::vector<ConsoleStep> steps;
  std::istringstream lines{std::string(content)};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("$ ")) {
      steps.push_back({line.substr(2), ""});
    } else if (!steps.empty()) {
      steps.back().output += line + "\n";
    }
  }
  return steps;
}

}  // namespace limn::test
