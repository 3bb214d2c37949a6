#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limn::test {

/// A fenced block of a Markdown text.
struct FencedBlock {
  std::string language;   ///< what follows the opening fence
  std::size_t begin = 0;  ///< of the content in the text
  std::size_t end = 0;    ///< one past the content, which ends with a newline
};

/// The fenced blocks of `markdown`, in order.
std::vector<FencedBlock> fenced_blocks(std::string_view markdown);

/// A command of a console block ("$ COMMAND") with the lines that follow it.
struct ConsoleStep {
  std::string command;
  std::string output;
};

/// The steps of a console block's content; lines before the first command are no step.
std::vector<ConsoleStep> console_steps(std::string_view content);

}  // namespace limn::test
