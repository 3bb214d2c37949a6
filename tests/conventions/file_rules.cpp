#include "tests/conventions/file_rules.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <sstream>
#include <string_view>

namespace limn::test {

namespace {

using std::string_view;

constexpr std::ptrdiff_t kMostLines = 700;

constexpr std::array<string_view, 8> kEmptyNames = {"manager", "utils",  "util", "helper",
                                                    "helpers", "common", "misc", "stuff"};

// The parts of "modeler/base/curve_utils.hpp" are modeler, base, curve, utils and hpp.
std::set<std::string> name_parts(std::string path) {
  std::replace_if(
      path.begin(), path.end(), [](char c) { return c == '/' || c == '.'; }, '_');
  std::set<std::string> parts;
  std::istringstream in(path);
  for (std::string part; std::getline(in, part, '_');) parts.insert(part);
  return parts;
}

// tests/support is not installed either, but follows gtest's ways.
bool belongs_to_a_library(const SourceFile& file) {
  return !file.is_under("modeler/app") && !file.is_under("tests");
}

constexpr string_view kForbiddenWords[] = {"throw", "std::cout", "std::cerr", "std::clog"};
constexpr string_view kForbiddenCalls[] = {
    "printf",     "fprintf",        "puts",      "fputs",      "putchar",
    "std::abort", "std::terminate", "std::exit", "std::_Exit", "_exit"};

constexpr string_view kMathematical[] = {"sin",   "cos",   "tan",  "asin", "acos",  "atan",
                                         "atan2", "exp",   "log",  "log2", "log10", "pow",
                                         "cbrt",  "hypot", "sinh", "cosh", "tanh"};

}  // namespace

std::vector<std::string> file_violations(const SourceFile& file) {
  std::vector<std::string> found;
  if (file.is_header() && file.text.find("#pragma once\n") == std::string::npos)
    found.push_back(file.path + ": has no #pragma once");
  const auto parts = name_parts(file.path);
  for (const auto name : kEmptyNames)
    if (parts.contains(std::string(name)))
      found.push_back(file.path + ": \"" + std::string(name) + "\" names nothing");
  if (std::count(file.text.begin(), file.text.end(), '\n') > kMostLines)
    found.push_back(file.path + ": has more than 700 lines");
  return found;
}

std::vector<std::string> library_violations(const SourceFile& file) {
  if (!belongs_to_a_library(file)) return {};
  const std::string code = code_of(file.text);
  std::vector<std::string> found;
  const auto forbid = [&found, &file](string_view word) {
    found.push_back(file.path + ": a library may not use " + std::string(word));
  };
  for (const auto word : kForbiddenWords)
    if (has_word(code, word)) forbid(word);
  for (const auto function : kForbiddenCalls)
    if (has_call(code, function)) forbid(function);
  if (file.is_under("drivers")) {
    for (const auto function : kMathematical)
      if (has_call(code, "std::" + std::string(function)))
        found.push_back(file.path + ": decoding may not use std::" + std::string(function));
  }
  return found;
}

}  // namespace limn::test
