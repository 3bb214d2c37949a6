// limn make, info and convert: models into files, about files, from one file to another.

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "modeler/app/command.hpp"
#include "modeler/app/model_file.hpp"
#include "modeler/app/standard_output.hpp"
#include "modeler/app/table.hpp"
#include "modeler/model/sewing.hpp"
#include "modeler/surface/primitives.hpp"

namespace limn::app {
namespace {

constexpr double kSewing = 1e-7;  ///< mm, of exact shapes: rounding

using Surfaces = std::vector<BsplineSurface>;

template <class T>
Expected<Surfaces> one(Expected<T> surface) {
  if (!surface) return tl::unexpected(std::move(surface.error()));
  return Surfaces{*std::move(surface)};
}

Expected<Surfaces> box(const std::vector<double>& size) {
  auto faces = make_box({}, {size[0], size[1], size[2]});
  if (!faces) return tl::unexpected(std::move(faces.error()));
  return Surfaces(faces->begin(), faces->end());
}

/// A lid at height z that looks up or down.
Expected<BsplineSurface> lid(double radius, double z, bool up) {
  Frame frame;
  frame.origin = {0, 0, z};
  if (!up) {
    frame.y = -frame.y;
    frame.z = -frame.z;
  }
  return make_disc(frame, radius);
}

/// Walls between two radii, with lids where those are above 0.
Expected<Surfaces> turned(double bottom, double top, double height) {
  auto wall =
      bottom == top ? make_cylinder({}, bottom, height) : make_cone({}, bottom, top, height);
  if (!wall) return tl::unexpected(std::move(wall.error()));
  Surfaces out = {*std::move(wall)};
  for (const bool up : {false, true}) {
    const double radius = up ? top : bottom;
    if (!(radius > 0)) continue;
    auto made = lid(radius, up ? height : 0, up);
    if (!made) return tl::unexpected(std::move(made.error()));
    out.push_back(*std::move(made));
  }
  return out;
}

struct Kind {
  const char* name;
  std::vector<double> size;  ///< what it has unless given
  Expected<Surfaces> (*make)(const std::vector<double>& size);
};

const std::vector<Kind>& kinds() {
  using Size = const std::vector<double>&;
  static const std::vector<Kind> all = {
      {"box", {40, 30, 20}, box},
      {"cone", {20, 10, 30}, [](Size s) { return turned(s[0], s[1], s[2]); }},
      {"cylinder", {15, 40}, [](Size s) { return turned(s[0], s[0], s[1]); }},
      {"disc", {20}, [](Size s) { return one(make_disc({}, s[0])); }},
      {"plane", {40, 30}, [](Size s) { return one(make_plane({}, s[0], s[1])); }},
      {"sphere", {20}, [](Size s) { return one(make_sphere({}, s[0])); }},
      {"torus", {20, 7}, [](Size s) { return one(make_torus({}, s[0], s[1])); }},
  };
  return all;
}

std::string names_of_kinds() {
  std::string out;
  for (const Kind& kind : kinds()) out += (out.empty() ? "" : ", ") + std::string(kind.name);
  return out;
}

void print_skipped(const std::string& path, const std::vector<std::string>& skipped) {
  for (const std::string& line : skipped) {
    std::fprintf(stderr, "limn: %s: skipped %s\n", path.c_str(), line.c_str());
  }
}

void print_report(const std::string& path, const ReadBack& report) {
  std::fprintf(stderr, "%s: %zu faces, %zu curves, read back within %.2g mm\n", path.c_str(),
               report.faces, report.curves, report.deviation_mm);
}

Outcome write_and_report(const Model& model, const std::string& path, bool ap242) {
  const auto report = write_model(model, path, ap242);
  if (!report) return tl::unexpected(report.error());
  print_report(path, *report);
  return {};
}

/// How often a spline can be derived at least, across its knots: C^k for the least degree minus
/// multiplicity.
int continuity(std::span<const KnotVector> all) {
  int least = KnotVector::kMaxDegree;
  for (const KnotVector& knots : all) {
    for (const double u : knots.breakpoints()) {
      const bool is_end = u == knots.domain_begin() || u == knots.domain_end();
      if (is_end && !knots.is_periodic()) continue;
      least = std::min(least, knots.degree() - knots.multiplicity(u));
    }
  }
  return least;
}

template <class Points>
Eigen::AlignedBox3d bounds_of(const Points& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  return box;
}

std::string size_of(const Eigen::AlignedBox3d& box) {
  std::array<char, 96> text;
  const Eigen::Vector3d size = box.sizes();
  std::snprintf(text.data(), text.size(), "%.4g x %.4g x %.4g", size.x(), size.y(), size.z());
  return text.data();
}

std::string in_both(int u, int v) { return std::to_string(u) + " x " + std::to_string(v); }

/// C^infinity where there is no knot inside.
std::string smoothness(const SplineData& data) {
  const int k = continuity(data.knots());
  return k == KnotVector::kMaxDegree ? "smooth" : "C" + std::to_string(k);
}

}  // namespace

Outcome run_make(const MakeArguments& arguments) {
  const auto kind = std::find_if(kinds().begin(), kinds().end(),
                                 [&](const Kind& k) { return arguments.kind == k.name; });
  if (kind == kinds().end()) {
    return usage_error("there is no shape '" + arguments.kind + "'", "choose " + names_of_kinds());
  }
  const std::vector<double>& size = arguments.size.empty() ? kind->size : arguments.size;
  if (size.size() != kind->size.size()) {
    return usage_error("a " + arguments.kind + " has " + std::to_string(kind->size.size()) +
                           " sizes, not " + std::to_string(size.size()),
                       "give that many, in mm");
  }
  auto body = kind->make(size).and_then(
      [&](Surfaces surfaces) { return sew(kind->name, std::move(surfaces), kSewing); });
  if (!body) return in_file("", Expected<void>(tl::unexpected(std::move(body.error()))));
  return write_and_report({{*std::move(body)}, {}}, arguments.output, false);
}

Outcome run_convert_model(const ConvertModelArguments& arguments) {
  if (auto known = model_format_of(arguments.output); !known) {
    return tl::unexpected(known.error());
  }
  const auto read = read_model(arguments.input);
  if (!read) return tl::unexpected(read.error());
  print_skipped(arguments.input, read->skipped);
  return write_and_report(read->model, arguments.output, arguments.ap242);
}

Outcome run_info(const InfoArguments& arguments) {
  const auto read = read_model(arguments.path);
  if (!read) return tl::unexpected(read.error());
  print_skipped(arguments.path, read->skipped);
  Table table({{"part", "part"},
               {"kind", "kind"},
               {"degree", "degree"},
               {"control_points", "control points"},
               {"rational", "rational"},
               {"continuity", "continuity"},
               {"loops", "loops"},
               {"trims", "trims"},
               {"bounds_mm", "hull mm"}});
  for (const Body& body : read->model.bodies) {
    Eigen::AlignedBox3d bounds;
    std::size_t trims = 0;
    std::size_t loops = 0;
    for (std::size_t i = 0; i < body.faces.size(); ++i) {
      const Face& face = body.faces[i];
      const BsplineSurface& s = face.surface;
      const Eigen::AlignedBox3d of_face = bounds_of(s.control_points());
      bounds.extend(of_face);
      std::size_t of_loops = 0;
      for (const Loop& loop : face.loops) of_loops += loop.size();
      trims += of_loops;
      loops += face.loops.size();
      table.add({body.name + "/" + std::to_string(i + 1), std::string("face"),
                 in_both(s.knots(0).degree(), s.knots(1).degree()),
                 in_both(s.knots(0).basis_count(), s.knots(1).basis_count()), s.is_rational(),
                 smoothness(s.data()), static_cast<std::int64_t>(face.loops.size()),
                 static_cast<std::int64_t>(of_loops), size_of(of_face)});
    }
    table.add({body.name, std::string(is_closed(body) ? "solid" : "shell"), Cell(), Cell(), Cell(),
               Cell(), static_cast<std::int64_t>(loops), static_cast<std::int64_t>(trims),
               size_of(bounds)});
  }
  for (const NamedCurve& curve : read->model.curves) {
    const BsplineCurve<3>& c = curve.curve;
    table.add({curve.name, std::string("curve"), std::to_string(c.knots().degree()),
               std::to_string(c.control_points().size()), c.is_rational(), smoothness(c.data()),
               Cell(), Cell(), size_of(bounds_of(c.control_points()))});
  }
  return print(table.print(arguments.format));
}

}  // namespace limn::app
