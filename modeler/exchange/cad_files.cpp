#include "modeler/exchange/cad_files.hpp"

#include <APIHeaderSection_MakeHeader.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESControl_Writer.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <STEPEdit.hxx>
#include <Standard_Failure.hxx>
#include <StepBasic_Product.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <XSControl_WorkSession.hxx>
#include <limits>
#include <mutex>
#include <sstream>
#include <utility>

#include "modeler/exchange/occt_shape.hpp"

namespace limn {
namespace {

constexpr const char* kTimeStamp = "1970-01-01T00:00:00";

/// Open CASCADE's settings and its controllers are the process's: one call at a time.
class Session {
 public:
  Session() : lock_(mutex()) {
    static std::once_flag initialised;
    std::call_once(initialised, [] {
      STEPControl_Controller::Init();
      IGESControl_Controller::Init();
      Message::DefaultMessenger()->ChangePrinters().Clear();  // it prints what it does
      Interface_Static::SetCVal("xstep.cascade.unit", "MM");
      Interface_Static::SetCVal("write.step.unit", "MM");
      Interface_Static::SetIVal("write.iges.brep.mode", 0);  // trimmed surfaces, which all read
      Interface_Static::SetIVal("read.iges.bspline.continuity", 0);  // as they are
    });
  }

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
};

tl::unexpected<Error> occt_failed(const std::string& what) {
  return fail(ErrorCode::kNumeric, "", "Open CASCADE gave up: " + what,
              "write another format, and report this model");
}

/// Calls `add(shape, name)` for each part of a model, until one returns false.
template <class Add>
Expected<void> for_each_shape(const Model& model, Add add) {
  const auto put = [&](const auto& part) -> Expected<void> {
    auto shape = exchange_detail::shape_of(part);
    if (!shape) {
      shape.error().at = part.name + (shape.error().at.empty() ? "" : ", " + shape.error().at);
      return tl::unexpected(std::move(shape.error()));
    }
    if (!add(*shape, part.name)) return occt_failed("it did not take " + part.name);
    return {};
  };
  for (const Body& body : model.bodies) {
    if (auto done = put(body); !done) return done;
  }
  for (const NamedCurve& curve : model.curves) {
    if (auto done = put(curve); !done) return done;
  }
  return {};
}

/// Names, and what makes the same model the same bytes: no time, and no counter of the parts
/// written so far, which Open CASCADE puts into their names.
void describe(const Handle(StepData_StepModel) & model, const std::vector<std::string>& names) {
  const auto text = [](const char* s) { return new TCollection_HAsciiString(s); };
  std::size_t next = 0;
  for (int i = 1; i <= model->NbEntities() && next < names.size(); ++i) {
    const auto product = Handle(StepBasic_Product)::DownCast(model->Value(i));
    if (product.IsNull()) continue;
    product->SetName(text(names[next].c_str()));
    product->SetId(text(names[next].c_str()));
    ++next;
  }
  APIHeaderSection_MakeHeader header(model);
  header.SetName(text("model"));
  header.SetTimeStamp(text(kTimeStamp));
  header.SetPreprocessorVersion(text("Open CASCADE"));
  header.SetOriginatingSystem(text("limn"));
  header.Apply(model);
}

Expected<ReadModel> read_roots(XSControl_Reader& reader, IFSelect_ReturnStatus status,
                               const char* format) {
  if (status != IFSelect_RetDone) {
    return fail(ErrorCode::kSyntax, "", std::string("this is no ") + format + " file",
                std::string("give a ") + format + " file");
  }
  ReadModel out;
  const int roots = reader.NbRootsForTransfer();
  for (int i = 1; i <= roots; ++i) {
    const auto skip = [&](const std::string& why) {
      const Handle(Standard_Transient) root = reader.RootForTransfer(i);
      out.skipped.push_back(std::string(root->DynamicType()->Name()) + ": " + why);
    };
    try {
      reader.ClearShapes();
      if (!reader.TransferOneRoot(i) || reader.NbShapes() == 0) {
        skip("Open CASCADE makes nothing of it");
        continue;
      }
      exchange_detail::add_shape(reader.OneShape(), out.model, out.skipped);
    } catch (const Standard_Failure& failure) {
      skip(failure.GetMessageString());
    }
  }
  if (out.model.bodies.empty() && out.model.curves.empty() && !out.skipped.empty()) {
    return fail(ErrorCode::kMissing, "", "nothing in the file could be read: " + out.skipped[0],
                "write it with surfaces or curves");
  }
  return out;
}

}  // namespace

Expected<std::string> model_to_step(const Model& model, StepSchema schema) {
  const Session session;
  try {
    Interface_Static::SetCVal("write.step.schema",
                              schema == StepSchema::kAp242 ? "AP242DIS" : "AP214IS");
    STEPControl_Writer writer;
    writer.Model(true);  // new: with the schema
    std::vector<std::string> names;
    const auto added =
        for_each_shape(model, [&](const TopoDS_Shape& shape, const std::string& name) {
          names.push_back(name);
          return writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone;
        });
    if (!added) return tl::unexpected(added.error());
    const Handle(StepData_StepModel) made = writer.Model();
    describe(made, names);
    StepData_StepWriter text(made);
    text.FloatWriter().SetFormat("%.16E");
    text.FloatWriter().SetFormatForRange("%.1f", 0.0, std::numeric_limits<double>::denorm_min());
    text.SendModel(Handle(StepData_Protocol)::DownCast(STEPEdit::Protocol()));
    std::ostringstream out;
    if (!text.Print(out)) return occt_failed("its writer did not finish");
    return std::move(out).str();
  } catch (const Standard_Failure& failure) {
    return occt_failed(failure.GetMessageString());
  }
}

Expected<std::string> model_to_iges(const Model& model) {
  const Session session;
  try {
    IGESControl_Writer writer("MM", 0);
    IGESData_GlobalSection head = writer.Model()->GlobalSection();
    head.SetDate(new TCollection_HAsciiString("19700101.000000"));
    head.SetLastChangeDate(new TCollection_HAsciiString("19700101.000000"));
    writer.Model()->SetGlobalSection(head);
    const auto added = for_each_shape(model, [&](const TopoDS_Shape& shape, const std::string&) {
      return writer.AddShape(shape);
    });
    if (!added) return tl::unexpected(added.error());
    writer.ComputeModel();
    std::ostringstream out;
    out.precision(std::numeric_limits<double>::max_digits10);
    if (!writer.Write(out)) return occt_failed("its writer did not finish");
    return std::move(out).str();
  } catch (const Standard_Failure& failure) {
    return occt_failed(failure.GetMessageString());
  }
}

Expected<ReadModel> model_from_step(std::string_view bytes) {
  const Session session;
  try {
    std::istringstream in{std::string(bytes)};
    STEPControl_Reader reader;
    const IFSelect_ReturnStatus status = reader.ReadStream("model", in);
    return read_roots(reader, status, "STEP");
  } catch (const Standard_Failure& failure) {
    return occt_failed(failure.GetMessageString());
  }
}

Expected<ReadModel> model_from_iges(const std::string& path) {
  const Session session;
  try {
    IGESControl_Reader reader;
    const IFSelect_ReturnStatus status = reader.ReadFile(path.c_str());
    return read_roots(reader, status, "IGES");
  } catch (const Standard_Failure& failure) {
    return occt_failed(failure.GetMessageString());
  }
}

}  // namespace limn
