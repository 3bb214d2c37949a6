#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "modeler/surface/primitives.hpp"
#include "modeler/view/picture.hpp"
#include "modeler/view/raster/mesh_lines.hpp"
#include "modeler/view/raster/picture_of.hpp"
#include "tests/support/golden.hpp"
#include "tests/support/grid_mesh.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Rgb {
  int red, green, blue;
};

Rgb rgb_of(std::uint32_t pixel) {
  return {static_cast<int>(pixel >> 16 & 255), static_cast<int>(pixel >> 8 & 255),
          static_cast<int>(pixel & 255)};
}

SceneSurface surface_of(const BsplineSurface& surface, int columns = 24, int rows = 24) {
  SceneSurface out;
  out.mesh = test::grid_mesh(surface, columns, rows);
  return out;
}

Scene scene_of(const BsplineSurface& surface, int columns = 24, int rows = 24) {
  Scene scene;
  scene.surfaces.push_back(surface_of(surface, columns, rows));
  return scene;
}

/// A square of side 20 about the z axis, at height z.
SceneSurface square(double z) {
  Frame frame;
  frame.origin = {-10, -10, z};
  return surface_of(make_plane(frame, 20, 20).value(), 2, 2);
}

/// Of all kinds: two surfaces, one with a field, lines, a net in front, and points.
Scene full_scene() {
  const BsplineSurface torus = make_torus(Frame(), 20, 8).value();
  Scene scene = scene_of(torus, 40, 30);
  scene.surfaces[0].field =
      test::field_of(torus, scene.surfaces[0].mesh, &SurfaceCurvature::gaussian);
  scene.surfaces.push_back(square(0));
  scene.lines.push_back({isolines(scene.surfaces[0].mesh, 6)});
  scene.lines.push_back({face_borders(scene.surfaces[1].mesh), {20, 20, 20}, 2});
  scene.lines.push_back({control_net(torus), {150, 60, 60}, 1, true});
  scene.points.push_back({control_points(torus)});
  return scene;
}

ScenePictureOptions small(const char* view, int width = 120, int height = 90) {
  ScenePictureOptions options;
  options.view = parse_view(view).value();
  options.width = width;
  options.height = height;
  return options;
}

PixelImage drawn(const Scene& scene, const ScenePictureOptions& options) {
  auto image = picture_of(scene, options);
  EXPECT_TRUE(image.has_value()) << image.error().what;
  return image.value_or(PixelImage{1, 1, {0}});
}

Rgb middle(const Scene& scene, const ScenePictureOptions& options) {
  const PixelImage image = drawn(scene, options);
  return rgb_of(image.at(image.width / 2, image.height / 2));
}

TEST(ScenePicture, IsTheSameOnEachRunAndForAnyNumberOfThreads) {
  const Scene scene = full_scene();
  for (const char* view : {"iso", "eye=22,0,0;target=0,20,0;fov=90"}) {
    for (const Shading shading : {Shading::kSmooth, Shading::kZebra, Shading::kCurvature}) {
      ScenePictureOptions options = small(view);
      options.shading.shading = shading;
      const PixelImage once = drawn(scene, options);
      EXPECT_EQ(once.pixels.size(), 120U * 90U);
      EXPECT_GT(std::set(once.pixels.begin(), once.pixels.end()).size(), 100U);
      for (const int threads : {1, 2, 3, 8}) {
        options.threads = threads;
        EXPECT_EQ(drawn(scene, options).pixels, once.pixels) << threads << " threads, " << view;
      }
    }
  }
}

TEST(ScenePicture, AsRecorded) {
  const Scene scene = full_scene();
  std::string text;
  for (const Shading shading : {Shading::kSmooth, Shading::kZebra, Shading::kCurvature}) {
    ScenePictureOptions options = small("iso", 36, 24);
    options.shading.shading = shading;
    options.shading.zebra_stripes = 5;
    const PixelImage image = drawn(scene, options);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        char pixel[8];
        std::snprintf(pixel, sizeof pixel, "%06x", static_cast<unsigned>(image.at(x, y)));
        text += pixel;
        text += x + 1 < image.width ? ' ' : '\n';
      }
    }
    text += '\n';
  }
  EXPECT_TRUE(test::matches_golden(text, "scene/torus_and_square.txt"));
}

