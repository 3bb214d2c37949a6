// Models through STEP and IGES and back. Open CASCADE measures what it makes of them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <GProp_GProps.hxx>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "modeler/exchange/cad_files.hpp"
#include "modeler/exchange/occt_shape.hpp"
#include "modeler/model/sewing.hpp"
#include "modeler/surface/measures.hpp"
#include "modeler/surface/primitives.hpp"

// Open CASCADE's readers and writers keep some of what they make; not of limn's making.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libTK\n"; }

namespace limn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;
using testing::HasSubstr;

constexpr double kTolerance = 1e-6;  // mm, of sewing
constexpr double kStep = 1e-9;       // mm: what STEP may lose
constexpr double kIges = 1e-6;       // and IGES

struct Solid {
  const char* name;
  Body body;
  double area;
  double volume;
};

std::vector<Solid> solids() {
  Frame top;
  top.origin = {0, 0, 12};
  const auto box = *make_box({}, {10, 20, 30});
  std::vector<Solid> out;
  out.push_back({"box", *sew("box", {box.begin(), box.end()}, kTolerance), 2200, 6000});
  out.push_back({"sphere", *sew("sphere", {*make_sphere({}, 7)}, kTolerance), 4 * pi * 49,
                 4.0 / 3 * pi * 343});
  out.push_back({"torus", *sew("torus", {*make_torus({}, 10, 3)}, kTolerance), 4 * pi * pi * 30,
                 2 * pi * pi * 90});
  Body can =
      *sew("can", {*make_cylinder({}, 5, 12), *make_disc({}, 5), *make_disc(top, 5)}, kTolerance);
  can.faces[1].reversed = true;  // its normal is to point down, out of the body
  out.push_back({"can", std::move(can), 2 * pi * 25 + 120 * pi, 300 * pi});
  return out;
}

/// A square of side 10 with a round hole of radius 2 about (4, 5).
Body square_with_hole() {
  Body body = *sew("plate", {*make_plane({}, 10, 10)}, kTolerance);
  Frame middle;
  middle.origin = {4, 5, 0};
  const BsplineCurve<3> circle = *make_circle(middle, 2);
  std::vector<Vector2d> points;
  std::vector<double> weights;
  for (std::size_t i = 0; i < circle.control_points().size(); ++i) {
    points.push_back(circle.control_points()[i].head<2>());
    weights.push_back(circle.weight(i));
  }
  Trim trim;
  trim.edge = body.edges.size();
  trim.reversed = true;  // a hole turns clockwise
  trim.curve = *BsplineCurve<2>::make_rational({circle.knots()}, points, weights);
  body.vertices.push_back({6, 5, 0});
  body.edges.push_back({circle, {body.vertices.size() - 1, body.vertices.size() - 1}, 0});
  body.faces[0].loops.push_back({trim});
  return body;
}

double area_of(const Body& body) {
  const auto shape = exchange_detail::shape_of(body);
  EXPECT_TRUE(shape.has_value());
  EXPECT_TRUE(BRepCheck_Analyzer(*shape).IsValid());
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(*shape, properties, 1e-10);
  return properties.Mass();
}

double volume_of(const Body& body) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(*exchange_detail::shape_of(body), properties, 1e-10);
  return properties.Mass();
}

/// Surfaces of both at the same parameters.
double largest_gap(const Body& a, const Body& b) {
  double gap = 0;
  for (std::size_t f = 0; f < a.faces.size(); ++f) {
    const BsplineSurface& s = a.faces[f].surface;
    const BsplineSurface& t = b.faces[f].surface;
    for (double x = 0; x <= 1; x += 0.0625) {
      for (double y = 0; y <= 1; y += 0.0625) {
        const auto at = [](const KnotVector& k, double z) {
          return k.domain_begin() + z * (k.domain_end() - k.domain_begin());
        };
        gap = std::max(gap, (s.point({at(s.knots(0), x), at(s.knots(1), y)}) -
                             t.point({at(t.knots(0), x), at(t.knots(1), y)}))
                                .norm());
      }
    }
  }
  return gap;
}

