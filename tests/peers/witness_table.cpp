#include "tests/peers/witness_table.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

namespace limn::peers {

namespace {

using Json = nlohmann::json;

PeerSurface surface_of(const Json& json) {
  return {json.at("degree"), json.at("knots"), json.at("count"), json.at("points"),
          json.at("weights")};
}

WitnessedPlace place_of(const Json& json) {
  WitnessedPlace out;
  out.at = {json.at("at").at(0), json.at("at").at(1)};
  out.point = json.at("point");
  out.normal = json.at("normal");
  out.u_derivatives = json.at("u_derivatives");
  out.v_derivatives = json.at("v_derivatives");
  return out;
}

}  // namespace

std::vector<WitnessedSurface> read_witness_table(const std::filesystem::path& file) {
  std::ifstream in(file);
  const Json json = Json::parse(in);
  std::vector<WitnessedSurface> out;
  for (const auto& entry : json.at("surfaces")) {
    WitnessedSurface& surface = out.emplace_back();
    surface.surface = surface_of(entry);
    for (const auto& place : entry.at("places")) surface.places.push_back(place_of(place));
  }
  return out;
}

std::string witness_questions(const std::vector<WitnessedSurface>& surfaces) {
  std::string out = "{\"surfaces\":[\n";
  for (const auto& [surface, places] : surfaces) {
    nlohmann::ordered_json line = {
        {"degree", surface.degree},   {"count", surface.count},
        {"knots", surface.knots},     {"points", surface.points},
        {"weights", surface.weights}, {"places", nlohmann::ordered_json::array()}};
    for (const auto& place : places) line["places"].push_back({{"at", {place.at.u, place.at.v}}});
    out += line.dump() + (&surface == &surfaces.back().surface ? "\n" : ",\n");
  }
  return out + "]}\n";
}

}  // namespace limn::peers