TEST(ScenePicture, TheNearerSurfaceIsSeen) {
  Scene scene;
  for (const double z : {0.0, 5.0, -5.0}) scene.surfaces.push_back(square(z));
  scene.surfaces[1].front = {200, 0, 0};
  scene.surfaces[2].back = {0, 200, 0};
  const Rgb top = middle(scene, small("top"));
  EXPECT_GT(top.red, 2 * std::max(top.green, top.blue));
  const Rgb bottom = middle(scene, small("bottom"));
  EXPECT_GT(bottom.green, 2 * std::max(bottom.red, bottom.blue));
}

TEST(ScenePicture, InsideHasTheBacksColour) {
  const Scene scene = scene_of(make_sphere(Frame(), 10).value());
  const Rgb outside = middle(scene, small("front"));
  EXPECT_GT(outside.blue, outside.red + 30);
  const Rgb inside = middle(scene, small("eye=0,0,0;target=0,1,0;fov=90"));
  EXPECT_GT(inside.red, inside.blue + 30);
}

TEST(ScenePicture, ACameraInsideSeesNoBackground) {
  const Scene scene = scene_of(make_sphere(Frame(), 10).value(), 12, 12);
  // Near a wall, through which the near plane may not cut.
  for (const char* view : {"eye=0,0,0;target=1,2,3;fov=120", "eye=9,0,0;target=10,0,0;fov=150"}) {
    const auto seen = faces_seen(scene, small(view)).value();
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](const auto& s) { return s.has_value(); }))
        << view;
  }
}

TEST(ScenePicture, APixelIsTheMeanOfItsSamples) {
  // A square that fills 9 tenths of the height, in one pixel: 3 x 3 samples are all inside, and of
  // 1 x 1 the centre is.
  Scene scene;
  scene.surfaces.push_back(square(0));
  ScenePictureOptions options = small("top", 1, 1);
  const std::uint32_t fine = drawn(scene, options).pixels[0];
  options.samples_per_side = 1;
  EXPECT_EQ(drawn(scene, options).pixels[0], fine);
  // White and black in turn are mid grey in linear light: 188 of 255.
  const std::vector<Tone> grey = {0.5F * Tone{1, 1, 1} + 0.5F * Tone{0, 0, 0}};
  std::vector<std::uint32_t> pixels(1);
  to_pixels(grey, pixels);
  EXPECT_EQ(pixels[0], 0xbcbcbcU);
}

TEST(ScenePicture, EdgesAreSmoothed) {
  Scene scene;
  Frame frame;
  frame.x = Vector3d(0.8, 0.6, 0);
  frame.y = Vector3d(-0.6, 0.8, 0);
  scene.surfaces.push_back(surface_of(make_plane(frame, 20, 20).value(), 2, 2));
  ScenePictureOptions options = small("top");
  const auto tones = [&](int samples) {
    options.samples_per_side = samples;
    const PixelImage image = drawn(scene, options);
    std::set<std::uint32_t> row;
    // The background is one tone in a row, the square another.
    for (int x = 0; x < image.width; ++x) row.insert(image.at(x, 30));
    return row.size();
  };
  EXPECT_EQ(tones(1), 2U);
  EXPECT_GT(tones(3), 2U);
}

TEST(ScenePicture, ColoursOfAPixelAreSrgb) {
  std::vector<Tone> tones;
  std::vector<std::uint32_t> expected;
  for (int level = 0; level < 256; ++level) {
    const auto byte = static_cast<std::uint8_t>(level);
    tones.push_back(to_tone({byte, byte, byte}));
    expected.push_back(0x010101U * byte);
  }
  tones.push_back({-1, 2, std::numeric_limits<float>::quiet_NaN()});
  expected.push_back(0x00ff00);
  std::vector<std::uint32_t> pixels(tones.size());
  to_pixels(tones, pixels);
  EXPECT_EQ(pixels, expected);
  EXPECT_NEAR(to_tone({188, 188, 188}).red, 0.5029, 1e-4);  // IEC 61966-2-1
}

