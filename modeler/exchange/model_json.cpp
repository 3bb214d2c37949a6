#include "modeler/exchange/model_json.hpp"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "modeler/exchange/json_checker.hpp"

namespace limn {
namespace {

using exchange_detail::Json;
using Checker = exchange_detail::JsonChecker;

constexpr int kVersion = 1;
constexpr const char* kRemedy = "give a *.limn.json file as limn writes it";

// Writing.

/// On one line; what is not UTF-8 in a name becomes a replacement character.
std::string dumped(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json points_to_json(const SplineData& spline) {
  Json out = Json::array();
  const auto width = static_cast<std::size_t>(spline.width());
  const std::vector<double> all = spline.coordinates().to_vector();
  for (std::size_t i = 0; i < all.size(); i += width) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(i);
    out.push_back(std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(width)));
  }
  return out;
}

template <int kDimension>
Json curve_to_json(const BsplineCurve<kDimension>& curve) {
  return {{"degree", curve.knots().degree()},
          {"periodic", curve.knots().is_periodic()},
          {"rational", curve.is_rational()},
          {"knots", curve.knots().values()},
          {"control_points", points_to_json(curve.data())}};
}

Json surface_to_json(const BsplineSurface& surface) {
  const KnotVector& u = surface.knots(0);
  const KnotVector& v = surface.knots(1);
  return {{"degree", {u.degree(), v.degree()}},
          {"periodic", {u.is_periodic(), v.is_periodic()}},
          {"rational", surface.is_rational()},
          {"knots", {u.values(), v.values()}},
          {"control_points", points_to_json(surface.data())}};
}

Json face_to_json(const Face& face) {
  Json loops = Json::array();
  for (const Loop& loop : face.loops) {
    Json trims = Json::array();
    for (const Trim& trim : loop) {
      trims.push_back(
          {{"edge", trim.edge}, {"reversed", trim.reversed}, {"curve", curve_to_json(trim.curve)}});
    }
    loops.push_back(std::move(trims));
  }
  return {{"reversed", face.reversed},
          {"surface", surface_to_json(face.surface)},
          {"loops", std::move(loops)}};
}

Json point_to_json(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// An array with an element a line.
template <class List, class ToJson>
void write_list(std::string& out, const char* key, const List& list, ToJson to_json) {
  out += "\"";
  out += key;
  out += "\":[";
  const char* separator = "\n";
  for (const auto& item : list) {
    out += separator;
    out += dumped(to_json(item));
    separator = ",\n";
  }
  out += "]";
}

void write_body(std::string& out, const Body& body) {
  out += "{\"name\":" + dumped(body.name) + ",\n";
  write_list(out, "vertices", body.vertices, point_to_json);
  out += ",\n";
  write_list(out, "edges", body.edges, [](const Edge& edge) -> Json {
    return {{"vertices", edge.vertices},
            {"deviation_mm", edge.deviation},
            {"curve", curve_to_json(edge.curve)}};
  });
  out += ",\n";
  write_list(out, "faces", body.faces, face_to_json);
  out += "}";
}

// Reading.

/// A spline whose "degree", "periodic" and "knots" are one value, or one a direction.
template <int kDirections, int kDimension>
TensorSpline<kDirections, kDimension> spline_from_json(Checker& check, const Json& value,
                                                       const std::string& place) {
  using Spline = TensorSpline<kDirections, kDimension>;
  if (!value.is_object()) {
    check.fail(place, "this is not an object");
    return {};
  }
  const auto in_direction = [&](const char* key, int d) -> const Json& {
    const Json& all = check.member(value, place, key);
    if constexpr (kDirections == 1) return all;
    static const Json kNull;
    if (all.is_array() && all.size() == std::size_t{kDirections}) {
      return all[static_cast<std::size_t>(d)];
    }
    check.fail(place + "/" + key, "this is not an array of two, for u and v");
    return kNull;
  };
  const auto at = [&](const char* key, int d) {
    return place + "/" + key + (kDirections == 1 ? "" : "/" + std::to_string(d));
  };
  typename Spline::Knots knots;
  for (int d = 0; d < kDirections && !check.failed(); ++d) {
    const int degree = check.count(in_direction("degree", d), at("degree", d));
    const bool periodic = check.truth(in_direction("periodic", d), at("periodic", d));
    auto values = check.numbers(in_direction("knots", d), at("knots", d));
    if (check.failed()) return {};
    auto made =
        KnotVector::make(degree, std::move(values), periodic ? Closure::kPeriodic : Closure::kOpen);
    if (!made) {
      made.error().at = at("knots", d) + ", " + made.error().at;
      check.fail(std::move(made.error()));
      return {};
    }
    knots[static_cast<std::size_t>(d)] = *std::move(made);
  }
  const bool rational = check.truth(check.member(value, place, "rational"), place + "/rational");
  const Json& points = check.member(value, place, "control_points");
  const std::string here = place + "/control_points";
  std::vector<double> coordinates;
  const auto take = [&](const auto& list) {
    for (const auto& p : list) coordinates.insert(coordinates.end(), p.data(), p.data() + p.size());
  };
  if (rational) {
    take(check.points<kDimension + 1>(points, here));
  } else {
    take(check.points<kDimension>(points, here));
  }
  if (check.failed()) return {};
  auto made = SplineData::make(knots, kDimension, rational ? Form::kRational : Form::kPolynomial,
                               coordinates);
  if (!made) {
    made.error().at = place + ", " + made.error().at;
    check.fail(std::move(made.error()));
    return {};
  }
  return Spline::of(*std::move(made));
}

std::string name_from_json(Checker& check, const Json& object, const std::string& place) {
  const Json& value = check.member(object, place, "name");
  if (value.is_string()) return value.get<std::string>();
  check.fail(place + "/name", "this is not a text");
  return {};
}

/// The number of one of `count` things.
std::size_t index_from_json(Checker& check, const Json& value, const std::string& place,
                            std::size_t count) {
  const auto index = static_cast<std::size_t>(check.count(value, place));
  if (index < count) return index;
  check.fail({ErrorCode::kOutOfRange, place,
              "it names number " + std::to_string(index) + " of " + std::to_string(count),
              "count from 0"});
  return 0;
}

/// Calls `use(element, place)` for each of an array, until the first error.
template <class Use>
void for_each(Checker& check, const Json& array, const std::string& place, Use use) {
  if (!array.is_array()) check.fail(place, "this is not an array");
  std::size_t i = 0;
  for (const Json& element : Checker::elements(array)) {
    if (check.failed()) return;
    use(element, place + "/" + std::to_string(i++));
  }
}

/// The same for a member of an object.
template <class Use>
void for_each_of(Checker& check, const Json& object, const std::string& place, const char* key,
                 Use use) {
  if (!object.is_object()) check.fail(place, "this is not an object");
  if (check.failed()) return;
  for_each(check, check.member(object, place, key), place + "/" + key, use);
}

Edge edge_from_json(Checker& check, const Json& value, const std::string& place,
                    std::size_t vertices) {
  Edge out;
  std::size_t ends = 0;
  for_each_of(check, value, place, "vertices", [&](const Json& vertex, const std::string& at) {
    const std::size_t index = index_from_json(check, vertex, at, vertices);
    if (ends < out.vertices.size()) out.vertices[ends] = index;
    ++ends;
  });
  if (ends != out.vertices.size()) check.fail(place + "/vertices", "an edge has two ends");
  if (check.failed()) return out;
  out.deviation = check.number(check.member(value, place, "deviation_mm"), place + "/deviation_mm");
  out.curve = spline_from_json<1, 3>(check, check.member(value, place, "curve"), place + "/curve");
  return out;
}

Face face_from_json(Checker& check, const Json& value, const std::string& place,
                    std::size_t edges) {
  Face out;
  for_each_of(check, value, place, "loops", [&](const Json& loop, const std::string& loop_at) {
    out.loops.emplace_back();
    for_each(check, loop, loop_at, [&](const Json& trim, const std::string& at) {
      if (!trim.is_object()) return check.fail(at, "this is not an object");
      Trim made;
      made.edge = index_from_json(check, check.member(trim, at, "edge"), at + "/edge", edges);
      made.reversed = check.truth(check.member(trim, at, "reversed"), at + "/reversed");
      made.curve = spline_from_json<1, 2>(check, check.member(trim, at, "curve"), at + "/curve");
      out.loops.back().push_back(std::move(made));
    });
    if (out.loops.back().empty()) check.fail(loop_at, "a loop has one trim at least");
  });
  if (check.failed()) return out;
  out.reversed = check.truth(check.member(value, place, "reversed"), place + "/reversed");
  out.surface =
      spline_from_json<2, 3>(check, check.member(value, place, "surface"), place + "/surface");
  return out;
}

Body body_from_json(Checker& check, const Json& value, const std::string& place) {
  Body out;
  if (!value.is_object()) {
    check.fail(place, "this is not an object");
    return out;
  }
  out.name = name_from_json(check, value, place);
  out.vertices = check.points<3>(check.member(value, place, "vertices"), place + "/vertices");
  for_each_of(check, value, place, "edges", [&](const Json& edge, const std::string& at) {
    out.edges.push_back(edge_from_json(check, edge, at, out.vertices.size()));
  });
  for_each_of(check, value, place, "faces", [&](const Json& face, const std::string& at) {
    out.faces.push_back(face_from_json(check, face, at, out.edges.size()));
  });
  return out;
}

Expected<Model> model_from_document(const Json& document) {
  Checker check(kRemedy);
  if (!document.is_object()) check.fail("", "the file is not a JSON object");
  Model out;
  if (!check.failed()) {
    const int version = check.count(check.member(document, "", "limn_model"), "/limn_model");
    if (!check.failed() && version != kVersion) {
      check.fail({ErrorCode::kUnknown, "/limn_model",
                  "the file is of version " + std::to_string(version) + ", this limn reads " +
                      std::to_string(kVersion),
                  "open it with a newer limn"});
    }
  }
  for_each_of(check, document, "", "bodies", [&](const Json& body, const std::string& at) {
    out.bodies.push_back(body_from_json(check, body, at));
  });
  for_each_of(check, document, "", "curves", [&](const Json& curve, const std::string& at) {
    if (!curve.is_object()) return check.fail(at, "this is not an object");
    std::string name = name_from_json(check, curve, at);
    out.curves.push_back(
        {std::move(name),
         spline_from_json<1, 3>(check, check.member(curve, at, "curve"), at + "/curve")});
  });
  if (check.failed()) return tl::unexpected(check.error());
  return out;
}

}  // namespace

std::string model_to_json(const Model& model) {
  std::string out = "{\"limn_model\":" + std::to_string(kVersion) + ",\n\"bodies\":[";
  const char* separator = "\n";
  for (const Body& body : model.bodies) {
    out += separator;
    write_body(out, body);
    separator = ",\n";
  }
  out += "],\n";
  write_list(out, "curves", model.curves, [](const NamedCurve& curve) -> Json {
    return {{"name", curve.name}, {"curve", curve_to_json(curve.curve)}};
  });
  return out + "}\n";
}

Expected<Model> model_from_json(std::string_view json) {
  return exchange_detail::read_json(json, kRemedy, model_from_document);
}

}  // namespace limn
