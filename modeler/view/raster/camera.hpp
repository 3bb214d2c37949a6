#pragma once

#include <Eigen/Core>
#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "input/base/error.hpp"

namespace limn {

/// From where a picture is taken. Right-handed, z up, mm.
///
/// Without `eye` the camera stands in direction `towards_eye`, as near as shows the whole model
/// and leaves a tenth of its size between;
/// with it, it stands there and looks at `target` (the middle of the model where that is not
/// given).
struct View {
  Eigen::Vector3d towards_eye = {1, -1, 1};  ///< from the model to the eye, of any length above 0
  std::optional<Eigen::Vector3d> up;         ///< without it z, or y for a look along z
  std::optional<Eigen::Vector3d> eye;
  std::optional<Eigen::Vector3d> target;
  /// Angle of view from the lower to the upper edge of the picture, rad, below pi; 0: a parallel
  /// projection, which shows the whole model wherever the eye is.
  double fov = 0;
};

/// A view as users write it: a name, or parts that a semicolon separates.
///
///     iso                               from the front, the right and above at equal angles
///     front, back, left, right          from that side; front looks along +y
///     top, bottom                       along -z and +z, x to the right
///     NAME;fov=DEG                      the same in perspective
///     eye=x,y,z;target=x,y,z;up=x,y,z;fov=DEG    mm; all but eye may be left out
///
/// fov is 35 degrees where an eye is given without it; 0, or from 1 to 170. Errors: kUnknown for
/// another name; kSyntax for a part that is twice there or is not written so; kMissing for parts
/// without an eye; kOutOfRange for an angle that is not allowed, an eye at its target, or `up`
/// along the line of sight.
Expected<View> parse_view(std::string_view text);

/// A camera that stands somewhere. In its own frame x points to the right, y up and z towards the
/// viewer: it looks along -z.
struct Camera {
  bool is_perspective = false;
  glm::dmat4 to_camera = glm::dmat4(1);           ///< from the model's frame, mm
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< origin of the camera's frame
  /// Axes of the camera's frame in the model's, unit.
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  Eigen::Vector3d back = Eigen::Vector3d::UnitZ();
  /// From the middle of the picture to its upper edge: mm, or the tangent of the angle.
  double half_height = 1;
  /// Distances along -z between which all of the model is that can be seen; near is above 0 in
  /// perspective.
  double near = 1;
  double far = 2;

  /// To a raster of width x height samples, in homogeneous coordinates (x, y, n, w):
  ///
  ///     x / w   samples from the left edge
  ///     y / w   samples from the top edge, downwards
  ///     n / w   nearness, linear on the raster for planes: 1 at `near`; at `far` 0 (parallel), or
  ///             near / far (perspective, where it is near / distance)
  ///     w       distance along -z in perspective, else 1
  glm::dmat4 to_raster(int width, int height) const;

  /// Nearness as above of what is `distance` along -z from the eye. Precondition: in perspective
  /// distance > 0.
  double nearness(double distance) const noexcept;

  /// How long one sample is in the model at that distance, for a raster of `height` samples.
  double sample_size(double distance, int height) const noexcept;
};

/// Beyond this a coordinate is no model's, mm.
inline constexpr double kFarthestCoordinate = 1e12;

/// Places of a model, in as many pieces as it keeps them.
using PointSets = std::span<const std::span<const Eigen::Vector3d>>;

/// The camera of `view` for a picture of width x height that shows `points`: all of them, with a
/// margin of a twentieth on each side, unless the view gives an eye and an angle. It may stand
/// inside the model. O(points). Errors: kMissing without points; kOutOfRange for a coordinate that
/// is not finite or above kFarthestCoordinate, for a view as in parse_view(), and where all points
/// are behind the camera. Precondition: width and height above 0.
Expected<Camera> place_camera(const View& view, PointSets points, int width, int height);

}  // namespace limn
