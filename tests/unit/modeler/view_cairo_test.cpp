#include <cairo.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <sstream>

#include "modeler/view/page.hpp"
#include "modeler/view/picture.hpp"
#include "tests/unit/modeler/sketch_examples.hpp"

namespace limn {
namespace {

using testing::HasSubstr;

/// A decoded PNG.
class Image {
 public:
  explicit Image(const std::string& png) : rest_(png) {
    surface_.reset(cairo_image_surface_create_from_png_stream(read, this));
    EXPECT_EQ(cairo_surface_status(surface_.get()), CAIRO_STATUS_SUCCESS);
  }

  int width() const { return cairo_image_surface_get_width(surface_.get()); }
  int height() const { return cairo_image_surface_get_height(surface_.get()); }

  /// 0 (black) to 255 (white); white outside.
  int brightness(int x, int y) const {
    if (x < 0 || y < 0 || x >= width() || y >= height()) return 255;
    const unsigned char* p = cairo_image_surface_get_data(surface_.get()) +
                             y * cairo_image_surface_get_stride(surface_.get()) + 4 * x;
    return (p[0] + p[1] + p[2]) / 3;
  }

  /// At a place of the sketch.
  int brightness(const Page& page, const Eigen::Vector2d& p) const {
    const double scale = width() / page.width;
    return brightness(static_cast<int>(std::floor((p.x() - page.origin.x()) * scale)),
                      static_cast<int>(std::floor((p.y() - page.origin.y()) * scale)));
  }

  /// Pixels that are not white.
  int marked() const {
    int count = 0;
    for (int y = 0; y < height(); ++y) {
      for (int x = 0; x < width(); ++x) count += brightness(x, y) < 250;
    }
    return count;
  }

 private:
  static cairo_status_t read(void* self, unsigned char* data, unsigned int length) {
    auto& rest = static_cast<Image*>(self)->rest_;
    if (rest.size() < length) return CAIRO_STATUS_READ_ERROR;
    std::memcpy(data, rest.data(), length);
    rest.remove_prefix(length);
    return CAIRO_STATUS_SUCCESS;
  }

