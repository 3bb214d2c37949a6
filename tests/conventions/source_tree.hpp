#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace limn::test {

/// One C++ file of the repository.
struct SourceFile {
  std::string path;  ///< from the repository root, with slashes: "input/base/error.hpp"
  std::string text;

  bool is_header() const { return path.ends_with(".hpp"); }
  /// Path of the folder it is in: "input/base".
  std::string folder() const { return path.substr(0, path.rfind('/')); }
  /// Whether it lies somewhere under `folder`.
  bool is_under(std::string_view folder) const {
    return path.size() > folder.size() && path.starts_with(folder) && path[folder.size()] == '/';
  }
};

/// One #include line.
struct Include {
  std::string target;  ///< what stands between the brackets or quotes
  bool quoted = false;
};

/// The five folders that hold everything.
inline constexpr std::string_view kTopFolders[] = {"input", "drivers", "modeler", "firmware_sim",
                                                   "tests"};

/// All .hpp and .cpp files under the five folders of `root`, sorted by path.
std::vector<SourceFile> source_files(const std::filesystem::path& root);

/// All folders under the five folders of `root`, these included, sorted; paths as in SourceFile.
std::vector<std::string> source_folders(const std::filesystem::path& root);

/// The include lines of a file, in order.
std::vector<Include> includes_of(const SourceFile& file);

/// The text with comments, and the content of string and character literals, blanked out, so that a
/// word found in it is code. Newlines stay.
std::string code_of(std::string_view text);

/// Whether `word` occurs in `code` with no identifier character on either side of it.
bool has_word(std::string_view code, std::string_view word);

/// Whether it occurs so with an opening bracket behind it: a call, not a variable of that name.
bool has_call(std::string_view code, std::string_view function);

}  // namespace limn::test
