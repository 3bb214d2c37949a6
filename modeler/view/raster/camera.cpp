#include "modeler/view/raster/camera.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "input/base/expect.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kUsualFov = 35 * kDegree;
constexpr double kLeastFov = 1 * kDegree;
constexpr double kMostFov = 170 * kDegree;
/// Sine of the least angle between `up` and the line of sight.
constexpr double kLeastSine = 1e-6;
/// Part of the picture on each side that the model leaves free.
constexpr double kMargin = 0.05;
/// How near is seen when the camera is inside the model, as part of the farthest distance.
constexpr double kNearestPart = 1e-4;
/// How far before the model the eye stays that is moved there, as part of the model's size.
constexpr double kStandOff = 0.1;
/// Room before and behind the model, as part of its depth or width.
constexpr double kDepthRoom = 1e-3;

struct NamedView {
  std::string_view name;
  std::array<double, 3> towards_eye;
  std::array<double, 3> up;
};

constexpr NamedView kNamedViews[] = {
    {"iso", {1, -1, 1}, {0, 0, 1}},     {"front", {0, -1, 0}, {0, 0, 1}},
    {"back", {0, 1, 0}, {0, 0, 1}},     {"left", {-1, 0, 0}, {0, 0, 1}},
    {"right", {1, 0, 0}, {0, 0, 1}},    {"top", {0, 0, 1}, {0, 1, 0}},
    {"bottom", {0, 0, -1}, {0, -1, 0}},
};

constexpr const char* kForms =
    "give iso, front, back, left, right, top, bottom, or eye=x,y,z;target=x,y,z;up=x,y,z;fov=DEG";

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<Vector3d> triple(std::string_view text) {
  const auto words = split(text, ',');
  if (words.size() != 3) return std::nullopt;
  Vector3d out;
  for (int i = 0; i < 3; ++i) {
    const auto value = number(words[static_cast<std::size_t>(i)]);
    if (!value || std::abs(*value) > kFarthestCoordinate) return std::nullopt;
    out[i] = *value;
  }
  return out;
}

bool is_allowed_fov(double fov) { return fov == 0 || (fov >= kLeastFov && fov <= kMostFov); }

tl::unexpected<Error> bad_fov() {
  return fail(ErrorCode::kOutOfRange, "camera, fov", "the angle of view is not allowed",
              "give 0 for a parallel projection, or 1 to 170 degrees");
}

tl::unexpected<Error> eye_at_target() {
  return fail(ErrorCode::kOutOfRange, "camera", "the eye is where the camera looks",
              "give another eye or target");
}

bool is_along(const Vector3d& a, const Vector3d& b) {
  return a.normalized().cross(b.normalized()).norm() < kLeastSine;
}

tl::unexpected<Error> up_along_sight() {
  return fail(ErrorCode::kOutOfRange, "camera, up", "'up' points along the line of sight",
              "give another direction, such as up=0,1,0 for a look downwards");
}

/// What the words before and after '=' of one part say; the view changes by it.
Expected<void> read_part(std::string_view part, View& view, bool& has_fov) {
  const std::size_t equals = part.find('=');
  const std::string_view key = part.substr(0, equals);
  const std::string_view value =
      equals == std::string_view::npos ? std::string_view() : part.substr(equals + 1);
  if (key == "fov") {
    const auto degrees = number(value);
    if (!degrees) {
      return fail(ErrorCode::kSyntax, "camera, fov", quoted(value) + " is no number",
                  "write fov=35, in degrees");
    }
    view.fov = *degrees * kDegree;
    has_fov = true;
    if (!is_allowed_fov(view.fov)) return bad_fov();
    return {};
  }
  if (key != "eye" && key != "target" && key != "up") {
    return fail(ErrorCode::kUnknown, "camera", quoted(part) + " is no view and no part of one",
                kForms);
  }
  const auto place = triple(value);
  if (!place) {
    return fail(
        ErrorCode::kSyntax, "camera, " + std::string(key),
        quoted(value) + " is not three numbers within a million kilometres",
        "write " + std::string(key) + "=x,y,z, such as " + std::string(key) + "=100,-200,80 (mm)");
  }
  if (key == "eye") view.eye = place;
  if (key == "target") view.target = place;
  if (key == "up") view.up = place;
  return {};
}

Vector3d to_eigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
glm::dvec3 to_glm(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Least and largest of values that are added.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double middle() const { return 0.5 * (low + high); }
  double length() const { return high - low; }
};

