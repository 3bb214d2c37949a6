#include "modeler/exchange/cad_files.hpp"

namespace limn {
namespace {

tl::unexpected<Error> absent() {
  return fail(ErrorCode::kMissing, "",
              "this limn was built without Open CASCADE, so without STEP and IGES",
              "install libocct-data-exchange-dev and build limn again");
}

}  // namespace

Expected<std::string> model_to_step(const Model& /*model*/, StepSchema /*schema*/) {
  return absent();
}

Expected<std::string> model_to_iges(const Model& /*model*/) { return absent(); }

Expected<ReadModel> model_from_step(std::string_view /*bytes*/) { return absent(); }

Expected<ReadModel> model_from_iges(const std::string& /*path*/) { return absent(); }

}  // namespace limn
