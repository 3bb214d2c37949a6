#include <Geom2dAPI_PointsToBSpline.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Standard_Failure.hxx>
#include <TColgp_Array1OfPnt2d.hxx>

#include "tests/bench/fit_peers.hpp"

namespace limn::bench {

int fit_with_occt(const SampledStroke& stroke, double tolerance_mm) {
  constexpr int kDegree = 3;
  try {
    TColgp_Array1OfPnt2d points(1, static_cast<int>(stroke.positions.size()));
    for (int i = points.Lower(); i <= points.Upper(); ++i) {
      const auto& p = stroke.positions[static_cast<std::size_t>(i - 1)];
      points.SetValue(i, gp_Pnt2d(p.x(), p.y()));
    }
    const Geom2dAPI_PointsToBSpline fit(points, kDegree, kDegree, GeomAbs_C2, tolerance_mm);
    return fit.IsDone() ? fit.Curve()->NbPoles() : 0;
  } catch (const Standard_Failure&) {
    return 0;
  }
}

}  // namespace limn::bench
