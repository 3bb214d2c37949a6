#include <algorithm>

#include "modeler/view/draw_sketch.hpp"
#include "modeler/view/page.hpp"
#include "modeler/view/picture.hpp"
#include "modeler/view/sheet.hpp"

namespace limn {
namespace {

/// The longer side of a PNG: this many pixels a mm of paper, but kFewestPixels at least.
constexpr double kPixelsPerMm = 12;  // about 300 a inch
constexpr int kFewestPixels = 1200;

Sheet sheet_of(const Page& page) {
  return {"Sketch", page.origin, page.width, page.height, page.paper_scale};
}

Drawing drawing_of(const Sketch& sketch, const Page& page, const PictureOptions& options) {
  return [&](Canvas& canvas) { return draw_sketch(sketch, page, options, canvas); };
}

}  // namespace

Expected<std::string> sketch_to_svg(const Sketch& sketch, const PictureOptions& options) {
  const auto page = lay_out_page(sketch, options);
  if (!page) return tl::unexpected(page.error());
  return draw_svg(sheet_of(*page), drawing_of(sketch, *page, options));
}

Expected<std::string> sketch_to_pdf(const Sketch& sketch, const PictureOptions& options) {
  const auto page = lay_out_page(sketch, options);
  if (!page) return tl::unexpected(page.error());
  return draw_pdf(sheet_of(*page), drawing_of(sketch, *page, options));
}

Expected<std::string> sketch_to_png(const Sketch& sketch, const PictureOptions& options) {
  const auto page = lay_out_page(sketch, options);
  if (!page) return tl::unexpected(page.error());
  const double longer = std::max(page->width, page->height);
  const double wanted = std::max<double>(kFewestPixels, kPixelsPerMm * longer * page->paper_scale);
  return draw_png(sheet_of(*page), std::min<double>(options.most_pixels, wanted),
                  drawing_of(sketch, *page, options));
}

}  // namespace limn
