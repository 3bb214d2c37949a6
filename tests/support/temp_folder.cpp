#include "tests/support/temp_folder.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>  // mkdtemp is POSIX

#include <fstream>

namespace limn::test {

namespace fs = std::filesystem;

TempFolder::TempFolder() {
  std::string pattern = (fs::temp_directory_path() / "limn-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) ADD_FAILURE() << "cannot make a folder like " << pattern;
  path_ = pattern;
}

TempFolder::~TempFolder() {
  std::error_code ignored;  // a destructor has nobody to tell, and the folder is in /tmp
  fs::remove_all(path_, ignored);
}

fs::path TempFolder::write(const std::string& name, std::string_view content) const {
  const fs::path file = path_ / name;
  std::ofstream out(file, std::ios::binary);
  out << content;
  out.close();
  EXPECT_TRUE(out.good()) << "cannot write " << file;
  return file;
}

}  // namespace limn::test
