#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <BRep_Tool.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_Curve.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <STEPControl_Reader.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shape.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include "modeler/exchange/sketch_step.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/unit/modeler/sketch_examples.hpp"

#if defined(__SANITIZE_ADDRESS__)
#define LIMN_LEAK_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LIMN_LEAK_SANITIZER
#endif
#endif
#ifdef LIMN_LEAK_SANITIZER
extern "C" void __lsan_disable();  // of the sanitizer's run-time library
extern "C" void __lsan_enable();
#endif

namespace limn {
namespace {

using testing::HasSubstr;
using testing::Not;

struct ReadCurve {
  std::string name;
  Handle(Geom_BSplineCurve) curve;
  double first = 0;
  double last = 0;
};

struct ReadSketch {
  std::vector<ReadCurve> curves;
  std::vector<gp_Pnt> dots;
};

/// Open CASCADE's reader makes three editors that it never frees; its writer, and so limn, does
/// not.
class LeaksOfTheReader {
 public:
#ifdef LIMN_LEAK_SANITIZER
  LeaksOfTheReader() { __lsan_disable(); }
  ~LeaksOfTheReader() { __lsan_enable(); }
#else
  LeaksOfTheReader() {}
  ~LeaksOfTheReader() {}
#endif
  LeaksOfTheReader(const LeaksOfTheReader&) = delete;
  LeaksOfTheReader& operator=(const LeaksOfTheReader&) = delete;
};

/// What Open CASCADE, whose unit is the millimetre, makes of the file.
ReadSketch read_step(const std::string& bytes) {
  const LeaksOfTheReader leaks;
  const test::TempFolder folder;
  const auto path = folder.write("sketch.step", bytes);
  STEPControl_Reader reader;
  EXPECT_EQ(reader.ReadFile(path.c_str()), IFSelect_RetDone);
  reader.TransferRoots();
  ReadSketch out;
  if (reader.NbShapes() == 0) return out;
  const TopoDS_Shape shape = reader.OneShape();
  const auto transfer = reader.WS()->TransferReader();
  for (TopExp_Explorer e(shape, TopAbs_EDGE); e.More(); e.Next()) {
    ReadCurve read;
    const TopoDS_Edge edge = TopoDS::Edge(e.Current());
    read.curve = Handle(Geom_BSplineCurve)::DownCast(BRep_Tool::Curve(edge, read.first, read.last));
    const auto entity = transfer->EntityFromShapeResult(edge, 1);
    const auto item = Handle(StepRepr_RepresentationItem)::DownCast(entity);
    if (!item.IsNull()) read.name = item->Name()->ToCString();
    out.curves.push_back(read);
  }
  for (TopExp_Explorer v(shape, TopAbs_VERTEX, TopAbs_EDGE); v.More(); v.Next()) {
    out.dots.push_back(BRep_Tool::Pnt(TopoDS::Vertex(v.Current())));
  }
  return out;
}

std::string step_of(const Sketch& sketch) {
  auto step = sketch_to_step(sketch);
  EXPECT_TRUE(step.has_value()) << step.error().what;
  return step.value_or("");
}

/// The largest distance between both curves at 101 parameters, y turned.
double largest_distance(const BsplineCurve<2>& curve, const Geom_BSplineCurve& read) {
  const double begin = curve.knots().domain_begin();
  const double end = curve.knots().domain_end();
  double largest = 0;
  for (int i = 0; i <= 100; ++i) {
    const double u = begin + (end - begin) * i / 100;
    const Eigen::Vector2d ours = curve.point(u);
    const gp_Pnt theirs = read.Value(u);
    largest = std::max(largest, gp_Pnt(ours.x(), -ours.y(), 0).Distance(theirs));
  }
  return largest;
}

TEST(SketchStep, OpenCascadeReadsTheSameCurves) {
  const Sketch sketch = test::four_strokes();
  const ReadSketch read = read_step(step_of(sketch));
  ASSERT_EQ(read.curves.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    SCOPED_TRACE(i);
    const auto& ours = sketch.strokes[i].curve;
    ASSERT_FALSE(read.curves[i].curve.IsNull());
    EXPECT_EQ(read.curves[i].curve->Degree(), 3);
    EXPECT_EQ(read.curves[i].first, ours.knots().domain_begin());
    EXPECT_EQ(read.curves[i].last, ours.knots().domain_end());
    EXPECT_LE(largest_distance(ours, *read.curves[i].curve), 1e-12);
    EXPECT_EQ(read.curves[i].name, "stroke " + std::to_string(i + 1));
  }
}

TEST(SketchStep, ControlPointsAndKnotsKeepTheirBits) {
  Sketch sketch;
  const auto curve = test::make_curve(
      KnotVector::make_clamped(3, 0.1, 3, std::vector{1.0 / 3, 0.7, 1.9}),
      {{10, 20}, {20.0 / 3, 40}, {35, 1e-17}, {50, 35}, {1e9 / 7, 40}, {70, 12}, {-0.0, 0.0}});
  sketch.strokes.push_back(test::stroke_of(curve));
  const ReadSketch read = read_step(step_of(sketch));
  ASSERT_EQ(read.curves.size(), 1U);
  const auto& theirs = *read.curves[0].curve;
  ASSERT_EQ(theirs.NbPoles(), 7);
  for (int i = 0; i < 7; ++i) {
    const Eigen::Vector2d p = curve.control_points()[static_cast<std::size_t>(i)];
    EXPECT_EQ(theirs.Pole(i + 1).X(), p.x());
    EXPECT_EQ(theirs.Pole(i + 1).Y(), -p.y());
    EXPECT_EQ(theirs.Pole(i + 1).Z(), 0.0);
  }
  const auto& knots = curve.knots().values();
  ASSERT_EQ(theirs.KnotSequence().Length(), static_cast<int>(knots.size()));
  for (std::size_t i = 0; i < knots.size(); ++i) {
    EXPECT_EQ(theirs.KnotSequence().Value(static_cast<int>(i) + 1), knots[i]);
  }
}

TEST(SketchStep, AClosedCurveIsClosedAndAsSmoothInside) {
  Sketch sketch;
  sketch.strokes.push_back(test::stroke_of(test::loop()));
  const std::string step = step_of(sketch);
  EXPECT_THAT(step, HasSubstr(".UNSPECIFIED.,.T.,.U.,"));
  const ReadSketch read = read_step(step);
  ASSERT_EQ(read.curves.size(), 1U);
  EXPECT_TRUE(read.curves[0].curve->IsClosed());
  EXPECT_EQ(read.curves[0].curve->Continuity(), GeomAbs_C2);
  EXPECT_LE(largest_distance(test::loop(), *read.curves[0].curve), 1e-12);
}

TEST(SketchStep, ADotIsAPoint) {
  Sketch sketch;
  sketch.strokes.push_back(test::stroke_of(test::dot(30, 20)));
  const ReadSketch read = read_step(step_of(sketch));
  EXPECT_TRUE(read.curves.empty());
  ASSERT_EQ(read.dots.size(), 1U);
  EXPECT_EQ(read.dots[0].Distance(gp_Pnt(30, -20, 0)), 0);
}

TEST(SketchStep, ASketchWithoutStrokesIsAValidFile) {
  const std::string step = step_of(Sketch{});
  EXPECT_THAT(step, HasSubstr("AXIS2_PLACEMENT_3D"));
  EXPECT_THAT(step, Not(HasSubstr("NUL REF")));
  const ReadSketch read = read_step(step);
  EXPECT_TRUE(read.curves.empty());
  EXPECT_TRUE(read.dots.empty());
}

TEST(SketchStep, AStrokeShorterThanShapesTolerancesIsWritten) {
  Sketch sketch;
  sketch.strokes.push_back(test::stroke_of(test::make_curve(
      KnotVector::make_clamped(3, 0, 1), {{5, 5}, {5, 5 + 1e-9}, {5 + 1e-9, 5}, {5, 5}})));
  EXPECT_THAT(step_of(sketch), HasSubstr("B_SPLINE_CURVE_WITH_KNOTS('stroke 1',3,"));
}

TEST(SketchStep, StatesItsUnitsAndNoTime) {
  const std::string step = step_of(test::four_strokes());
  EXPECT_THAT(step, HasSubstr("SI_UNIT(.MILLI.,.METRE.)"));
  EXPECT_THAT(step, HasSubstr("'1970-01-01T00:00:00'"));
  EXPECT_EQ(step, step_of(test::four_strokes()));
}

TEST(SketchStep, NamesTheErasersStrokes) {
  Sketch sketch = test::four_strokes();
  sketch.strokes[1].tool = Tool::kEraser;
  EXPECT_THAT(step_of(sketch), HasSubstr("'eraser 2'"));
}

TEST(SketchStep, PrintsNothing) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  step_of(test::four_strokes());
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace limn