Model read_back_step(const Model& model, StepSchema schema) {
  const auto text = model_to_step(model, schema);
  EXPECT_TRUE(text.has_value()) << text.error().what;
  auto read = model_from_step(*text);
  EXPECT_TRUE(read.has_value()) << read.error().what;
  EXPECT_TRUE(read->skipped.empty());
  return std::move(read->model);
}

Model read_back_iges(const Model& model) {
  const auto text = model_to_iges(model);
  EXPECT_TRUE(text.has_value()) << text.error().what;
  const std::string path = testing::TempDir() + "/limn_model.igs";
  std::ofstream(path) << *text;
  auto read = model_from_iges(path);
  EXPECT_TRUE(read.has_value()) << read.error().what;
  std::remove(path.c_str());
  return std::move(read->model);
}

TEST(CadFiles, OpenCascadeMeasuresBodiesRightly) {
  for (const Solid& solid : solids()) {
    EXPECT_NEAR(area_of(solid.body), solid.area, 1e-9 * solid.area) << solid.name;
    EXPECT_NEAR(volume_of(solid.body), solid.volume, 1e-9 * solid.volume) << solid.name;
  }
  EXPECT_NEAR(area_of(square_with_hole()), 100 - 4 * pi, 1e-8);
}

TEST(CadFiles, StepGivesBackTheSameSolids) {
  for (const StepSchema schema : {StepSchema::kAp214, StepSchema::kAp242}) {
    for (const Solid& solid : solids()) {
      const Model back = read_back_step({{solid.body}, {}}, schema);
      ASSERT_EQ(back.bodies.size(), 1U) << solid.name;
      const Body& body = back.bodies[0];
      ASSERT_EQ(body.faces.size(), solid.body.faces.size()) << solid.name;
      EXPECT_EQ(body.edges.size(), solid.body.edges.size()) << solid.name;
      EXPECT_TRUE(is_closed(body)) << solid.name;
      EXPECT_LE(largest_gap(solid.body, body), kStep) << solid.name;
      EXPECT_NEAR(area_of(body), solid.area, 1e-9 * solid.area) << solid.name;
      EXPECT_NEAR(volume_of(body), solid.volume, 1e-9 * solid.volume) << solid.name;
    }
  }
}

TEST(CadFiles, StepGivesBackTrims) {
  const Model back = read_back_step({{square_with_hole()}, {}}, StepSchema::kAp214);
  ASSERT_EQ(back.bodies.size(), 1U);
  ASSERT_EQ(back.bodies[0].faces.size(), 1U);
  EXPECT_EQ(back.bodies[0].faces[0].loops.size(), 2U);
  EXPECT_NEAR(area_of(back.bodies[0]), 100 - 4 * pi, 1e-9 * 100);
}

TEST(CadFiles, StepNamesItsSchema) {
  const Model model{{}, {{"circle", *make_circle({}, 5)}}};
  const std::string ap214 = *model_to_step(model, StepSchema::kAp214);
  const std::string ap242 = *model_to_step(model, StepSchema::kAp242);
  EXPECT_NE(ap214.find("AUTOMOTIVE_DESIGN"), std::string::npos);
  EXPECT_NE(ap242.find("AP242"), std::string::npos);
  EXPECT_NE(ap214.find("PRODUCT('circle','circle'"), std::string::npos);
}

TEST(CadFiles, TheSameModelGivesTheSameBytes) {
  const Model model{{solids()[1].body}, {{"circle", *make_circle({}, 5)}}};
  EXPECT_TRUE(*model_to_step(model) == *model_to_step(model));
  EXPECT_TRUE(*model_to_iges(model) == *model_to_iges(model));
}

TEST(CadFiles, IgesGivesBackFacesAndTrims) {
  for (const Solid& solid : solids()) {
    const Model back = read_back_iges({{solid.body}, {}});
    double area = 0;
    std::size_t faces = 0;
    for (const Body& body : back.bodies) {
      area += area_of(body);
      faces += body.faces.size();
    }
    EXPECT_EQ(faces, solid.body.faces.size()) << solid.name;
    EXPECT_NEAR(area, solid.area, kIges * solid.area) << solid.name;
  }
  const Model plate = read_back_iges({{square_with_hole()}, {}});
  ASSERT_EQ(plate.bodies.size(), 1U);
  EXPECT_NEAR(area_of(plate.bodies[0]), 100 - 4 * pi, kIges * 100);
}

