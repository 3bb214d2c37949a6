#include "modeler/exchange/sketch_json.hpp"

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "modeler/surface/measures.hpp"

namespace limn {
namespace {

using Json = nlohmann::ordered_json;

/// Seconds of a time, rounded once: the quotient prints as short as the time is.
double seconds(Timestamp t) { return static_cast<double>(t.count()) / 1e9; }

Json stroke_to_json(const SketchStroke& stroke) {
  Json points = Json::array();
  for (const Eigen::Vector2d& p : stroke.curve.control_points()) {
    points.push_back(Json::array({p.x(), p.y()}));
  }
  Json out = {{"samples", stroke.samples},
              {"t0", seconds(stroke.t0)},
              {"t1", seconds(stroke.t1)},
              {"degree", stroke.curve.knots().degree()},
              {"knots", stroke.curve.knots().values()},
              {"control_points", std::move(points)},
              {"closed", stroke.closed()},
              {"corners", stroke.corners},
              {"deviation_max_mm", stroke.deviation_max_mm},
              {"deviation_rms_mm", stroke.deviation_rms_mm}};
  if (stroke.tool != Tool::kPen) out["tool"] = name(stroke.tool);
  return out;
}

Error malformed(std::string place, std::string what) {
  return {ErrorCode::kSyntax, std::move(place), std::move(what),
          "give a file that limn sketch wrote"};
}

/// Takes values out of a JSON document and remembers the first error; after it, what is returned
/// means nothing. Places are JSON pointers, as /strokes/3/knots/0.
class Checker {
 public:
  bool failed() const { return error_.has_value(); }
  Error error() const { return *error_; }

  void fail(Error error) {
    if (!error_) error_ = std::move(error);
  }
  void fail(const std::string& place, const char* what) { fail(malformed(place, what)); }

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

  Timestamp time(const Json& value, const std::string& place) {
    constexpr double kMostSeconds = 9e9;  // what 64 bits of nanoseconds hold
    const double x = number(value, place);
    if (std::abs(x) <= kMostSeconds) return Timestamp(std::llround(x * 1e9));
    fail(place, "this is too large for a time in seconds");
    return {};
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

  std::vector<Eigen::Vector2d> points(const Json& value, const std::string& place) {
    std::vector<Eigen::Vector2d> out;
    if (!value.is_array()) fail(place, "this is not an array");
    for (const Json& x : elements(value)) {
      if (failed()) break;
      const std::string here = place + "/" + std::to_string(out.size());
      const std::vector<double> xy = numbers(x, here);
      if (xy.size() != 2) {
        fail(here, "a point has two coordinates");
        break;
      }
      out.emplace_back(xy[0], xy[1]);
    }
    return out;
  }

  /// A scalar is a range of one to the library; here it has no elements.
  static const Json& elements(const Json& value) {
    static const Json kNone = Json::array();
    return value.is_array() ? value : kNone;
  }

 private:
  std::optional<Error> error_;
};

Tool tool_from_json(Checker& check, const Json& stroke, const std::string& place) {
  const auto found = stroke.find("tool");
  if (found == stroke.end() || *found == name(Tool::kPen)) return Tool::kPen;
  if (*found != name(Tool::kEraser)) check.fail(place + "/tool", "this tool makes no strokes");
  return Tool::kEraser;
}

BsplineCurve<2> curve_from_json(Checker& check, const Json& stroke, const std::string& place) {
  const auto member = [&](const char* key) -> const Json& {
    return check.member(stroke, place, key);
  };
  const int degree = check.count(member("degree"), place + "/degree");
  auto values = check.numbers(member("knots"), place + "/knots");
  auto points = check.points(member("control_points"), place + "/control_points");
  const bool closed = check.truth(member("closed"), place + "/closed");
  if (degree == 0 && points.size() != 1) {
    check.fail({ErrorCode::kPointCount, place + "/control_points",
                "degree 0 is a dot, but it has " + std::to_string(points.size()) + " points",
                "give a dot one point"});
  }
  if (check.failed()) return {};

  const auto invalid = [&](Error error) {
    error.at = place + (error.at.empty() ? "" : ", " + error.at);
    check.fail(std::move(error));
    return BsplineCurve<2>();
  };
  auto knots =
      KnotVector::make(degree, std::move(values), closed ? Closure::kPeriodic : Closure::kOpen);
  if (!knots) return invalid(std::move(knots.error()));
  auto curve = BsplineCurve<2>::make(*std::move(knots), points);
  if (!curve) return invalid(std::move(curve.error()));
  return *std::move(curve);
}

SketchStroke stroke_from_json(Checker& check, const Json& stroke, const std::string& place) {
  SketchStroke out;
  if (!stroke.is_object()) {
    check.fail(place, "this is not an object");
    return out;
  }
  const auto member = [&](const char* key) -> const Json& {
    return check.member(stroke, place, key);
  };
  out.samples = static_cast<std::size_t>(check.count(member("samples"), place + "/samples"));
  out.t0 = check.time(member("t0"), place + "/t0");
  out.t1 = check.time(member("t1"), place + "/t1");
  out.corners = check.numbers(member("corners"), place + "/corners");
  out.deviation_max_mm = check.number(member("deviation_max_mm"), place + "/deviation_max_mm");
  out.deviation_rms_mm = check.number(member("deviation_rms_mm"), place + "/deviation_rms_mm");
  out.tool = tool_from_json(check, stroke, place);
  out.curve = curve_from_json(check, stroke, place);
  out.length_mm = arc_length(out.curve).value;
  for (const double u : out.corners) {
    if (u < out.curve.knots().domain_begin() || u > out.curve.knots().domain_end()) {
      check.fail({ErrorCode::kOutOfRange, place + "/corners",
                  "a corner lies outside the curve's domain", "give corners inside the domain"});
    }
  }
  return out;
}

Expected<Sketch> sketch_from_document(const Json& document) {
  Checker check;
  if (!document.is_object()) check.fail("", "the file is not a JSON object");
  Sketch out;
  out.tolerance_mm = check.number(check.member(document, "", "tolerance_mm"), "/tolerance_mm");
  const Json& strokes = check.member(document, "", "strokes");
  if (!strokes.is_array()) check.fail("/strokes", "this is not an array");
  for (const Json& stroke : Checker::elements(strokes)) {
    if (check.failed()) break;
    const std::string place = "/strokes/" + std::to_string(out.strokes.size());
    out.strokes.push_back(stroke_from_json(check, stroke, place));
  }
  if (check.failed()) return tl::unexpected(check.error());
  return out;
}

}  // namespace

std::string sketch_to_json(const Sketch& sketch) {
  std::string out = "{\"tolerance_mm\":" + Json(sketch.tolerance_mm).dump() + ",\"strokes\":[";
  const char* separator = "\n";
  for (const SketchStroke& stroke : sketch.strokes) {
    out += separator;
    out += stroke_to_json(stroke).dump();
    separator = ",\n";
  }
  return out + "]}\n";
}

Expected<Sketch> sketch_from_json(std::string_view json) {
  // The library reports by exceptions; none leaves this function.
  try {
    return sketch_from_document(Json::parse(json));
  } catch (const Json::parse_error& broken) {
    return tl::unexpected(
        malformed("byte " + std::to_string(broken.byte), "the JSON is broken here"));
  } catch (const Json::out_of_range&) {
    return tl::unexpected(malformed("", "a number is too large for a double"));
  }
}

}  // namespace limn
