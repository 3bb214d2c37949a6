#include "modeler/view/raster/shading.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "input/base/expect.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kFieldPart = 0.95;
constexpr int kScaleSteps = 1024;
/// Shorter sums of normals say nothing: the triangle's own is taken.
constexpr float kLeastNormal = 1e-3F;

constexpr Color kBackgroundTop = {252, 253, 254};
constexpr Color kBackgroundBottom = {214, 221, 229};

// Lights in the camera's frame (x right, y up, z to the viewer), so that a picture is lit alike
// from every side: a key light over the left shoulder, a fill light from the right, sky and ground.
constexpr std::array<double, 3> kKey = {-0.45, 0.62, 0.64};
constexpr std::array<double, 3> kFill = {0.80, -0.05, 0.55};
constexpr float kKeyLight = 0.70F;
constexpr float kFillLight = 0.14F;
constexpr float kSky = 0.24F;
constexpr float kGround = 0.09F;
constexpr float kGloss = 0.20F;

/// Of a large light: it reaches around the edge of what it sees and falls to 0 without a kink,
/// which the eye would take for one of the surface.
float soft_light(float cosine) noexcept {
  const float part = 0.5F + 0.5F * cosine;
  return part * part;
}

/// x^32
float highlight(float x) noexcept {
  for (int i = 0; i < 5; ++i) x *= x;
  return x;
}

/// Unit, in the model's frame, of a direction in the camera's.
Vector3f in_model(const Camera& camera, const std::array<double, 3>& d) noexcept {
  const Vector3d sum = d[0] * camera.right + d[1] * camera.up + d[2] * camera.back;
  return sum.normalized().cast<float>();
}

/// Unit, outwards; of vertices that have none, the triangle's own.
Vector3f normal_in(const Mesh& mesh, std::uint32_t triangle,
                   const std::array<double, 3>& weights) noexcept {
  const auto& corners = mesh.triangles[triangle];
  const auto normal = [&](std::size_t k) -> const Vector3d& {
    return mesh.vertices[corners[k]].normal;
  };
  const Vector3f sum =
      (weights[0] * normal(0) + weights[1] * normal(1) + weights[2] * normal(2)).cast<float>();
  const float length2 = sum.squaredNorm();
  if (length2 > kLeastNormal * kLeastNormal) return sum * (1 / std::sqrt(length2));
  const auto point = [&](std::size_t k) { return mesh.points[mesh.vertices[corners[k]].point]; };
  const Vector3d own = (point(1) - point(0)).cross(point(2) - point(0));
  return own.stableNormalized().cast<float>();
}

/// What is mirrored: rings about the picture's x axis, light and dark in turn. About that axis
/// since tops and sides, the usual faces, mirror places far from its ends, where the rings are
/// small.
bool is_dark_stripe(const Vector3f& n, const Vector3f& towards_eye, const Vector3f& right,
                    int stripes) noexcept {
  const float mirrored = 2 * n.dot(towards_eye) * n.dot(right) - towards_eye.dot(right);
  // An odd number: what mirrors the middle is the middle of a ring, not an edge.
  const auto rings = static_cast<float>(2 * stripes + 1);
  const float at = 0.5F * (1 + mirrored) * rings;
  return (static_cast<int>(std::clamp(at, 0.0F, rings - 0.5F)) & 1) != 0;
}

}  // namespace

double most_of(const std::vector<SceneSurface>& surfaces) {
  std::vector<double> sizes;
  for (const SceneSurface& surface : surfaces) {
    for (const double value : surface.field) sizes.push_back(std::abs(value));
  }
  if (sizes.empty()) return 0;
  const auto last = static_cast<double>(sizes.size() - 1);
  const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(kFieldPart * last);
  std::nth_element(sizes.begin(), at, sizes.end());
  return *at;
}

Shader::Shader(const Scene& scene, const SceneOnRaster& raster, const Camera& camera, int width,
               int height, const ShadingOptions& options)
    : raster_(raster),
      camera_(camera),
      width_(width),
      height_(height),
      options_(options),
      lights_{in_model(camera, kKey), in_model(camera, kFill), camera.up.cast<float>(),
              camera.right.cast<float>()},
      sight_(sight_along(camera.back)) {
  for (const SceneSurface& surface : scene.surfaces) {
    LIMN_EXPECT(surface.field.empty() || surface.field.size() == surface.mesh.vertices.size());
    Surface& own = surfaces_.emplace_back();
    own.shown = &surface;
    own.front = to_tone(surface.front);
    own.back = to_tone(surface.back);
  }
  for (const SceneLines& lines : scene.lines) lines_.push_back(to_tone(lines.color));
  for (const ScenePoints& points : scene.points) points_.push_back(to_tone(points.color));
  if (options.shading != Shading::kCurvature) return;
  for (int i = 0; i <= kScaleSteps; ++i) scale_.push_back(diverging(2.0 * i / kScaleSteps - 1));
  const double most = options.field_scale > 0 ? options.field_scale : most_of(scene.surfaces);
  per_field_ = most > 0 ? 1 / most : 0;
}

