#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "modeler/exchange/sketch_json.hpp"
#include "tests/unit/modeler/sketch_examples.hpp"

namespace limn {
namespace {

using testing::HasSubstr;
using testing::Not;

Sketch sketch_of(SketchStroke stroke) {
  Sketch sketch;
  sketch.tolerance_mm = 0.05;
  sketch.strokes.push_back(std::move(stroke));
  return sketch;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

void expect_same(const SketchStroke& a, const SketchStroke& b) {
  EXPECT_EQ(a.curve, b.curve);  // bit for bit
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.t0, b.t0);
  EXPECT_EQ(a.t1, b.t1);
  EXPECT_EQ(a.tool, b.tool);
  EXPECT_EQ(a.corners, b.corners);
  EXPECT_EQ(a.deviation_max_mm, b.deviation_max_mm);
  EXPECT_EQ(a.deviation_rms_mm, b.deviation_rms_mm);
  EXPECT_EQ(a.length_mm, b.length_mm);
}

TEST(SketchJson, FollowsTheContract) {
  auto line = test::stroke_of(
      test::make_curve(KnotVector::make_clamped(3, 0, 2), {{1, 2}, {3, 4.5}, {5, 6}, {7, 8}}));
  auto tap = test::stroke_of(test::dot(-0.25, 1e9));
  tap.samples = 1;
  tap.t1 = tap.t0;
  Sketch sketch = sketch_of(line);
  sketch.strokes.push_back(tap);
  EXPECT_EQ(sketch_to_json(sketch),
            "{\"tolerance_mm\":0.05,\"strokes\":[\n"
            "{\"samples\":40,\"t0\":1.25,\"t1\":1.45,\"degree\":3,"
            "\"knots\":[0.0,0.0,0.0,0.0,2.0,2.0,2.0,2.0],"
            "\"control_points\":[[1.0,2.0],[3.0,4.5],[5.0,6.0],[7.0,8.0]],\"closed\":false,"
            "\"corners\":[],\"deviation_max_mm\":0.04,\"deviation_rms_mm\":0.015625},\n"
            "{\"samples\":1,\"t0\":1.25,\"t1\":1.25,\"degree\":0,\"knots\":[0.0,1.0],"
            "\"control_points\":[[-0.25,1000000000.0]],\"closed\":false,"
            "\"corners\":[],\"deviation_max_mm\":0.04,\"deviation_rms_mm\":0.015625}]}\n");
}

TEST(SketchJson, ASketchWithoutStrokesHasAnEmptyArray) {
  EXPECT_EQ(sketch_to_json({0.2, {}}), "{\"tolerance_mm\":0.2,\"strokes\":[]}\n");
}

TEST(SketchJson, ReadsBackBitForBit) {
  Sketch sketch = test::four_strokes();
  sketch.tolerance_mm = 1.0 / 3;
  sketch.strokes[0].deviation_max_mm = std::nextafter(0.1, 1);
  sketch.strokes[1].tool = Tool::kEraser;
  sketch.strokes[1].t1 = Timestamp(123'456'789'012'345);
  const auto read = sketch_from_json(sketch_to_json(sketch));
  ASSERT_TRUE(read.has_value()) << read.error().at << ": " << read.error().what;
  EXPECT_EQ(read->tolerance_mm, sketch.tolerance_mm);
  ASSERT_EQ(read->strokes.size(), sketch.strokes.size());
  for (std::size_t i = 0; i < sketch.strokes.size(); ++i) {
    SCOPED_TRACE(i);
    expect_same(read->strokes[i], sketch.strokes[i]);
  }
  EXPECT_TRUE(read->strokes[2].closed());
  EXPECT_TRUE(read->strokes[3].is_dot());
}

TEST(SketchJson, ExtremeCoordinatesReadBack) {
  const auto far =
      test::stroke_of(test::make_curve(KnotVector::make_clamped(1, 0, 1),
                                       {{std::numeric_limits<double>::max(), 5e-324}, {-0.0, 1}}));
  const auto read = sketch_from_json(sketch_to_json(sketch_of(far)));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->strokes[0].curve, far.curve);
}

TEST(SketchJson, AClosedCurveRepeatsItsFirstPoints) {
  const std::string text = sketch_to_json(sketch_of(test::stroke_of(test::loop())));
  EXPECT_THAT(text, HasSubstr("[60.0,30.0],[46.0,49.0],[24.0,42.0]],\"closed\":true"));
}

TEST(SketchJson, OnlyTheEraserNamesItsTool) {
  SketchStroke stroke = test::stroke_of(test::wave());
  EXPECT_THAT(sketch_to_json(sketch_of(stroke)), Not(HasSubstr("tool")));
  stroke.tool = Tool::kEraser;
  EXPECT_THAT(sketch_to_json(sketch_of(stroke)), HasSubstr("\"tool\":\"eraser\""));
}

TEST(SketchJson, PassesOverKeysItDoesNotKnow) {
  const std::string text = sketch_to_json(sketch_of(test::stroke_of(test::wave())));
  EXPECT_TRUE(sketch_from_json(with(text, "{\"samples\"", "{\"new\":{},\"samples\"")).has_value());
}

TEST(SketchJson, NamesThePlaceOfWhatIsWrong) {
  const std::string good = sketch_to_json(sketch_of(test::stroke_of(test::wave())));
  struct Case {
    std::string from, to, place;
    ErrorCode code;
  };
  const std::vector<Case> cases = {
      {"\"tolerance_mm\":0.05", "\"tolerance_mm\":\"x\"", "/tolerance_mm", ErrorCode::kSyntax},
      {"\"strokes\":[", "\"strokes\":3,\"other\":[", "/strokes", ErrorCode::kSyntax},
      {"\"samples\":40", "\"samples\":-1", "/strokes/0/samples", ErrorCode::kSyntax},
      {"\"samples\":40", "\"samples\":1.5", "/strokes/0/samples", ErrorCode::kSyntax},
      {"\"samples\":40,", "", "/strokes/0/samples", ErrorCode::kSyntax},
      {"\"t0\":1.25", "\"t0\":1e300", "/strokes/0/t0", ErrorCode::kSyntax},
      {"[10.0,20.0],", "", "/strokes/0, control points", ErrorCode::kPointCount},
      {"\"degree\":3", "\"degree\":2", "/strokes/0, knot 3", ErrorCode::kOutOfRange},
      {"\"degree\":3", "\"degree\":26", "/strokes/0, degree", ErrorCode::kOutOfRange},
      {"\"degree\":3", "\"degree\":0", "/strokes/0/control_points", ErrorCode::kPointCount},
      {"\"knots\":[0.0", "\"knots\":[9.0", "/strokes/0, knot 1", ErrorCode::kOutOfRange},
      {"\"knots\":[0.0", "\"knots\":[null", "/strokes/0/knots/0", ErrorCode::kSyntax},
      {"\"knots\":[", "\"knots\":{},\"k\":[", "/strokes/0/knots", ErrorCode::kSyntax},
      {"[10.0,20.0]", "[10.0]", "/strokes/0/control_points/0", ErrorCode::kSyntax},
      {"[10.0,20.0]", "7", "/strokes/0/control_points/0", ErrorCode::kSyntax},
      {"\"closed\":false", "\"closed\":0", "/strokes/0/closed", ErrorCode::kSyntax},
      {"\"closed\":false", "\"closed\":true", "/strokes/0, knot 3", ErrorCode::kOutOfRange},
      {"\"corners\":[]", "\"corners\":[4]", "/strokes/0/corners", ErrorCode::kOutOfRange},
      {"\"closed\"", "\"tool\":\"tablet_mouse\",\"closed\"", "/strokes/0/tool", ErrorCode::kSyntax},
      {"[\n{", "[\n5,{", "/strokes/0", ErrorCode::kSyntax},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.to);
    const auto read = sketch_from_json(with(good, c.from, c.to));
    ASSERT_FALSE(read.has_value());
    EXPECT_EQ(read.error().at, c.place);
    EXPECT_EQ(read.error().code, c.code);
    EXPECT_FALSE(read.error().what.empty());
    EXPECT_FALSE(read.error().remedy.empty());
  }
}

TEST(SketchJson, NamesTheByteOfBrokenJson) {
  EXPECT_EQ(sketch_from_json("{\"tolerance_mm\":}").error().at, "byte 17");
  EXPECT_FALSE(sketch_from_json("").has_value());
  EXPECT_FALSE(sketch_from_json("[]").has_value());
  EXPECT_FALSE(sketch_from_json("{\"tolerance_mm\":1e999,\"strokes\":[]}").has_value());
  EXPECT_FALSE(sketch_from_json(std::string_view("{\0}", 3)).has_value());
  EXPECT_FALSE(sketch_from_json("\xff\xfe{}").has_value());
  EXPECT_FALSE(sketch_from_json(std::string(1'000'000, '[')).has_value());  // no deep recursion
}

TEST(SketchJson, ATruncatedFileIsAnError) {
  const std::string good = sketch_to_json(test::four_strokes());
  for (std::size_t length = 0; length + 2 < good.size(); length += 7) {
    EXPECT_FALSE(sketch_from_json(good.substr(0, length)).has_value()) << length;
  }
}

}  // namespace
}  // namespace limn
