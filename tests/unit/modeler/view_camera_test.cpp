#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "modeler/view/raster/camera.hpp"
#include "modeler/view/raster/raster_vertex.hpp"

namespace limn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::HasSubstr;

/// Of products and quotients of numbers about 1000.
constexpr double kRounding = 1e-9;

const std::vector<Vector3d> kCube = {{-10, -10, -10}, {10, -10, -10}, {-10, 10, -10}, {10, 10, -10},
                                     {-10, -10, 10},  {10, -10, 10},  {-10, 10, 10},  {10, 10, 10}};

Camera placed(const char* view, const std::vector<Vector3d>& points = kCube, int width = 200,
              int height = 200) {
  const std::span<const Vector3d> sets[] = {points};
  auto camera = place_camera(parse_view(view).value(), sets, width, height);
  EXPECT_TRUE(camera.has_value()) << camera.error().what;
  return camera.value_or(Camera());
}

Error refusal(const View& view, const std::vector<Vector3d>& points = kCube) {
  const std::span<const Vector3d> sets[] = {points};
  const auto camera = place_camera(view, sets, 200, 200);
  EXPECT_FALSE(camera.has_value());
  return camera ? Error() : camera.error();
}

/// In samples of a 200 x 200 raster, from its middle, to the right and up.
Vector2d seen_at(const Camera& camera, const Vector3d& place) {
  const glm::dvec4 p = to_raster(camera.to_raster(200, 200), place);
  return {p.x / p.w - 100, 100 - p.y / p.w};
}

TEST(Camera, NamedViewsLookAsTheySay) {
  struct Case {
    const char* name;
    Vector3d right, up;  // of the picture, in the model
  };
  const Case cases[] = {{"front", {1, 0, 0}, {0, 0, 1}}, {"back", {-1, 0, 0}, {0, 0, 1}},
                        {"left", {0, -1, 0}, {0, 0, 1}}, {"right", {0, 1, 0}, {0, 0, 1}},
                        {"top", {1, 0, 0}, {0, 1, 0}},   {"bottom", {1, 0, 0}, {0, -1, 0}}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Camera camera = placed(c.name);
    // A cube of 20 mm over 200 samples, less a twentieth on each side: 9 samples a mm.
    EXPECT_LT((seen_at(camera, c.right) - Vector2d(9, 0)).norm(), kRounding);
    EXPECT_LT((seen_at(camera, c.up) - Vector2d(0, 9)).norm(), kRounding);
    EXPECT_LT((camera.right.cross(camera.up) - camera.back).norm(), kRounding);
  }
}

TEST(Camera, IsoShowsThreeAxesAtEqualAngles) {
  const Camera camera = placed("iso");
  const Vector2d x = seen_at(camera, {1, 0, 0});
  const Vector2d y = seen_at(camera, {0, 1, 0});
  const Vector2d z = seen_at(camera, {0, 0, 1});
  EXPECT_NEAR(x.norm(), y.norm(), kRounding);
  EXPECT_NEAR(x.norm(), z.norm(), kRounding);
  EXPECT_NEAR(z.x(), 0, kRounding);
  EXPECT_GT(z.y(), 0);
  EXPECT_GT(x.x(), 0);  // from the front right: x to the right and down, y to the right and up
  EXPECT_GT(y.x(), 0);
  EXPECT_LT(x.y(), 0);
}

TEST(Camera, NearerIsNearer) {
  for (const char* view : {"front", "front;fov=40", "eye=0,-50,0"}) {
    const Camera camera = placed(view);
    const auto nearness = [&](double y) {
      const glm::dvec4 p = to_raster(camera.to_raster(200, 200), {0, y, 0});
      EXPECT_NEAR(p.z / p.w, camera.nearness((camera.eye - Vector3d(0, y, 0)).dot(camera.back)),
                  kRounding);
      return p.z / p.w;
    };
    EXPECT_GT(nearness(-10), nearness(10)) << view;
    EXPECT_LE(nearness(-10), 1) << view;
    EXPECT_GE(nearness(10), 0) << view;
  }
}

TEST(Camera, AnEyeAndAnAngleArePinhole) {
  const Camera camera = placed("eye=100,0,0;target=0,0,0;fov=60");
  EXPECT_TRUE(camera.is_perspective);
  // Looking along -x: y to the right. Half of 200 samples are tan(30 deg) at distance 1.
  const double scale = 100 / std::tan(std::numbers::pi / 6);
  EXPECT_LT((seen_at(camera, {50, 10, 20}) - scale / 50 * Vector2d(10, 20)).norm(), kRounding);
  EXPECT_NEAR(camera.sample_size(50, 200), 50 / scale, kRounding);
}

TEST(Camera, WithoutATargetLooksAtTheMiddle) {
  const std::vector<Vector3d> points = {{10, 20, 30}, {14, 40, 30}};
  const Camera camera = placed("eye=100,-200,50", points);
  EXPECT_LT(seen_at(camera, {12, 30, 30}).norm(), kRounding);
  EXPECT_NEAR(camera.half_height, std::tan(0.5 * 35 * std::numbers::pi / 180), kRounding);
}

