#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "modeler/exchange/model_json.hpp"
#include "modeler/model/sewing.hpp"
#include "modeler/surface/primitives.hpp"

namespace limn {
namespace {

using testing::HasSubstr;

constexpr double kTolerance = 1e-6;  // mm

Model sphere_and_circle() {
  Model model;
  Frame frame;
  frame.origin = {0.1, 1.0 / 3, -2e-17};
  model.bodies.push_back(*sew("sphere", {*make_sphere(frame, 7.0 / 3)}, kTolerance));
  model.bodies.push_back(*sew("\"tube\" \xC3\xA9", {*make_cylinder({}, 1, 3)}, kTolerance));
  model.bodies.back().faces[0].reversed = true;
  model.curves.push_back({"circle", *make_circle({}, 5)});
  return model;
}

void expect_same(const Model& a, const Model& b) {
  ASSERT_EQ(a.bodies.size(), b.bodies.size());
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    const Body& x = a.bodies[i];
    const Body& y = b.bodies[i];
    EXPECT_EQ(x.name, y.name);
    EXPECT_EQ(x.vertices, y.vertices);
    ASSERT_EQ(x.edges.size(), y.edges.size());
    for (std::size_t e = 0; e < x.edges.size(); ++e) {
      EXPECT_TRUE(x.edges[e].curve == y.edges[e].curve);
      EXPECT_EQ(x.edges[e].vertices, y.edges[e].vertices);
      EXPECT_EQ(x.edges[e].deviation, y.edges[e].deviation);
    }
    ASSERT_EQ(x.faces.size(), y.faces.size());
    for (std::size_t f = 0; f < x.faces.size(); ++f) {
      EXPECT_TRUE(x.faces[f].surface == y.faces[f].surface);
      EXPECT_EQ(x.faces[f].reversed, y.faces[f].reversed);
      ASSERT_EQ(x.faces[f].loops.size(), y.faces[f].loops.size());
      for (std::size_t l = 0; l < x.faces[f].loops.size(); ++l) {
        const Loop& p = x.faces[f].loops[l];
        const Loop& q = y.faces[f].loops[l];
        ASSERT_EQ(p.size(), q.size());
        for (std::size_t t = 0; t < p.size(); ++t) {
          EXPECT_EQ(p[t].edge, q[t].edge);
          EXPECT_EQ(p[t].reversed, q[t].reversed);
          EXPECT_TRUE(p[t].curve == q[t].curve);
        }
      }
    }
  }
  ASSERT_EQ(a.curves.size(), b.curves.size());
  for (std::size_t i = 0; i < a.curves.size(); ++i) {
    EXPECT_EQ(a.curves[i].name, b.curves[i].name);
    EXPECT_TRUE(a.curves[i].curve == b.curves[i].curve);
  }
}

TEST(ModelJson, EveryNumberReadsBackAsTheSameDouble) {
  const Model model = sphere_and_circle();
  const std::string text = model_to_json(model);
  const auto read = model_from_json(text);
  ASSERT_TRUE(read.has_value()) << read.error().at << ": " << read.error().what;
  expect_same(*read, model);
  EXPECT_EQ(model_to_json(*read), text);
}

TEST(ModelJson, AnEmptyModelIsAFile) {
  const auto read = model_from_json(model_to_json({}));
  ASSERT_TRUE(read.has_value());
  EXPECT_TRUE(read->bodies.empty() && read->curves.empty());
}

TEST(ModelJson, PeriodicSplinesStayPeriodic) {
  const auto knots = *KnotVector::make_periodic(2, std::vector{0.0, 1.0, 2.0}, 3.0);
  Model model;
  model.curves.push_back(
      {"loop",
       *BsplineCurve<3>::make(knots, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}})});
  const auto read = model_from_json(model_to_json(model));
  ASSERT_TRUE(read.has_value()) << read.error().what;
  expect_same(*read, model);
}

TEST(ModelJson, KeysItDoesNotKnowArePassedOver) {
  const auto read = model_from_json(R"({"limn_model":1,"colour":"red","bodies":[],"curves":[]})");
  EXPECT_TRUE(read.has_value());
}

struct Broken {
  const char* from;
  const char* to;
  const char* place;
};

/// Text replacements in a good file, and where the error is said to be.
TEST(ModelJson, SaysWhereAFileIsWrong) {
  const Model model{{*sew("plane", {*make_plane({}, 4, 2)}, kTolerance)},
                    {{"circle", *make_circle({}, 5)}}};
  const std::string good = model_to_json(model);
  ASSERT_TRUE(model_from_json(good).has_value());
  const Broken cases[] = {
      {"\"limn_model\":1", "\"limn_model\":2", "/limn_model"},
      {"\"limn_model\":1", "\"limn_model\":\"1\"", "/limn_model"},
      {"\"limn_model\":1,", "", "/limn_model"},
      {"\"bodies\"", "\"bodes\"", "/bodies"},
      {"\"name\":\"plane\"", "\"name\":3", "/bodies/0/name"},
      {"\"vertices\":[0,1]", "\"vertices\":[0,9]", "/bodies/0/edges/0/vertices/1"},
      {"\"vertices\":[0,1]", "\"vertices\":[0]", "/bodies/0/edges/0/vertices"},
      {"\"edge\":2", "\"edge\":4", "/bodies/0/faces/0/loops/0/2/edge"},
      {"\"edge\":2", "\"edge\":-1", "/bodies/0/faces/0/loops/0/2/edge"},
      {"\"degree\":[1,1]", "\"degree\":1", "/bodies/0/faces/0/surface/degree"},
      {"\"degree\":[1,1]", "\"degree\":[1,99]", "/bodies/0/faces/0/surface/knots/1, degree"},
      {"\"rational\":true", "\"rational\":false", "/curves/0/curve/control_points/0"},
      {"\"rational\":true", "\"rational\":0", "/curves/0/curve/rational"},
      {"\"deviation_mm\":0.0", "\"deviation_mm\":null", "/bodies/0/edges/0/deviation_mm"},
      {"\"curves\":[", "\"curves\":[7,", "/curves/0"},
      {"4.0", "1e999", ""},
      {"\"curves\":[", "\"curves\":[[", "byte "},
  };
  for (const Broken& broken : cases) {
    std::string text = good;
    const auto at = text.find(broken.from);
    ASSERT_NE(at, std::string::npos) << broken.from;
    text.replace(at, std::string(broken.from).size(), broken.to);
    const auto read = model_from_json(text);
    ASSERT_FALSE(read.has_value()) << broken.to;
    EXPECT_THAT(read.error().at, HasSubstr(broken.place)) << broken.to;
    EXPECT_FALSE(read.error().remedy.empty()) << broken.to;
  }
}

TEST(ModelJson, NamesThatAreNotUtf8AreWritten) {
  Model model;
  model.curves.push_back({"\xFF\xFE", *make_circle({}, 1)});
  const auto read = model_from_json(model_to_json(model));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->curves[0].name, "\xEF\xBF\xBD\xEF\xBF\xBD");
}

}  // namespace
}  // namespace limn