TEST(CadFiles, PlanesCylindersAndSpheresBecomeSplines) {
  const TopoDS_Shape shapes[] = {
      BRepPrimAPI_MakeCylinder(5, 12).Shape(), BRepPrimAPI_MakeSphere(7).Shape(),
      BRepPrimAPI_MakeTorus(10, 3).Shape(), BRepPrimAPI_MakeCone(5, 2, 8).Shape()};
  for (const TopoDS_Shape& shape : shapes) {
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(shape, properties, 1e-10);
    Model model;
    std::vector<std::string> skipped;
    exchange_detail::add_shape(shape, model, skipped);
    EXPECT_TRUE(skipped.empty());
    ASSERT_EQ(model.bodies.size(), 1U);
    EXPECT_TRUE(is_closed(model.bodies[0]));
    EXPECT_NEAR(area_of(model.bodies[0]), properties.Mass(), kIges * properties.Mass());
  }
}

TEST(CadFiles, FreeCurvesComeBack) {
  const BsplineCurve<3> circle = *make_circle({}, 5);
  const auto knots = *KnotVector::make_periodic(3, std::vector{0.0, 1.0, 2.0, 3.0}, 4.0);
  const BsplineCurve<3> loop = *BsplineCurve<3>::make(
      knots, {{0, 0, 0}, {3, 0, 1}, {3, 3, 0}, {0, 3, 2}, {0, 0, 0}, {3, 0, 1}, {3, 3, 0}});
  const Model both{{}, {{"loop", loop}, {"circle", circle}}};
  for (const Model& back : {read_back_step(both, StepSchema::kAp214), read_back_iges(both)}) {
    ASSERT_GE(back.curves.size(), 2U);
    for (double u = 0; u <= 4; u += 0.0625) {
      EXPECT_LE((back.curves[0].curve.point(u) - loop.point(u)).norm(), kIges);
    }
    // Where its second derivatives jump, Open CASCADE may have cut the circle.
    double length = 0;
    for (std::size_t i = 1; i < back.curves.size(); ++i) {
      length += arc_length(back.curves[i].curve).value;
    }
    EXPECT_NEAR(length, 10 * pi, kIges);
  }
}

TEST(CadFiles, InchesArriveInMillimetres) {
  std::string text = *model_to_step({{solids()[0].body}, {}});
  const std::string mm = "SI_UNIT(.MILLI.,.METRE.)";
  const auto at = text.find(mm);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, mm.size(), "SI_UNIT($,.METRE.)");
  const auto metres = model_from_step(text);
  ASSERT_TRUE(metres.has_value());
  EXPECT_NEAR(area_of(metres->model.bodies[0]), 2200e6, 1e-6 * 2200e6);
}

TEST(CadFiles, RefusesWhatTheFormatDoesNotHave) {
  const auto dot = *BsplineCurve<3>::make(KnotVector(), {{1, 2, 3}});
  const auto text = model_to_step({{}, {{"dot", dot}}});
  ASSERT_FALSE(text.has_value());
  EXPECT_THAT(text.error().at, HasSubstr("dot"));
}

TEST(CadFiles, RefusesWhatIsNoFile) {
  EXPECT_FALSE(model_from_step("").has_value());
  EXPECT_FALSE(model_from_step("hello").has_value());
  EXPECT_FALSE(model_from_iges("/nowhere/at/all.igs").has_value());
  const std::string whole = *model_to_step({{solids()[0].body}, {}});
  for (std::size_t part = 1; part < 8; ++part) {
    const auto read = model_from_step(whole.substr(0, part * whole.size() / 8));
    if (!read.has_value()) continue;
    EXPECT_LE(read->model.bodies.size(), 1U);
  }
}

}  // namespace
}  // namespace limn