  struct Destroy {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  };
  std::string_view rest_;
  std::unique_ptr<cairo_surface_t, Destroy> surface_;
};

PictureOptions bare() {
  PictureOptions options;
  options.control_polygons = options.corners = options.scale_bar = options.caption = false;
  return options;
}

std::string png_of(const Sketch& sketch, const PictureOptions& options = {}) {
  auto png = sketch_to_png(sketch, options);
  EXPECT_TRUE(png.has_value()) << png.error().what;
  return png.value_or("");
}

std::string pdf_of(const Sketch& sketch) {
  auto pdf = sketch_to_pdf(sketch);
  EXPECT_TRUE(pdf.has_value()) << pdf.error().what;
  return pdf.value_or("");
}

/// Width and height of the first page, in points.
std::pair<double, double> media_box(const std::string& pdf) {
  const std::string key = "/MediaBox [ 0 0 ";
  const auto at = pdf.find(key);
  EXPECT_NE(at, std::string::npos);
  std::istringstream in(pdf.substr(at + key.size(), 100));
  std::pair<double, double> out;
  in >> out.first >> out.second;
  return out;
}

TEST(SketchPng, HasInkWhereTheCurvesAre) {
  const Sketch sketch = test::four_strokes();
  const Page page = lay_out_page(sketch, bare()).value();
  const Image image(png_of(sketch, bare()));
  for (const SketchStroke& stroke : sketch.strokes) {
    const double begin = stroke.curve.knots().domain_begin();
    const double end = stroke.curve.knots().domain_end();
    for (int i = 0; i <= 200; ++i) {
      EXPECT_LT(image.brightness(page, stroke.curve.point(begin + (end - begin) * i / 200)), 60);
    }
  }
  EXPECT_EQ(image.brightness(0, 0), 255);
  EXPECT_EQ(image.brightness(page, {40, 32}), 255);  // inside the loop
}

TEST(SketchPng, InkCoversItsArea) {
  // Length times width, in pixels: neither gaps nor blots. The strokes cross in small areas.
  Sketch sketch;
  sketch.strokes = {test::stroke_of(test::wave())};
  const Page page = lay_out_page(sketch, bare()).value();
  const Image image(png_of(sketch, bare()));
  const double scale = image.width() / page.width;
  const double expected = sketch.strokes[0].length_mm * 0.6 * page.ink_width * scale * scale;
  // The rim counts whole pixels, about one along the length on both sides.
  const double rim = 2 * sketch.strokes[0].length_mm * scale;
  EXPECT_NEAR(image.marked(), expected + 0.5 * rim, 0.5 * rim);
}

TEST(SketchPng, PressureWidensInk) {
  Sketch sketch;
  sketch.strokes = {test::stroke_of(test::wave())};
  sketch.strokes[0].pressure = {{0, 1}, {3, 1}};
  const int hard = Image(png_of(sketch, bare())).marked();
  sketch.strokes.push_back(test::stroke_of(test::dot(30, 20)));  // its pressure is the largest
  sketch.strokes[1].pressure = {{0, 1}};
  sketch.strokes[0].pressure = {{0, 0.1}, {3, 0.1}};
  const int soft = Image(png_of(sketch, bare())).marked();
  EXPECT_GT(hard, 2 * soft);
}

TEST(SketchPng, LongerSideIsWithinBounds) {
  const Image common(png_of(test::four_strokes()));
  EXPECT_EQ(common.width(), 1200);  // 66 mm at 12 a mm would be fewer
  EXPECT_EQ(common.height(), 940);  // 51.72 mm
  Sketch large{0.1, {test::stroke_of(test::dot(0, 0)), test::stroke_of(test::dot(300, 100))}};
  EXPECT_EQ(Image(png_of(large)).width(), 2000);
  PictureOptions small;
  small.most_pixels = 64;
  EXPECT_EQ(Image(png_of(large, small)).width(), 64);
}

TEST(SketchPng, AHugeCoordinateMakesAnOrdinaryPicture) {
  Sketch sketch{0.1,
                {test::stroke_of(test::dot(0, 0)), test::stroke_of(test::dot(1e9, -1e9)),
                 test::stroke_of(test::wave())}};
  const std::string png = png_of(sketch);
  EXPECT_LT(png.size(), 200'000U);
  const Image image(png);
  EXPECT_LE(image.width(), 2000);
  EXPECT_EQ(image.height(), 2000);
  EXPECT_GT(image.marked(), 1000);
}

TEST(SketchPng, ADotIsRound) {
  Sketch sketch{0.1, {test::stroke_of(test::dot(30, 20))}};
  const Page page = lay_out_page(sketch, bare()).value();
  const Image image(png_of(sketch, bare()));
  EXPECT_LT(image.brightness(page, {30, 20}), 60);
  const double radius = 0.5 * page.ink_width * image.width() / page.width;
  // The disc's area, give or take half of its rim's pixels.
  EXPECT_NEAR(image.marked(), 3.14159 * radius * radius, 3.2 * radius + 4);
}

TEST(SketchPng, WithoutStrokesIsScaleBarAndCaption) {
  EXPECT_EQ(Image(png_of({0.05, {}}, bare())).marked(), 0);
  EXPECT_GT(Image(png_of({0.05, {}})).marked(), 1000);
}

TEST(SketchPng, CaptionAndScaleBarAreNotClipped) {
  const Image image(png_of(test::four_strokes()));
  for (int x = 0; x < image.width(); ++x) {
    EXPECT_EQ(image.brightness(x, 0), 255);
    EXPECT_EQ(image.brightness(x, image.height() - 1), 255);
  }
  for (int y = 0; y < image.height(); ++y) {
    EXPECT_EQ(image.brightness(0, y), 255);
    EXPECT_EQ(image.brightness(image.width() - 1, y), 255);
  }
}

TEST(SketchPdf, OneMillimetreIsOneMillimetre) {
  const auto [width, height] = media_box(pdf_of(test::four_strokes()));
  EXPECT_NEAR(width, 66 * 72 / 25.4, 0.01);
  EXPECT_NEAR(height, 51.72 * 72 / 25.4, 0.01);
}

TEST(SketchPdf, IsDrawnSmallerThanPdfsLargestPage) {
  Sketch sketch{0.1, {test::stroke_of(test::dot(0, 0)), test::stroke_of(test::dot(1e9, -1e9))}};
  const auto [width, height] = media_box(pdf_of(sketch));
  EXPECT_LE(std::max(width, height), 14'400);
  EXPECT_GT(std::max(width, height), 5'000);
}

TEST(SketchPdf, IsComplete) {
  for (const Sketch& sketch : {Sketch{}, test::four_strokes()}) {
    const std::string pdf = pdf_of(sketch);
    EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
    EXPECT_EQ(pdf.substr(pdf.size() - 6), "%%EOF\n");
  }
}

TEST(SketchPictures, SameSketchGivesTheSameBytes) {
  const std::string pdf = pdf_of(test::four_strokes());
  EXPECT_EQ(pdf, pdf_of(test::four_strokes()));
  EXPECT_THAT(pdf, HasSubstr("/CreationDate (19700101000000"));
  EXPECT_EQ(png_of(test::four_strokes()), png_of(test::four_strokes()));
}

TEST(SketchPictures, PassOnWhatCannotBeDrawn) {
  const Sketch far{0.1, {test::stroke_of(test::dot(1e300, 0))}};
  EXPECT_EQ(sketch_to_png(far).error().code, ErrorCode::kOutOfRange);
  EXPECT_EQ(sketch_to_pdf(far).error().code, ErrorCode::kOutOfRange);
  Sketch quartic{0.1,
                 {test::stroke_of(test::make_curve(KnotVector::make_clamped(4, 0, 1),
                                                   {{0, 0}, {1, 1}, {2, 0}, {3, 1}, {4, 0}}))}};
  EXPECT_EQ(sketch_to_png(quartic).error().code, ErrorCode::kLimit);
  EXPECT_EQ(sketch_to_pdf(quartic).error().code, ErrorCode::kLimit);
}

}  // namespace
}  // namespace limn
