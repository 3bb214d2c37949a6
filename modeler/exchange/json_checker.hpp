#pragma once

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "input/base/error.hpp"

namespace limn::exchange_detail {

using Json = nlohmann::ordered_json;

/// Takes values out of a JSON document and remembers the first error; after it, what is returned
/// means nothing. Places are JSON pointers, as /strokes/3/knots/0.
class JsonChecker {
 public:
  /// `remedy` goes with all errors of form.
  explicit JsonChecker(const char* remedy) : remedy_(remedy) {}

  bool failed() const { return error_.has_value(); }
  Error error() const { return *error_; }

  void fail(Error error) {
    if (!error_) error_ = std::move(error);
  }
  void fail(const std::string& place, std::string what) {
    fail({ErrorCode::kSyntax, place, std::move(what), remedy_});
  }

  /// A member of an object; null where there is none.
  const Json& member(const Json& object, const std::string& place, const char* key) {
    static const Json kNull;
    const auto found = object.find(key);
    if (found != object.end()) return *found;
    fail(place + "/" + key, "the member is missing");
    return kNull;
  }

  double number(const Json& value, const std::string& place) {
    if (value.is_number()) return value.get<double>();
    fail(place, "this is not a number");
    return 0;
  }

  /// A whole number from 0 to 2^31 - 1.
  int count(const Json& value, const std::string& place) {
    constexpr double kMost = 2147483647;
    const double x = number(value, place);
    if (x >= 0 && x <= kMost && std::floor(x) == x) return static_cast<int>(x);
    fail(place, "this is not a count");
    return 0;
  }

  bool truth(const Json& value, const std::string& place) {
    if (value.is_boolean()) return value.get<bool>();
    fail(place, "this is neither true nor false");
    return false;
  }

  std::vector<double> numbers(const Json& value, const std::string& place) {
    std::vector<double> out;
    if (!value.is_array()) fail(place, "this is not an array");
    for (const Json& x : elements(value)) {
      if (failed()) break;
      out.push_back(number(x, place + "/" + std::to_string(out.size())));
    }
    return out;
  }

  /// An array of points of kSize coordinates each.
  template <int kSize>
  std::vector<Eigen::Matrix<double, kSize, 1>> points(const Json& value, const std::string& place) {
    std::vector<Eigen::Matrix<double, kSize, 1>> out;
    if (!value.is_array()) fail(place, "this is not an array");
    for (const Json& x : elements(value)) {
      if (failed()) break;
      const std::string here = place + "/" + std::to_string(out.size());
      const std::vector<double> coordinates = numbers(x, here);
      if (coordinates.size() != std::size_t{kSize}) {
        fail(here, "a point has " + std::to_string(kSize) + " coordinates");
        break;
      }
      out.emplace_back(Eigen::Map<const Eigen::Matrix<double, kSize, 1>>(coordinates.data()));
    }
    return out;
  }

  /// A scalar is a range of one to the library; here it has no elements.
  static const Json& elements(const Json& value) {
    static const Json kNone = Json::array();
    return value.is_array() ? value : kNone;
  }

 private:
  const char* remedy_;
  std::optional<Error> error_;
};

/// `read(document)` of a text; the library reports by exceptions, none of which leaves this.
template <class Read>
auto read_json(std::string_view text, const char* remedy, Read read)
    -> decltype(read(std::declval<const Json&>())) {
  try {
    return read(Json::parse(text));
  } catch (const Json::parse_error& broken) {
    return limn::fail(ErrorCode::kSyntax, "byte " + std::to_string(broken.byte),
                      "the JSON is broken here", remedy);
  } catch (const Json::out_of_range&) {
    return limn::fail(ErrorCode::kSyntax, "", "a number is too large for a double", remedy);
  }
}

}  // namespace limn::exchange_detail
