// backends FOLDER: uses the installed libraries that link others, and leaves their files in FOLDER.
// A backend that this build of limn lacks has to say so.

#include <cstdio>
#include <fstream>
#include <string>

#include "modeler/exchange/sketch_step.hpp"
#include "modeler/view/picture.hpp"

namespace {

limn::Sketch one_line() {
  limn::SketchStroke stroke;
  stroke.samples = 2;
  stroke.length_mm = 10;
  stroke.curve = limn::BsplineCurve<2>::make(*limn::KnotVector::make_clamped(1, 0.0, 1.0),
                                             {{0.0, 0.0}, {10.0, 0.0}})
                     .value();
  return {0.1, {stroke}};
}

bool wrote(const std::string& path, const limn::Expected<std::string>& bytes, bool available) {
  if (!bytes) {
    std::printf("%s: %s\n", path.c_str(), bytes.error().what.c_str());
    return !available && bytes.error().code == limn::ErrorCode::kMissing;
  }
  std::ofstream out(path, std::ios::binary);
  out << *bytes;
  out.close();
  std::printf("%s: %zu bytes\n", path.c_str(), bytes->size());
  return available && out.good() && !bytes->empty();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::string folder = argv[1];
  const limn::Sketch sketch = one_line();
  const bool step = wrote(folder + "/a.step", limn::sketch_to_step(sketch), limn::has_step());
  const bool pdf = wrote(folder + "/a.pdf", limn::sketch_to_pdf(sketch), limn::has_cairo());
  const bool svg = wrote(folder + "/a.svg", limn::sketch_to_svg(sketch), true);
  return step && pdf && svg ? 0 : 1;
}
