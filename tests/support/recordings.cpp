#include "tests/support/recordings.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace limn::test {

namespace fs = std::filesystem;

fs::path shared_folder() { return fs::path(LIMN_SOURCE_DIR).parent_path() / "shared"; }

bool has_recordings() { return fs::exists(shared_folder() / "traces/README.md"); }

std::vector<fs::path> recordings(const std::string& relative, const std::string& extension) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(shared_folder() / relative)) {
    if (!entry.is_regular_file()) continue;
    if (extension.empty() || entry.path().extension() == extension) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in.good()) << "cannot open " << path;
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace limn::test
