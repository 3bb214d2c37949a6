// The only file that includes Open CASCADE. STEP entities are made directly, not translated from
// Open CASCADE's shapes: that keeps every control point and knot as it is, and cannot fail on a
// stroke that is shorter than the shapes' tolerance.
#include "modeler/exchange/sketch_step.hpp"

#include <APIHeaderSection_MakeHeader.hxx>
#include <Interface_HArray1OfHAsciiString.hxx>
#include <RWHeaderSection.hxx>
#include <RWStepAP214.hxx>
#include <STEPConstruct_Part.hxx>
#include <STEPConstruct_UnitContext.hxx>
#include <STEPEdit.hxx>
#include <Standard_Failure.hxx>
#include <StepBasic_ApplicationContext.hxx>
#include <StepBasic_ApplicationProtocolDefinition.hxx>
#include <StepBasic_ProductRelatedProductCategory.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <StepGeom_Axis2Placement3d.hxx>
#include <StepGeom_BSplineCurveWithKnots.hxx>
#include <StepGeom_CartesianPoint.hxx>
#include <StepGeom_Direction.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_HArray1OfCartesianPoint.hxx>
#include <StepRepr_HArray1OfRepresentationItem.hxx>
#include <StepShape_GeometricCurveSet.hxx>
#include <StepShape_GeometricSetSelect.hxx>
#include <StepShape_GeometricallyBoundedWireframeShapeRepresentation.hxx>
#include <StepShape_HArray1OfGeometricSetSelect.hxx>
#include <StepShape_ShapeDefinitionRepresentation.hxx>
#include <TColStd_HArray1OfInteger.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <limits>
#include <mutex>
#include <sstream>
#include <utility>
#include <vector>

#include "modeler/sketch/curve_forms.hpp"