TEST(ScenePicture, ZebraStripesAreAsManyAsTheySay) {
  // Across a sphere the mirrored ray turns from the eye's far side to the left, the eye, the right
  // and back: four times half the stripes' 2 N edges.
  Frame frame;
  frame.x = Vector3d(0, 1, 0);  // the seam is behind
  frame.y = Vector3d(-1, 0, 0);
  const Scene scene = scene_of(make_sphere(frame, 10).value(), 100, 100);
  for (const int stripes : {1, 2}) {
    ScenePictureOptions options = small("front", 600, 600);
    options.samples_per_side = 1;
    options.shading.shading = Shading::kZebra;
    options.shading.zebra_stripes = stripes;
    const PixelImage image = drawn(scene, options);
    const auto seen = faces_seen(scene, options).value();
    int edges = 0;
    std::optional<bool> last;
    for (int x = 0; x < image.width; ++x) {
      const std::size_t at = static_cast<std::size_t>(x) + 300U * 600U;
      if (!seen[at]) continue;
      const bool is_dark = rgb_of(image.pixels[at]).green < 100;
      edges += last && *last != is_dark;
      last = is_dark;
    }
    EXPECT_EQ(edges, 4 * stripes);
  }
}

TEST(ScenePicture, CurvatureColoursAreSymmetricAboutZero) {
  Scene scene;
  scene.surfaces.push_back(square(0));
  ScenePictureOptions options = small("top");
  options.shading.shading = Shading::kCurvature;
  options.shading.field_scale = 2;
  const auto colour = [&](double value) {
    scene.surfaces[0].field.assign(scene.surfaces[0].mesh.vertices.size(), value);
    return middle(scene, options);
  };
  const Rgb zero = colour(0);
  EXPECT_LT(
      std::max({zero.red, zero.green, zero.blue}) - std::min({zero.red, zero.green, zero.blue}), 4);
  const Rgb high = colour(2);
  const Rgb low = colour(-2);
  EXPECT_GT(high.red, high.blue + 100);
  EXPECT_GT(low.blue, low.red + 100);
  EXPECT_EQ(colour(5).red, high.red);  // beyond the scale its end stays
  EXPECT_LT(colour(1).red - colour(1).blue, high.red - high.blue);
}

TEST(ScenePicture, TheScaleLeavesOutTheLargestFewFields) {
  std::vector<SceneSurface> surfaces(2);
  for (int i = 1; i <= 101; ++i) {
    surfaces[i % 2].field.push_back(i % 3 == 0 ? -i : i);
  }
  EXPECT_EQ(most_of(surfaces), 96);
  surfaces[0].field.back() = 1e30;
  EXPECT_LE(most_of(surfaces), 97);
  EXPECT_EQ(most_of({}), 0);
}

TEST(ScenePicture, FacesAreWhereTheySeem) {
  Scene scene;
  Mesh all;
  const std::array<BsplineSurface, 6> faces = make_box(Frame(), {10, 10, 10}).value();
  for (const BsplineSurface& face : faces) {  // as six faces of one mesh
    Mesh mesh = test::grid_mesh(face, 3, 3);
    const auto points = static_cast<std::uint32_t>(all.points.size());
    const auto vertices = static_cast<std::uint32_t>(all.vertices.size());
    all.faces.push_back({static_cast<std::uint32_t>(all.triangles.size()), mesh.faces[0].count});
    all.points.insert(all.points.end(), mesh.points.begin(), mesh.points.end());
    for (MeshVertex vertex : mesh.vertices) {
      vertex.point += points;
      all.vertices.push_back(vertex);
    }
    for (auto triangle : mesh.triangles) {
      for (auto& v : triangle) v += vertices;
      all.triangles.push_back(triangle);
    }
  }
  scene.surfaces.resize(2);  // the first without a triangle
  scene.surfaces[1].mesh = all;
  const ScenePictureOptions options = small("iso");
  const auto seen = faces_seen(scene, options).value();
  std::map<std::uint32_t, int> counts;
  int background = 0;
  for (const auto& face : seen) {
    if (!face) {
      ++background;
      continue;
    }
    EXPECT_EQ(face->surface, 1U);
    ++counts[face->face];
  }
  EXPECT_EQ(seen[0], std::nullopt);
  EXPECT_GT(background, 0);
  // High x, low y and high z, of equal areas but for half a rim of about 40 samples.
  ASSERT_EQ(counts.size(), 3U);
  for (const std::uint32_t face : {1U, 2U, 5U}) EXPECT_NEAR(counts[face], counts[5], 40) << face;
  // The top face is above the middle.
  EXPECT_EQ(seen[30 * 120 + 60]->face, 5U);
  // A cube in iso: of the corner in the middle no pixel is further than one away.
  float nearest = 0;
  for (const auto& face : seen) nearest = std::max(nearest, face ? face->nearness : 0.0F);
  EXPECT_NEAR(seen[45 * 120 + 60]->nearness, nearest, 0.01);
}