Shader::Sight Shader::sight_along(const Vector3d& towards_eye) const noexcept {
  const Vector3f unit = towards_eye.normalized().cast<float>();
  return {unit, (lights_.key + unit).normalized()};
}

Shader::Sight Shader::sight_at(int x, int y) const noexcept {
  if (!camera_.is_perspective) return sight_;
  const double size = camera_.sample_size(1, height_);
  return sight_along(camera_.back - (x + 0.5 - 0.5 * width_) * size * camera_.right -
                     (0.5 * height_ - y - 0.5) * size * camera_.up);
}

Tone Shader::background(int y) const noexcept {
  static const Tone kTop = to_tone(kBackgroundTop);
  static const Tone kBottom = to_tone(kBackgroundBottom);
  const float down = (static_cast<float>(y) + 0.5F) / static_cast<float>(height_);
  return (1 - down) * kTop + down * kBottom;
}

/// On a matt surface of that unit normal.
float Shader::matt_light(const Vector3f& n) const noexcept {
  return kGround + (kSky - kGround) * (0.5F + 0.5F * n.dot(lights_.up)) +
         kKeyLight * soft_light(n.dot(lights_.key)) + kFillLight * soft_light(n.dot(lights_.fill));
}

Tone Shader::tone_of_surface(const ScenePart& part, std::uint32_t triangle, int x,
                             int y) const noexcept {
  const Surface& surface = surfaces_[part.index];
  const TrianglePlace place = raster_.place_in(part.index, triangle, x, y);
  Vector3f n = normal_in(surface.shown->mesh, triangle, place.weights);
  if (!place.is_front) n = -n;
  const Sight sight = sight_at(x, y);
  const Tone& base = place.is_front ? surface.front : surface.back;
  switch (options_.shading) {
    case Shading::kSmooth:
      break;
    case Shading::kZebra: {
      // Some of the light's fall over the surface is left, so that its shape is seen between.
      const float light = 0.45F + 0.5F * matt_light(n);
      const bool is_dark =
          is_dark_stripe(n, sight.towards_eye, lights_.right, options_.zebra_stripes);
      const Tone stripe = is_dark ? Tone{0.012F, 0.014F, 0.018F} : Tone{0.93F, 0.94F, 0.95F};
      return place.is_front ? light * stripe : light * (0.35F * stripe + 0.4F * base);
    }
    case Shading::kCurvature: {
      const std::vector<double>& field = surface.shown->field;
      if (field.empty()) break;
      const auto& corners = surface.shown->mesh.triangles[triangle];
      double value = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        value += place.weights[k] * field[corners[k]];
      }
      const double at = 0.5 * (1 + std::clamp(value * per_field_, -1.0, 1.0)) * kScaleSteps;
      return (0.35F + 0.6F * matt_light(n)) * scale_[static_cast<std::size_t>(at)];
    }
  }
  const float shine = kGloss * highlight(std::max(n.dot(sight.half), 0.0F));
  return matt_light(n) * base + Tone{shine, shine, shine};
}

void Shader::add_row(std::span<const std::uint64_t> keys, int y, int k,
                     std::span<Tone> tones) const {
  LIMN_EXPECT(tones.size() * static_cast<std::size_t>(k) == keys.size());
  const float share = 1 / static_cast<float>(k * k);
  const Tone empty = background(y);
  int x = 0;
  ScenePart found;
  for (Tone& tone : tones) {
    Tone sum;
    for (int i = 0; i < k; ++i, ++x) {
      const std::uint32_t id = RasterBand::id_of(keys[static_cast<std::size_t>(x)]);
      if (id == RasterBand::kNothing) {
        sum += empty;
        continue;
      }
      if (!found.has(id)) found = raster_.part_of(id);
      switch (found.kind) {
        case ScenePart::Kind::kSurface:
          sum += tone_of_surface(found, id - found.first_id, x, y);
          break;
        case ScenePart::Kind::kLines:
          sum += lines_[found.index];
          break;
        case ScenePart::Kind::kPoints:
          sum += points_[found.index];
          break;
      }
    }
    tone += share * sum;
  }
}

}  // namespace limn
