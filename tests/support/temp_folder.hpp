#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace limn::test {

/// A new empty folder, removed with all it holds when the object goes.
class TempFolder {
 public:
  /// Fails the running test where the system gives no folder.
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }

  /// Writes `name` with `content` into the folder and returns its path.
  std::filesystem::path write(const std::string& name, std::string_view content) const;

 private:
  std::filesystem::path path_;
};

}  // namespace limn::test
