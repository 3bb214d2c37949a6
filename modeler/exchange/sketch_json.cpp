#include "modeler/exchange/sketch_json.hpp"

#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "modeler/exchange/json_checker.hpp"
#include "modeler/surface/measures.hpp"

namespace limn {
namespace {

using exchange_detail::Json;
using Checker = exchange_detail::JsonChecker;

constexpr const char* kRemedy = "give a file that limn sketch wrote";

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

/// A time in seconds.
Timestamp time_from_json(Checker& check, const Json& value, const std::string& place) {
  constexpr double kMostSeconds = 9e9;  // what 64 bits of nanoseconds hold
  const double x = check.number(value, place);
  if (std::abs(x) <= kMostSeconds) return Timestamp(std::llround(x * 1e9));
  check.fail(place, "this is too large for a time in seconds");
  return {};
}

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
  auto points = check.points<2>(member("control_points"), place + "/control_points");
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
  out.t0 = time_from_json(check, member("t0"), place + "/t0");
  out.t1 = time_from_json(check, member("t1"), place + "/t1");
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
  Checker check(kRemedy);
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
  return exchange_detail::read_json(json, kRemedy, sketch_from_document);
}

}  // namespace limn
