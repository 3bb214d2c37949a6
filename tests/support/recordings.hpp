#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace limn::test {

/// The folder beside the repository that holds real recordings (../shared): never copied into the
/// repository, so tests that need it skip where it is absent.
std::filesystem::path shared_folder();

/// Whether the real recordings are there (shared_folder()/traces/README.md exists).
bool has_recordings();

/// All regular files under shared_folder()/`relative`, sorted; `extension` like ".hid" or "" for
/// all.
std::vector<std::filesystem::path> recordings(const std::string& relative,
                                              const std::string& extension = "");

/// The whole file as bytes. Fails the running test where it cannot be read.
std::string read_file(const std::filesystem::path& path);

}  // namespace limn::test

/// First line of a test that needs real recordings.
#define LIMN_NEEDS_RECORDINGS()                                                      \
  do {                                                                               \
    if (!::limn::test::has_recordings())                                             \
      GTEST_SKIP() << "real recordings are absent: no "                              \
                   << (::limn::test::shared_folder() / "traces/README.md").string(); \
  } while (false)
