#include <cairo-pdf.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "modeler/view/picture.hpp"
#include "modeler/view/sheet.hpp"

namespace limn {
namespace {

constexpr double kPointsPerMm = 72 / 25.4;

struct DestroySurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct DestroyContext {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, DestroySurface>;
using Context = std::unique_ptr<cairo_t, DestroyContext>;

cairo_status_t append(void* out, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(out)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

tl::unexpected<Error> cairo_failed(cairo_status_t status) {
  return fail(ErrorCode::kNumeric, "",
              std::string("cairo could not make the picture: ") + cairo_status_to_string(status),
              "write SVG instead, and report this drawing");
}

/// Maps to device units itself: cairo keeps coordinates in 24.8 fixed point, after its own
/// transformation, and fonts at extreme matrices are not to be trusted.
class CairoCanvas final : public Canvas {
 public:
  /// `scale`: device units a sketch mm.
  CairoCanvas(cairo_surface_t* surface, const Sheet& sheet, double scale)
      : context_(cairo_create(surface)), origin_(sheet.origin), scale_(scale) {
    set_color({255, 255, 255});
    cairo_paint(context_.get());
    cairo_set_line_cap(context_.get(), CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
    // The font inside cairo: the same letters on every machine, also where no fonts are installed,
    // and no fontconfig, whose start takes tens of milliseconds and whose memory is never freed.
    cairo_select_font_face(context_.get(), "@cairo:", CAIRO_FONT_SLANT_NORMAL,
                           CAIRO_FONT_WEIGHT_NORMAL);
  }

  void begin_layer(std::string_view /*id*/, std::string_view /*label*/) override {}
  void end_layer() override {}

  void fill(std::string_view /*id*/, std::string_view /*css_class*/, const Path& path,
            Color color) override {
    set_color(color);
    trace(path);
    cairo_fill(context_.get());
  }

  void stroke(std::string_view /*id*/, std::string_view /*css_class*/, const Path& path,
              const LineStyle& style, Precision /*precision*/) override {
    set_color(style.color);
    cairo_set_line_width(context_.get(), style.width_mm * scale_);
    const double dash = style.dash_mm * scale_;
    cairo_set_dash(context_.get(), &dash, dash > 0 ? 1 : 0, 0);
    trace(path);
    cairo_stroke(context_.get());
  }

  void text(const Eigen::Vector2d& at, double size_mm, double most_width_mm, Color color,
            std::string_view utf8) override {
    const std::string terminated(utf8);
    cairo_set_font_size(context_.get(), size_mm * scale_);
    cairo_text_extents_t extents;
    cairo_text_extents(context_.get(), terminated.c_str(), &extents);
    const double most = most_width_mm * scale_;
    if (extents.x_advance > most) {
      cairo_set_font_size(context_.get(), size_mm * scale_ * most / extents.x_advance);
    }
    set_color(color);
    const Eigen::Vector2d p = to_device(at);
    cairo_move_to(context_.get(), p.x(), p.y());
    cairo_show_text(context_.get(), terminated.c_str());
  }

  cairo_status_t status() const { return cairo_status(context_.get()); }

 private:
  Eigen::Vector2d to_device(const Eigen::Vector2d& p) const { return (p - origin_) * scale_; }

  void set_color(Color c) {
    cairo_set_source_rgb(context_.get(), c.red / 255.0, c.green / 255.0, c.blue / 255.0);
  }

  void trace(const Path& path) {
    cairo_t* const c = context_.get();
    const Eigen::Vector2d* p = path.points().data();
    for (const Path::Verb verb : path.verbs()) {
      switch (verb) {
        case Path::Verb::kMove: {
          const Eigen::Vector2d a = to_device(*p++);
          cairo_move_to(c, a.x(), a.y());
          break;
        }
        case Path::Verb::kLine: {
          const Eigen::Vector2d a = to_device(*p++);
          cairo_line_to(c, a.x(), a.y());
          break;
        }
        case Path::Verb::kCubic: {
          const Eigen::Vector2d a = to_device(p[0]);
          const Eigen::Vector2d b = to_device(p[1]);
          const Eigen::Vector2d d = to_device(p[2]);
          cairo_curve_to(c, a.x(), a.y(), b.x(), b.y(), d.x(), d.y());
          p += 3;
          break;
        }
        case Path::Verb::kClose:
          cairo_close_path(c);
          break;
      }
    }
  }

  Context context_;
  Eigen::Vector2d origin_;
  double scale_;
};

Expected<void> draw_on(cairo_surface_t* surface, double scale, const Sheet& sheet,
                       const Drawing& drawing) {
  CairoCanvas canvas(surface, sheet, scale);
  auto drawn = drawing(canvas);
  if (!drawn) return drawn;
  if (canvas.status() != CAIRO_STATUS_SUCCESS) return cairo_failed(canvas.status());
  return {};
}

}  // namespace

bool has_cairo() noexcept { return true; }

Expected<std::string> draw_pdf(const Sheet& sheet, const Drawing& drawing) {
  const double scale = sheet.paper_scale * kPointsPerMm;
  std::string bytes;
  const Surface surface(cairo_pdf_surface_create_for_stream(append, &bytes, sheet.width * scale,
                                                            sheet.height * scale));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, sheet.title.c_str());
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, "limn");
  // cairo would put the time of the call: the same drawing must give the same bytes.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE,
                                 "1970-01-01T00:00:00Z");
  if (auto drawn = draw_on(surface.get(), scale, sheet, drawing); !drawn) {
    return tl::unexpected(std::move(drawn.error()));
  }
  cairo_surface_finish(surface.get());
  const cairo_status_t status = cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS) return cairo_failed(status);
  return bytes;
}

Expected<std::string> draw_png(const Sheet& sheet, double pixels, const Drawing& drawing) {
  const double scale = pixels / std::max(sheet.width, sheet.height);
  const auto pixels_of = [&](double mm) {
    return std::max(1, static_cast<int>(std::lround(mm * scale)));
  };
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels_of(sheet.width),
                                                   pixels_of(sheet.height)));
  if (auto drawn = draw_on(surface.get(), scale, sheet, drawing); !drawn) {
    return tl::unexpected(std::move(drawn.error()));
  }
  std::string bytes;
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface.get(), append, &bytes);
  if (status != CAIRO_STATUS_SUCCESS) return cairo_failed(status);
  return bytes;
}

}  // namespace limn