struct Box {
  std::array<Range, 3> axes;
  Vector3d middle() const { return {axes[0].middle(), axes[1].middle(), axes[2].middle()}; }
  std::array<Vector3d, 8> corners() const {
    std::array<Vector3d, 8> out;
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = {(i & 1) != 0 ? axes[0].high : axes[0].low,
                (i & 2) != 0 ? axes[1].high : axes[1].low,
                (i & 4) != 0 ? axes[2].high : axes[2].low};
    }
    return out;
  }
  /// For a model that is one point, 1 mm.
  double size() const {
    const double diagonal = Vector3d(axes[0].length(), axes[1].length(), axes[2].length()).norm();
    return diagonal > 0 ? diagonal : 1;
  }
};

template <class Function>
void for_each(PointSets points, Function function) {
  for (const auto& set : points) std::for_each(set.begin(), set.end(), function);
}

Expected<Box> box_of(PointSets points) {
  Box box;
  bool is_finite = true;
  for_each(points, [&](const Vector3d& p) {
    for (int k = 0; k < 3; ++k) {
      is_finite &= std::abs(p[k]) <= kFarthestCoordinate;  // false for a NaN
      box.axes[static_cast<std::size_t>(k)].add(p[k]);
    }
  });
  if (!is_finite) {
    return fail(ErrorCode::kOutOfRange, "model",
                "a coordinate is not a number within a million kilometres",
                "mend the model: every coordinate has to be finite");
  }
  return box;
}

/// Axes of the camera's frame, by GLM's lookAt, with the origin in `eye`.
void stand(Camera& camera, const Vector3d& eye, const Vector3d& towards_eye, const Vector3d& up) {
  // From the direction alone: far from the origin the difference of eye and target would be coarse.
  const glm::dmat4 turned =
      glm::lookAt(glm::dvec3(0), to_glm(-towards_eye.normalized()), to_glm(up));
  camera.eye = eye;
  camera.to_camera = glm::translate(turned, to_glm(-eye));
  const glm::dmat4 axes = glm::transpose(turned);
  camera.right = to_eigen(glm::dvec3(axes[0]));
  camera.up = to_eigen(glm::dvec3(axes[1]));
  camera.back = to_eigen(glm::dvec3(axes[2]));
}

/// The least picture, half as high as is given back, that holds all points around the eye's line of
/// sight, after the eye has moved across it. Parallel.
double fit_parallel(Camera& camera, PointSets points, double least, double aspect) {
  Range x, y, z;
  for_each(points, [&](const Vector3d& p) {
    const Vector3d q = p - camera.eye;
    x.add(q.dot(camera.right));
    y.add(q.dot(camera.up));
    z.add(q.dot(camera.back));
  });
  const Vector3d eye = camera.eye + x.middle() * camera.right + y.middle() * camera.up +
                       (z.high + least) * camera.back;
  stand(camera, eye, camera.back, camera.up);
  return 0.5 * std::max({x.length() / aspect, y.length(), least});
}

/// Moves the eye to the nearest place from which all points are within the picture. With the slope
/// t of an edge of sight, x - x_eye <= t (z_eye - z) for all points holds from t z_eye >= max(x + t
/// z) - x_eye on, and so for the other three sides.
void fit_perspective(Camera& camera, PointSets points, double size, double aspect) {
  const double rise = camera.half_height * (1 - 2 * kMargin);
  const double run = rise * aspect;
  Range right, left, above, below, z;
  for_each(points, [&](const Vector3d& p) {
    const Vector3d q = p - camera.eye;
    const Vector3d c(q.dot(camera.right), q.dot(camera.up), q.dot(camera.back));
    right.add(c.x() + run * c.z());
    left.add(c.x() - run * c.z());
    above.add(c.y() + rise * c.z());
    below.add(c.y() - rise * c.z());
    z.add(c.z());
  });
  const double across = right.high - left.low;
  const double up = above.high - below.low;
  const double back = std::max({0.5 * across / run, 0.5 * up / rise, z.high + kStandOff * size});
  const Vector3d eye = camera.eye + 0.5 * (right.high + left.low) * camera.right +
                       0.5 * (above.high + below.low) * camera.up + back * camera.back;
  stand(camera, eye, camera.back, camera.up);
}

}  // namespace

