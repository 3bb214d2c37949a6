#include "modeler/view/picture.hpp"

namespace limn {
namespace {

tl::unexpected<Error> absent(const char* format) {
  return fail(ErrorCode::kMissing, "",
              std::string("this limn was built without cairo, so without ") + format,
              "install libcairo2-dev and build limn again, or write SVG");
}

}  // namespace

bool has_cairo() noexcept { return false; }

Expected<std::string> sketch_to_pdf(const Sketch& /*sketch*/, const PictureOptions& /*options*/) {
  return absent("PDF");
}

Expected<std::string> sketch_to_png(const Sketch& /*sketch*/, const PictureOptions& /*options*/) {
  return absent("PNG");
}

}  // namespace limn