TEST(ScenePicture, LinesOnASurfaceAreSeenFromItsFrontAlone) {
  const BsplineSurface torus = make_torus(Frame(), 20, 8).value();
  Scene scene = scene_of(torus, 80, 60);
  const Polylines lines = isolines(scene.surfaces[0].mesh, 5);
  for (const char* view : {"iso", "eye=0,-60,40"}) {
    // Pixels that change by the line, where the surface itself is black: none is lost where the
    // line is on the visible side, none is there where it is behind.
    scene.lines = {{lines, {255, 0, 255}, 2}};
    const ScenePictureOptions options = small(view, 240, 180);
    const PixelImage with = drawn(scene, options);
    scene.lines[0].in_front = true;
    const PixelImage in_front = drawn(scene, options);
    const auto is_line = [](std::uint32_t pixel) {
      const Rgb c = rgb_of(pixel);
      return c.red > 200 && c.green < 60 && c.blue > 200;
    };
    const auto marked = std::count_if(with.pixels.begin(), with.pixels.end(), is_line);
    const auto marked_through =
        std::count_if(in_front.pixels.begin(), in_front.pixels.end(), is_line);
    // Half of a torus's surface is hidden, by itself or its back.
    EXPECT_GT(marked, marked_through * 4 / 10) << view;
    EXPECT_LT(marked, marked_through * 8 / 10) << view;
  }
}

TEST(ScenePicture, PointsAreDiscsOfTheirWidth) {
  Scene scene;
  scene.points.push_back({{{0, 0, 0}}, {0, 0, 0}, 40});
  const PixelImage image = drawn(scene, small("top"));
  int black = 0;
  for (const std::uint32_t pixel : image.pixels) black += rgb_of(pixel).green < 128;
  EXPECT_NEAR(black, 3.14159 * 20 * 20, 40);  // give or take a third of its rim's pixels
}

TEST(ScenePicture, AVertexWithoutANormalTakesTheTriangles) {
  Scene scene;
  scene.surfaces.push_back(square(0));
  const Rgb before = middle(scene, small("top"));
  for (MeshVertex& vertex : scene.surfaces[0].mesh.vertices) vertex.normal.setZero();
  const Rgb after = middle(scene, small("top"));
  EXPECT_EQ(before.red, after.red);
  EXPECT_EQ(before.blue, after.blue);
}

