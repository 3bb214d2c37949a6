#include "tests/support/golden.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace limn::test {

namespace {

namespace fs = std::filesystem;

bool update_wanted() {
  const char* value = std::getenv("LIMN_UPDATE_GOLDEN");
  return value != nullptr && std::string_view(value) == "1";
}

/// Line `line` (from 1) of `text` without its newline; "(no such line)" beyond the end.
std::string_view nth_line(std::string_view text, std::size_t line) {
  for (std::size_t i = 1; i < line; ++i) {
    const auto end = text.find('\n');
    if (end == std::string_view::npos) return "(no such line)";
    text.remove_prefix(end + 1);
  }
  if (text.empty()) return "(no such line)";
  return text.substr(0, text.find('\n'));
}

/// Number, from 1, of the first line in which the texts differ. Precondition: they do.
std::size_t first_difference(std::string_view a, std::string_view b) {
  std::size_t line = 1;
  for (std::size_t i = 0; i < a.size() && i < b.size() && a[i] == b[i]; ++i)
    if (a[i] == '\n') ++line;
  return line;
}

testing::AssertionResult write(const fs::path& file, std::string_view text) {
  fs::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) return testing::AssertionFailure() << "cannot write " << file;
  return testing::AssertionSuccess() << "wrote " << file;
}

}  // namespace

testing::AssertionResult matches_golden(std::string_view text, const fs::path& relative) {
  return matches_golden_in(fs::path(LIMN_SOURCE_DIR) / "tests/golden", text, relative);
}

testing::AssertionResult matches_golden_in(const fs::path& root, std::string_view text,
                                           const fs::path& relative) {
  const fs::path file = root / relative;
  if (update_wanted()) return write(file, text);
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    return testing::AssertionFailure()
           << "no golden file " << file << "; write it with LIMN_UPDATE_GOLDEN=1";
  }
  const std::string expected{std::istreambuf_iterator<char>(in), {}};
  if (text == expected) return testing::AssertionSuccess();
  const std::size_t line = first_difference(text, expected);
  return testing::AssertionFailure()
         << "differs from " << file << " first in line " << line
         << "\n  golden: " << nth_line(expected, line) << "\n  actual: " << nth_line(text, line)
         << "\nif the new text is right, rewrite it with LIMN_UPDATE_GOLDEN=1";
}

}  // namespace limn::test