namespace limn {
namespace {

/// Distance in mm below which a reader may take points for the same: what most modelers work to.
constexpr double kUncertaintyMm = 1e-7;

constexpr const char* kTimeStamp = "1970-01-01T00:00:00";

Handle(TCollection_HAsciiString) text(const std::string& s) {
  return new TCollection_HAsciiString(s.c_str());
}

Handle(StepGeom_CartesianPoint) step_point(const std::string& name, const Eigen::Vector2d& p) {
  Handle(StepGeom_CartesianPoint) point = new StepGeom_CartesianPoint;
  point->Init3D(text(name), p.x(), 0.0 - p.y(), 0.0);  // 0 - y: no negative zero
  return point;
}

/// Knots without repetition, and how often each occurs.
struct DistinctKnots {
  std::vector<double> values;
  std::vector<int> multiplicities;
};

DistinctKnots distinct(const std::vector<double>& knots) {
  DistinctKnots out;
  for (const double u : knots) {
    if (out.values.empty() || out.values.back() != u) {
      out.values.push_back(u);
      out.multiplicities.push_back(0);
    }
    ++out.multiplicities.back();
  }
  return out;
}

Handle(StepGeom_BSplineCurveWithKnots)
    step_curve(const std::string& name, const SketchStroke& stroke) {
  const BsplineCurve<2> curve = clamped(stroke.curve);
  const int count = static_cast<int>(curve.control_points().size());
  Handle(StepGeom_HArray1OfCartesianPoint) points = new StepGeom_HArray1OfCartesianPoint(1, count);
  for (int i = 0; i < count; ++i) {
    points->SetValue(i + 1, step_point("", curve.control_points()[static_cast<std::size_t>(i)]));
  }
  const DistinctKnots knots = distinct(curve.knots().values());
  const int knot_count = static_cast<int>(knots.values.size());
  Handle(TColStd_HArray1OfReal) values = new TColStd_HArray1OfReal(1, knot_count);
  Handle(TColStd_HArray1OfInteger) multiplicities = new TColStd_HArray1OfInteger(1, knot_count);
  for (int i = 0; i < knot_count; ++i) {
    values->SetValue(i + 1, knots.values[static_cast<std::size_t>(i)]);
    multiplicities->SetValue(i + 1, knots.multiplicities[static_cast<std::size_t>(i)]);
  }
  Handle(StepGeom_BSplineCurveWithKnots) out = new StepGeom_BSplineCurveWithKnots;
  out->Init(text(name), curve.knots().degree(), points, StepGeom_bscfUnspecified,
            stroke.closed() ? StepData_LTrue : StepData_LFalse, StepData_LUnknown, multiplicities,
            values, StepGeom_ktUnspecified);
  return out;
}

/// What a part without curves holds: a representation needs at least one item.
Handle(StepRepr_RepresentationItem) origin() {
  const auto direction = [](double x, double z) {
    Handle(TColStd_HArray1OfReal) ratios = new TColStd_HArray1OfReal(1, 3);
    ratios->SetValue(1, x);
    ratios->SetValue(2, 0.0);
    ratios->SetValue(3, z);
    Handle(StepGeom_Direction) out = new StepGeom_Direction;
    out->Init(text(""), ratios);
    return out;
  };
  Handle(StepGeom_Axis2Placement3d) placement = new StepGeom_Axis2Placement3d;
  placement->Init(text("origin"), step_point("", Eigen::Vector2d::Zero()), Standard_True,
                  direction(0, 1), Standard_True, direction(1, 0));
  return placement;
}

Handle(StepRepr_RepresentationItem) curve_set(const Sketch& sketch) {
  const int count = static_cast<int>(sketch.strokes.size());
  Handle(StepShape_HArray1OfGeometricSetSelect) elements =
      new StepShape_HArray1OfGeometricSetSelect(1, count);
  for (int i = 0; i < count; ++i) {
    const SketchStroke& stroke = sketch.strokes[static_cast<std::size_t>(i)];
    const std::string name =
        (stroke.tool == Tool::kEraser ? "eraser " : "stroke ") + std::to_string(i + 1);
    StepShape_GeometricSetSelect element;
    if (stroke.is_dot()) {
      element.SetValue(step_point(name, stroke.curve.control_points().front()));
    } else {
      element.SetValue(step_curve(name, stroke));
    }
    elements->SetValue(i + 1, element);
  }
  Handle(StepShape_GeometricCurveSet) set = new StepShape_GeometricCurveSet;
  set->Init(text("sketch"), elements);
  return set;
}

Handle(StepShape_ShapeRepresentation) representation(const Sketch& sketch) {
  Handle(StepRepr_HArray1OfRepresentationItem) items =
      new StepRepr_HArray1OfRepresentationItem(1, 1);
  Handle(StepShape_ShapeRepresentation) out;
  if (sketch.strokes.empty()) {
    out = new StepShape_ShapeRepresentation;
    items->SetValue(1, origin());
  } else {
    out = new StepShape_GeometricallyBoundedWireframeShapeRepresentation;
    items->SetValue(1, curve_set(sketch));
  }
  STEPConstruct_UnitContext units;  // millimetres, radians
  units.Init(kUncertaintyMm);
  out->Init(text("sketch"), items, units.Value());
  return out;
}

void describe(const Handle(StepData_StepModel) & model) {
  const auto one = [](const char* value) {
    Handle(Interface_HArray1OfHAsciiString) out = new Interface_HArray1OfHAsciiString(1, 1);
    out->SetValue(1, text(value));
    return out;
  };
  APIHeaderSection_MakeHeader header(model);
  header.SetName(text("sketch"));
  header.SetTimeStamp(text(kTimeStamp));
  header.SetAuthor(one(""));
  header.SetOrganization(one(""));
  header.SetPreprocessorVersion(text("Open CASCADE"));
  header.SetOriginatingSystem(text("limn"));
  header.SetAuthorisation(text(""));
  header.SetDescription(one("pen strokes as B-spline curves"));
  header.Apply(model);
}

Handle(StepData_StepModel) step_model(const Sketch& sketch) {
  static std::once_flag initialised;
  std::call_once(initialised, [] {
    RWHeaderSection::Init();
    RWStepAP214::Init();
  });

  Handle(StepBasic_ApplicationContext) context = new StepBasic_ApplicationContext;
  context->Init(text("core data for automotive mechanical design processes"));
  Handle(StepBasic_ApplicationProtocolDefinition) protocol =
      new StepBasic_ApplicationProtocolDefinition;
  protocol->Init(text("international standard"), text("automotive_design"), 2000, context);
  STEPConstruct_Part part;
  part.MakeSDR(representation(sketch), text("sketch"), context);

  const Handle(Interface_Protocol) schema = STEPEdit::Protocol();
  Handle(StepData_StepModel) model = STEPEdit::NewModel();
  model->AddWithRefs(protocol, schema);
  model->AddWithRefs(part.SDRValue(), schema);
  model->AddWithRefs(part.PRPC(), schema);
  describe(model);
  return model;
}

}  // namespace

bool has_step() noexcept { return true; }

Expected<std::string> sketch_to_step(const Sketch& sketch) {
  const auto failed = [](const std::string& what) {
    return fail(ErrorCode::kNumeric, "", "Open CASCADE could not make the STEP file: " + what,
                "write another format, e.g. JSON, and report this drawing");
  };
  try {
    StepData_StepWriter writer(step_model(sketch));
    writer.FloatWriter().SetFormat("%.16E");
    // Exact zeros, a third of all coordinates, are written short.
    writer.FloatWriter().SetFormatForRange("%.1f", 0.0, std::numeric_limits<double>::denorm_min());
    writer.SendModel(Handle(StepData_Protocol)::DownCast(STEPEdit::Protocol()));
    std::ostringstream out;
    if (!writer.Print(out)) return failed("its writer gave up");
    return std::move(out).str();
  } catch (const Standard_Failure& failure) {
    return failed(failure.DynamicType()->Name());
  }
}

}  // namespace limn
