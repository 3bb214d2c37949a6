#include "modeler/exchange/sketch_step.hpp"

namespace limn {

bool has_step() noexcept { return false; }

Expected<std::string> sketch_to_step(const Sketch& /*sketch*/) {
  return fail(ErrorCode::kMissing, "", "this limn was built without Open CASCADE, so without STEP",
              "install libocct-data-exchange-dev and build limn again");
}

}  // namespace limn
