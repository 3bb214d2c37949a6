#include "tests/conventions/source_tree.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "tests/support/recordings.hpp"

namespace limn::test {

namespace {

namespace fs = std::filesystem;

bool is_identifier_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Index of the last character of the raw string literal whose opening quote is at `quote`.
std::size_t raw_string_end(std::string_view text, std::size_t quote) {
  const auto open = text.find('(', quote);
  if (open == std::string_view::npos) return text.size() - 1;
  std::string closing(text.substr(quote + 1, open - quote - 1));
  closing.insert(0, 1, ')').push_back('"');
  const auto end = text.find(closing, open);
  return end == std::string_view::npos ? text.size() - 1 : end + closing.size() - 1;
}

/// Index of the closing quote of the literal whose opening quote is at `quote`.
std::size_t literal_end(std::string_view text, std::size_t quote) {
  for (std::size_t i = quote + 1; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == text[quote] || text[i] == '\n') {
      return i;
    }
  }
  return text.size() - 1;
}

/// Index of the last character of the comment or literal that begins at `i`; `i` - 1 where none
/// does.
std::size_t blank_end(std::string_view text, std::size_t i) {
  if (text.substr(i, 2) == "//") return std::min(text.find('\n', i), text.size()) - 1;
  if (text.substr(i, 2) == "/*") return std::min(text.find("*/", i + 2), text.size() - 2) + 1;
  const char before = i == 0 ? ' ' : text[i - 1];
  if (text[i] == '"') return before == 'R' ? raw_string_end(text, i) : literal_end(text, i);
  // A quote between digits separates them: 1'000.
  if (text[i] == '\'' && !is_identifier_character(before)) return literal_end(text, i);
  return i - 1;
}

/// Where `word` next stands in `code`, from `from` on, with no identifier character beside it.
std::size_t find_word(std::string_view code, std::string_view word, std::size_t from) {
  for (auto at = code.find(word, from); at != std::string_view::npos;
       at = code.find(word, at + 1)) {
    const auto end = at + word.size();
    const bool starts = at == 0 || !is_identifier_character(code[at - 1]);
    const bool ends = end == code.size() || !is_identifier_character(code[end]);
    if (starts && ends) return at;
  }
  return std::string_view::npos;
}

}  // namespace

std::vector<SourceFile> source_files(const fs::path& root) {
  std::vector<SourceFile> files;
  for (const auto top : kTopFolders) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (!entry.is_regular_file() || (extension != ".hpp" && extension != ".cpp")) continue;
      files.push_back({fs::relative(entry.path(), root).generic_string(), read_file(entry.path())});
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

std::vector<std::string> source_folders(const fs::path& root) {
  std::vector<std::string> folders;
  for (const auto top : kTopFolders) {
    folders.emplace_back(top);
    for (const auto& entry : fs::recursive_directory_iterator(root / top))
      if (entry.is_directory())
        folders.push_back(fs::relative(entry.path(), root).generic_string());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

std::vector<Include> includes_of(const SourceFile& file) {
  constexpr std::string_view kDirective = "#include ";
  std::vector<Include> found;
  std::istringstream lines(file.text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(kDirective)) continue;
    const auto open = kDirective.size();
    const bool quoted = line[open] == '"';
    const auto close = line.find(quoted ? '"' : '>', open + 1);
    if (close != std::string::npos)
      found.push_back({line.substr(open + 1, close - open - 1), quoted});
  }
  return found;
}

std::string code_of(std::string_view text) {
  std::string code(text);
  std::size_t i = 0;
  while (i < text.size()) {
    const std::size_t end = blank_end(text, i) + 1;
    if (end == i) ++i;  // code
    for (; i < end; ++i)
      if (code[i] != '\n') code[i] = ' ';
  }
  return code;
}

bool has_word(std::string_view code, std::string_view word) {
  return find_word(code, word, 0) != std::string_view::npos;
}

bool has_call(std::string_view code, std::string_view function) {
  for (auto at = find_word(code, function, 0); at != std::string_view::npos;
       at = find_word(code, function, at + 1)) {
    const auto next = code.find_first_not_of(" \n", at + function.size());
    if (next != std::string_view::npos && code[next] == '(') return true;
  }
  return false;
}

}  // namespace limn::test