TEST(ScenePicture, RefusesWhatCannotBeDrawn) {
  const ScenePictureOptions options = small("iso");
  const auto refused = [&](auto change) {
    Scene scene = full_scene();
    ScenePictureOptions changed = options;
    change(scene, changed);
    const auto image = picture_of(scene, changed);
    EXPECT_FALSE(image.has_value());
    if (image) return Error();
    EXPECT_FALSE(image.error().what.empty());
    EXPECT_FALSE(image.error().remedy.empty());
    EXPECT_EQ(faces_seen(scene, changed).error().code, image.error().code);
    return image.error();
  };
  using Options = ScenePictureOptions;
  EXPECT_EQ(refused([](Scene& scene, Options&) { scene = Scene(); }).code, ErrorCode::kMissing);
  EXPECT_EQ(
      refused([](Scene& scene, Options&) { scene.surfaces[0].mesh.points[7].y() = kNan; }).code,
      ErrorCode::kOutOfRange);
  EXPECT_EQ(refused([](Scene& scene, Options&) { scene.lines[0].lines[0][0].x() = kNan; }).code,
            ErrorCode::kOutOfRange);
  EXPECT_EQ(refused([](Scene& scene, Options&) { scene.points[0].points[0].z() = 1e200; }).code,
            ErrorCode::kOutOfRange);
  const Error normal =
      refused([](Scene& scene, Options&) { scene.surfaces[1].mesh.vertices[0].normal.x() = kNan; });
  EXPECT_EQ(normal.at, "surface 1");
  EXPECT_THAT(normal.what, HasSubstr("normal"));
  EXPECT_EQ(refused([](Scene& scene, Options&) { scene.surfaces[0].field[0] = kNan; }).code,
            ErrorCode::kOutOfRange);
  EXPECT_EQ(refused([](Scene& scene, Options&) { scene.surfaces[0].field.pop_back(); }).code,
            ErrorCode::kPointCount);
  EXPECT_EQ(refused([](Scene& scene, Options&) { scene.lines[0].width = 0; }).code,
            ErrorCode::kOutOfRange);
  EXPECT_EQ(refused([](Scene& scene, Options&) { scene.points[0].width = kNan; }).code,
            ErrorCode::kOutOfRange);
  EXPECT_EQ(refused([](Scene&, Options& o) { o.width = 0; }).code, ErrorCode::kOutOfRange);
  const Error wide = refused([](Scene&, Options& o) { o.width = 8193; });
  EXPECT_EQ(wide.code, ErrorCode::kLimit);
  EXPECT_EQ(wide.at, "width");
  EXPECT_THAT(wide.remedy, HasSubstr("8192"));
  EXPECT_EQ(refused([](Scene&, Options& o) { o.height = 100'000; }).code, ErrorCode::kLimit);
  EXPECT_EQ(refused([](Scene&, Options& o) { o.samples_per_side = 5; }).code, ErrorCode::kLimit);
  EXPECT_EQ(refused([](Scene&, Options& o) { o.threads = 0; }).code, ErrorCode::kOutOfRange);
  EXPECT_EQ(refused([](Scene&, Options& o) { o.shading.zebra_stripes = 0; }).code,
            ErrorCode::kOutOfRange);
  EXPECT_EQ(refused([](Scene&, Options& o) { o.shading.field_scale = kNan; }).code,
            ErrorCode::kOutOfRange);
}

TEST(ScenePicture, BecomesAPng) {
  const Scene scene = full_scene();
  const auto png = scene_to_png(scene, small("iso"));
  if (!has_cairo()) {
    EXPECT_EQ(png.error().code, ErrorCode::kMissing);
    return;
  }
  ASSERT_TRUE(png.has_value());
  EXPECT_EQ(png->substr(1, 3), "PNG");
  EXPECT_EQ(*png, *scene_to_png(scene, small("iso")));
  EXPECT_EQ(scene_to_png(Scene(), small("iso")).error().code, ErrorCode::kMissing);
}

TEST(ScenePicture, OneSideMayBeAsLongAsAllowed) {
  Scene scene;
  scene.surfaces.push_back(square(0));
  for (const auto& [width, height] : {std::pair(8192, 2), std::pair(2, 8192), std::pair(1, 1)}) {
    ScenePictureOptions options = small("top", width, height);
    options.threads = 2;
    const PixelImage image = drawn(scene, options);
    EXPECT_EQ(image.pixels.size(), static_cast<std::size_t>(width) * height);
    const Rgb centre = rgb_of(image.at(width / 2, height / 2));
    EXPECT_GT(centre.blue, centre.red + 30) << width << " x " << height;
  }
}

}  // namespace
}  // namespace limn