TEST(Camera, LookingStraightDownHasYUp) {
  const Camera camera = placed("eye=0,0,100;target=0,0,0");
  EXPECT_LT((camera.up - Vector3d::UnitY()).norm(), kRounding);
  EXPECT_LT((camera.right - Vector3d::UnitX()).norm(), kRounding);
}

TEST(Camera, MayBeInsideTheModel) {
  const Camera camera = placed("eye=0,0,0;target=0,1,0;fov=90");
  EXPECT_GT(camera.near, 0);
  EXPECT_LT(camera.near, 0.01);
  EXPECT_GT(camera.far, 10);
}

TEST(Camera, AModelOfOnePointIsInTheMiddle) {
  for (const char* view : {"iso", "iso;fov=35"}) {
    const Camera camera = placed(view, {{7, 8, 9}});
    EXPECT_LT(seen_at(camera, {7, 8, 9}).norm(), kRounding) << view;
    EXPECT_GT(camera.far, camera.near) << view;
  }
}

TEST(CameraText, MayLeaveOutAllButTheEye) {
  const View view = parse_view("eye=1,-2.5,3e2").value();
  EXPECT_EQ(*view.eye, Vector3d(1, -2.5, 300));
  EXPECT_FALSE(view.target.has_value());
  EXPECT_FALSE(view.up.has_value());
  const View full = parse_view("up=0,1,0;fov=0;target=1,2,3;eye=4,5,6").value();
  EXPECT_EQ(full.fov, 0);
  EXPECT_EQ(*full.target, Vector3d(1, 2, 3));
  EXPECT_EQ(*full.up, Vector3d(0, 1, 0));
}

TEST(CameraText, SaysWhatIsWrong) {
  struct Case {
    const char* text;
    ErrorCode code;
    const char* says;
  };
  const Case cases[] = {
      {"", ErrorCode::kUnknown, "''"},
      {"isometric", ErrorCode::kUnknown, "'isometric'"},
      {"eye=1,2", ErrorCode::kSyntax, "'1,2'"},
      {"eye=1,2,x", ErrorCode::kSyntax, "'1,2,x'"},
      {"eye=1,2,nan", ErrorCode::kSyntax, "nan"},
      {"eye=1,2,1e300", ErrorCode::kSyntax, "1e300"},
      {"eye=1,2,3 ", ErrorCode::kSyntax, "three numbers"},
      {"eye", ErrorCode::kSyntax, "three numbers"},
      {"eye=1,2,3;eye=1,2,3", ErrorCode::kSyntax, "twice"},
      {"eye=1,2,3;", ErrorCode::kUnknown, "''"},
      {"eye=1,2,3;zoom=2", ErrorCode::kUnknown, "zoom"},
      {"eye=1,2,3;fov=wide", ErrorCode::kSyntax, "'wide'"},
      {"eye=1,2,3;fov=0.5", ErrorCode::kOutOfRange, "angle"},
      {"eye=1,2,3;fov=171", ErrorCode::kOutOfRange, "angle"},
      {"eye=1,2,3;fov=-10", ErrorCode::kOutOfRange, "angle"},
      {"eye=1,2,3;target=1,2,3", ErrorCode::kOutOfRange, "eye"},
      {"target=1,2,3", ErrorCode::kMissing, "no eye"},
      {"front;eye=1,2,3", ErrorCode::kSyntax, "'front'"},
      {"front;fov=40;fov=40", ErrorCode::kSyntax, "twice"},
  };
  for (const Case& c : cases) {
    const auto view = parse_view(c.text);
    ASSERT_FALSE(view.has_value()) << c.text;
    EXPECT_EQ(view.error().code, c.code) << c.text;
    EXPECT_THAT(view.error().what, HasSubstr(c.says)) << c.text;
    EXPECT_THAT(view.error().at, HasSubstr("camera")) << c.text;
    EXPECT_FALSE(view.error().remedy.empty()) << c.text;
  }
}

TEST(Camera, RefusesWhatCannotBeShown) {
  EXPECT_EQ(refusal({}, {}).code, ErrorCode::kMissing);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal({}, {{0, 0, 0}, {0, nan, 0}}).code, ErrorCode::kOutOfRange);
  EXPECT_EQ(refusal({}, {{0, 0, 0}, {0, 0, 1e13}}).code, ErrorCode::kOutOfRange);
  EXPECT_THAT(refusal(parse_view("eye=0,-100,0;target=0,-200,0").value()).what,
              HasSubstr("behind"));
  EXPECT_THAT(refusal(parse_view("eye=0,0,0").value()).what, HasSubstr("eye"));
  EXPECT_THAT(refusal(parse_view("eye=0,0,100;up=0,0,1").value()).what, HasSubstr("up"));
  View narrow;
  narrow.fov = 4;
  EXPECT_EQ(refusal(narrow).code, ErrorCode::kOutOfRange);
}

}  // namespace
}  // namespace limn
