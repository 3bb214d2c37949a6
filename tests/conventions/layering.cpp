#include "tests/conventions/layering.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

namespace limn::test {

namespace {

using std::string_view;

struct Layer {
  string_view folder;
  std::vector<string_view> sees;  ///< folders, or headers, that it may include besides its own
  std::vector<string_view> third_party;  ///< beginnings of <..> headers its sources may include
};

// Data runs left to right: drivers -> input <- modeler; inside modeler each line sees those above.
// firmware_sim sees nobody, or it would share a mistake with the decoder that it tests. Whoever
// adds a folder adds its line here.
const std::vector<Layer>& layers() {
  static const std::vector<Layer> table = {
      {"input/base", {}, {"posix"}},
      {"input/sample", {"input/base"}, {}},
      {"input/stroke", {"input/base", "input/sample"}, {}},
      {"input/trace", {"input/base", "input/sample"}, {}},
      {"input/trace_import", {"input/base", "input/sample", "input/trace"}, {"pcap/", "yaml-cpp/"}},

      {"drivers/hid", {"input/base", "input/sample"}, {}},
      {"drivers/devices", {"input", "drivers/hid"}, {}},
      // What a pen must be asked when it is opened is data of its tables; how long a USB transfer
      // must be is in its report descriptor.
      {"drivers/transport",
       {"input", "drivers/devices", "drivers/hid"},
       {"libusb-1.0/", "hidapi/", "linux/", "libevdev/", "libudev.h", "spnav.h", "posix", "sys/"}},
      // Of the transports it has the owner of file descriptors.
      {"drivers/spnav_server",
       {"input/base", "input/sample", "drivers/transport/file_handle.hpp"},
       {"posix", "sys/"}},

      {"modeler/base", {"input/base"}, {"Eigen/"}},
      {"modeler/bspline", {"input/base", "modeler/base"}, {"Eigen/"}},
      {"modeler/fit", {"input", "modeler/base", "modeler/bspline"}, {"Eigen/"}},
      {"modeler/surface", {"input/base", "modeler/base", "modeler/bspline"}, {"Eigen/"}},
      {"modeler/model", {"input/base", "modeler/base", "modeler/bspline"}, {"Eigen/"}},
      {"modeler/mesh",
       {"input/base", "modeler/base", "modeler/bspline", "modeler/fit", "modeler/surface",
        "modeler/model"},
       {"Eigen/"}},
      {"modeler/manip",
       {"input", "modeler/base", "modeler/bspline", "modeler/fit", "modeler/surface"},
       {"Eigen/"}},
      {"modeler/shapes",
       {"input", "modeler/base", "modeler/bspline", "modeler/fit", "modeler/surface",
        "modeler/mesh", "modeler/manip"},
       {"Eigen/"}},
      {"modeler/sketch",
       {"input", "modeler/base", "modeler/bspline", "modeler/fit", "modeler/surface",
        "modeler/mesh", "modeler/manip", "modeler/shapes"},
       {"Eigen/"}},
      {"modeler/document",
       {"input", "modeler/base", "modeler/bspline", "modeler/fit", "modeler/surface",
        "modeler/mesh", "modeler/manip", "modeler/shapes", "modeler/sketch"},
       {"Eigen/", "nlohmann/"}},
      {"modeler/exchange",
       {"input", "modeler/base", "modeler/bspline", "modeler/fit", "modeler/surface",
        "modeler/model", "modeler/mesh", "modeler/manip", "modeler/shapes", "modeler/sketch",
        "modeler/document"},
       {"Eigen/", "nlohmann/", "opencascade"}},
      {"modeler/view",
       {"input", "modeler/base", "modeler/bspline", "modeler/fit", "modeler/surface",
        "modeler/model", "modeler/mesh", "modeler/manip", "modeler/shapes", "modeler/sketch",
        "modeler/document"},
       {"Eigen/", "cairo", "GLFW/", "glm/"}},
      {"modeler/app",
       {"input", "drivers", "modeler", "firmware_sim"},
       {"Eigen/", "CLI/", "nlohmann/", "posix"}},

      {"firmware_sim/usb", {"firmware_sim"}, {}},
      {"firmware_sim/devices", {"firmware_sim"}, {}},
      // Links are host side: /dev/uhid, timers that wake by absolute time, TCP.
      {"firmware_sim/link", {"firmware_sim"}, {"linux/", "posix", "sys/", "netinet/"}},

      // hidapi and libspnav as other programs use them, and what the heap holds.
      {"tests/kernel",
       {"input", "drivers", "modeler", "firmware_sim", "tests"},
       {"gtest/", "gmock/", "dlfcn.h", "hidapi/", "malloc.h", "spnav.h", "posix", "linux/",
        "sys/"}},
      {"tests",
       {"input", "drivers", "modeler", "firmware_sim", "tests"},
       {"gtest/", "gmock/", "benchmark/", "sanitizer/", "Eigen/", "nlohmann/", "cairo",
        "opencascade", "sisl.h", "embree3/", "spnav.h", "umockdev.h", "posix", "dlfcn.h", "linux/",
        "netinet/", "sys/"}},
  };
  return table;
}

const std::set<string_view>& standard_headers() {
  static const std::set<string_view> names = {
      "algorithm",     "any",           "array",
      "atomic",        "bit",           "bitset",
      "cassert",       "cctype",        "cerrno",
      "cfenv",         "cfloat",        "charconv",
      "chrono",        "cinttypes",     "climits",
      "clocale",       "cmath",         "compare",
      "complex",       "concepts",      "condition_variable",
      "coroutine",     "csetjmp",       "csignal",
      "cstdarg",       "cstddef",       "cstdint",
      "cstdio",        "cstdlib",       "cstring",
      "ctime",         "cuchar",        "cwchar",
      "cwctype",       "deque",         "exception",
      "filesystem",    "forward_list",  "fstream",
      "functional",    "future",        "initializer_list",
      "iomanip",       "ios",           "iosfwd",
      "iostream",      "istream",       "iterator",
      "limits",        "list",          "locale",
      "map",           "memory",        "memory_resource",
      "mutex",         "new",           "numbers",
      "numeric",       "optional",      "ostream",
      "queue",         "random",        "ranges",
      "ratio",         "regex",         "set",
      "shared_mutex",  "span",          "sstream",
      "stack",         "stdexcept",     "stop_token",
      "streambuf",     "string",        "string_view",
      "system_error",  "thread",        "tuple",
      "type_traits",   "typeindex",     "typeinfo",
      "unordered_map", "unordered_set", "utility",
      "valarray",      "variant",       "vector",
      "version"};
  return names;
}

const std::set<string_view>& posix_headers() {
  static const std::set<string_view> names = {
      "dirent.h",   "errno.h",     "fcntl.h",     "poll.h",         "pthread.h",    "signal.h",
      "spawn.h",    "stdlib.h",    "sys/ioctl.h", "sys/resource.h", "sys/socket.h", "sys/stat.h",
      "sys/time.h", "sys/types.h", "sys/wait.h",  "termios.h",      "time.h",       "unistd.h"};
  return names;
}

/// Open CASCADE's headers are the only ones that end so.
bool is_opencascade(string_view header) { return header.ends_with(".hxx"); }

bool matches(string_view header, string_view pattern) {
  if (pattern == "opencascade") return is_opencascade(header);
  if (pattern == "posix") return posix_headers().contains(header);
  return header.starts_with(pattern);
}

bool is_in(string_view path, string_view folder) {
  return path.starts_with(folder) && path.size() > folder.size() && path[folder.size()] == '/';
}

const Layer* layer_of(const SourceFile& file) {
  for (const auto& layer : layers())
    if (file.is_under(layer.folder)) return &layer;
  return nullptr;
}

bool may_see(const Layer& layer, string_view header) {
  return is_in(header, layer.folder) ||
         std::any_of(layer.sees.begin(), layer.sees.end(),
                     [header](string_view seen) { return header == seen || is_in(header, seen); });
}

// A public header shows the standard library, tl::expected, and in the modeler Eigen (in view GLM):
// every other library stays an implementation detail of a source file.
bool may_use(const Layer& layer, const SourceFile& file, string_view header) {
  if (standard_headers().contains(header) || header == "tl/expected.hpp") return true;
  const bool shown = !file.is_header() || header.starts_with("Eigen/") ||
                     header.starts_with("glm/") || file.is_under("tests");
  return shown && std::any_of(layer.third_party.begin(), layer.third_party.end(),
                              [header](string_view pattern) { return matches(header, pattern); });
}

}  // namespace

std::vector<std::string> layering_violations(const SourceFile& file) {
  const Layer* layer = layer_of(file);
  if (layer == nullptr) return {file.path + ": no layer knows the folder " + file.folder()};
  std::vector<std::string> found;
  for (const auto& include : includes_of(file)) {
    if (include.quoted && !may_see(*layer, include.target)) {
      found.push_back(file.path + ": may not see " + include.target);
    } else if (!include.quoted && !may_use(*layer, file, include.target)) {
      found.push_back(file.path + ": may not use <" + include.target + ">");
    }
  }
  return found;
}

std::vector<std::string> heavy_header_violations(const std::vector<SourceFile>& files) {
  struct Heavy {
    string_view name;
    bool (*is)(string_view header);
  };
  constexpr Heavy kHeavy[] = {
      {"CLI11", [](string_view header) { return header.starts_with("CLI/"); }},
      {"nlohmann/json", [](string_view header) { return header == "nlohmann/json.hpp"; }},
      {"Open CASCADE", is_opencascade},
  };
  std::vector<std::string> found;
  for (const auto& heavy : kHeavy) {
    std::map<std::string, std::vector<std::string>> users;  // by folder
    for (const auto& file : files) {
      if (file.is_under("tests") && !file.is_under("tests/bench")) continue;
      const auto includes = includes_of(file);
      if (std::any_of(includes.begin(), includes.end(),
                      [&heavy](const Include& include) { return heavy.is(include.target); }))
        users[file.folder()].push_back(file.path);
    }
    for (const auto& [folder, paths] : users)
      for (std::size_t i = 1; i < paths.size(); ++i)
        found.push_back(paths[i] + ": " + std::string(heavy.name) + " is already included by " +
                        paths[0]);
  }
  return found;
}

}  // namespace limn::test
