#pragma once

#include <Eigen/Core>
#include <optional>

namespace limn {

/// A point of a surface with its partial derivatives up to the second.
///
///     name   symbol  note
///     point  S       mm
///     du     S_u     mm a unit of u, and so on
struct SurfaceJet {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d du = Eigen::Vector3d::Zero();
  Eigen::Vector3d dv = Eigen::Vector3d::Zero();
  Eigen::Vector3d duu = Eigen::Vector3d::Zero();
  Eigen::Vector3d duv = Eigen::Vector3d::Zero();
  Eigen::Vector3d dvv = Eigen::Vector3d::Zero();
};

/// The jet at a distance of d in the parameters from what is known here: exact but for third
/// derivatives.
inline SurfaceJet expand(const SurfaceJet& jet, const Eigen::Vector2d& d) noexcept {
  SurfaceJet out = jet;
  out.du += jet.duu * d.x() + jet.duv * d.y();
  out.dv += jet.duv * d.x() + jet.dvv * d.y();
  out.point += (0.5 * d.x()) * (jet.du + out.du) + (0.5 * d.y()) * (jet.dv + out.dv);
  return out;
}

/// The first fundamental form, E du^2 + 2 F du dv + G dv^2: lengths and angles on the surface.
struct FirstForm {
  double e = 0;  ///< S_u . S_u
  double f = 0;  ///< S_u . S_v
  double g = 0;  ///< S_v . S_v

  /// E G - F^2, the square of the area element |S_u x S_v|.
  double determinant() const noexcept { return e * g - f * f; }
};

/// The second fundamental form, L du^2 + 2 M du dv + N dv^2: how the surface leaves its tangent
/// plane, to the side of the normal where positive.
struct SecondForm {
  double l = 0;  ///< S_uu . n
  double m = 0;  ///< S_uv . n
  double n = 0;  ///< S_vv . n
};

/// Curvatures in 1/mm, positive where the surface bends towards the normal.
struct SurfaceCurvature {
  double gaussian = 0;  ///< K = k_1 k_2
  double mean = 0;      ///< H = (k_1 + k_2) / 2
  double max = 0;       ///< principal, k_1 >= k_2
  double min = 0;
  /// Unit tangents in whose directions the surface bends by max and min; at an umbilic, where all
  /// directions do, any two that are perpendicular.
  Eigen::Vector3d max_direction = Eigen::Vector3d::Zero();
  Eigen::Vector3d min_direction = Eigen::Vector3d::Zero();
};

FirstForm first_form(const SurfaceJet& jet) noexcept;

/// The unit normal S_u x S_v / |S_u x S_v|; none where that vanishes (a pole, a degenerate edge).
std::optional<Eigen::Vector3d> normal(const SurfaceJet& jet) noexcept;

/// None where there is no normal.
std::optional<SecondForm> second_form(const SurfaceJet& jet) noexcept;

/// From the two forms. None where there is no normal. Source: M. do Carmo, Differential Geometry of
/// Curves and Surfaces, ch. 3.3 [doCarmo76].
std::optional<SurfaceCurvature> curvature(const SurfaceJet& jet) noexcept;

/// A point of a curve with its derivatives up to the third.
template <int kDimension>
struct CurveJet {
  using Point = Eigen::Matrix<double, kDimension, 1>;
  Point point = Point::Zero();
  Point d1 = Point::Zero();
  Point d2 = Point::Zero();
  Point d3 = Point::Zero();
};

/// |C' x C''| / |C'|^3 in 1/mm; signed in the plane, positive where the curve turns from x to y.
/// None where C' vanishes.
std::optional<double> curvature(const CurveJet<2>& jet) noexcept;
std::optional<double> curvature(const CurveJet<3>& jet) noexcept;

/// (C' x C'') . C''' / |C' x C''|^2 in 1/mm; none where C' x C'' vanishes.
std::optional<double> torsion(const CurveJet<3>& jet) noexcept;

}  // namespace limn