glm::dmat4 Camera::to_raster(int width, int height) const {
  const double middle_x = 0.5 * width;
  const double middle_y = 0.5 * height;
  const double scale = middle_y / half_height;
  glm::dmat4 project(0);  // project[column][row]
  project[0][0] = scale;
  project[1][1] = -scale;
  if (is_perspective) {
    project[2][0] = -middle_x;
    project[2][1] = -middle_y;
    project[2][3] = -1;
    project[3][2] = near;
  } else {
    project[3][0] = middle_x;
    project[3][1] = middle_y;
    project[2][2] = 1 / (far - near);
    project[3][2] = far / (far - near);
    project[3][3] = 1;
  }
  return project * to_camera;
}

double Camera::nearness(double distance) const noexcept {
  return is_perspective ? near / distance : (far - distance) / (far - near);
}

double Camera::sample_size(double distance, int height) const noexcept {
  return 2 * half_height / height * (is_perspective ? distance : 1);
}

Expected<View> parse_view(std::string_view text) {
  View view;
  bool has_fov = false;
  const auto parts = split(text, ';');
  const auto* const named =
      std::find_if(std::begin(kNamedViews), std::end(kNamedViews),
                   [&](const NamedView& known) { return known.name == parts[0]; });
  const bool is_named = named != std::end(kNamedViews);
  if (is_named) {
    view.towards_eye = Vector3d(named->towards_eye.data());
    view.up = Vector3d(named->up.data());
  }
  std::vector<std::string_view> seen;
  for (std::size_t i = is_named ? 1 : 0; i < parts.size(); ++i) {
    const std::string_view key = parts[i].substr(0, parts[i].find('='));
    if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
      return fail(ErrorCode::kSyntax, "camera", quoted(key) + " is there twice", "give it once");
    }
    if (is_named && (key == "eye" || key == "target" || key == "up")) {
      return fail(ErrorCode::kSyntax, "camera",
                  quoted(parts[0]) + " already says where the camera is",
                  "leave out " + quoted(parts[i]) + ", or begin with eye=");
    }
    seen.push_back(key);
    if (auto read = read_part(parts[i], view, has_fov); !read) {
      return tl::unexpected(std::move(read.error()));
    }
  }
  if (is_named) return view;
  if (!view.eye) {
    return fail(ErrorCode::kMissing, "camera", "there is no eye", "add eye=x,y,z (mm)");
  }
  if (!has_fov) view.fov = kUsualFov;
  if (view.target && *view.eye == *view.target) return eye_at_target();
  return view;
}

Expected<Camera> place_camera(const View& view, PointSets points, int width, int height) {
  LIMN_EXPECT(width > 0 && height > 0);
  if (std::all_of(points.begin(), points.end(), [](const auto& set) { return set.empty(); })) {
    return fail(ErrorCode::kMissing, "model", "it is empty: there is nothing to show",
                "give a model with a face, a line or a point");
  }
  const auto box = box_of(points);
  if (!box) return tl::unexpected(box.error());
  if (!is_allowed_fov(view.fov)) return bad_fov();
  const Vector3d target = view.target.value_or(box->middle());
  const Vector3d towards_eye = view.eye ? Vector3d(*view.eye - target) : view.towards_eye;
  if (!towards_eye.allFinite() || towards_eye.isZero(0)) return eye_at_target();
  Vector3d up = view.up.value_or(Vector3d::UnitZ());
  if (!view.up && is_along(up, towards_eye)) up = Vector3d::UnitY();
  if (!up.allFinite() || up.isZero(0) || is_along(up, towards_eye)) return up_along_sight();

  Camera camera;
  camera.is_perspective = view.fov > 0;
  const double size = box->size();
  const double aspect = static_cast<double>(width) / height;
  stand(camera, view.eye && camera.is_perspective ? *view.eye : target, towards_eye, up);
  if (!camera.is_perspective) {
    camera.half_height =
        fit_parallel(camera, points, kDepthRoom * size, aspect) / (1 - 2 * kMargin);
  } else {
    camera.half_height = std::tan(0.5 * view.fov);
    if (!view.eye) fit_perspective(camera, points, size, aspect);
  }

  Range distance;
  for (const Vector3d& p : box->corners()) distance.add((camera.eye - p).dot(camera.back));
  const double room = kDepthRoom * std::max(distance.length(), size);
  camera.near = distance.low - room;
  camera.far = distance.high + room;
  if (!camera.is_perspective) return camera;
  if (distance.high <= 0) {
    return fail(ErrorCode::kOutOfRange, "camera", "all of the model is behind it",
                "turn it about: move eye or target");
  }
  camera.near = std::max(camera.near, kNearestPart * camera.far);
  return camera;
}

}  // namespace limn
