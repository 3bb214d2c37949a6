#include "modeler/view/picture.hpp"
#include "modeler/view/sheet.hpp"

namespace limn {
namespace {

tl::unexpected<Error> absent(const char* format) {
  return fail(ErrorCode::kMissing, "",
              std::string("this limn was built without cairo, so without ") + format,
              "install libcairo2-dev and build limn again, or write SVG");
}

}  // namespace

bool has_cairo() noexcept { return false; }

Expected<std::string> draw_pdf(const Sheet& /*sheet*/, const Drawing& /*drawing*/) {
  return absent("PDF");
}

Expected<std::string> draw_png(const Sheet& /*sheet*/, double /*pixels*/,
                               const Drawing& /*drawing*/) {
  return absent("PNG");
}

}  // namespace limn
