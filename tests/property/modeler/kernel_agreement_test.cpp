// limn's evaluation against Open CASCADE, SISL and openNURBS' recorded answers.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "modeler/bspline/jet.hpp"
#include "modeler/bspline/surface_evaluator.hpp"
#include "tests/peers/occt_peer.hpp"
#include "tests/peers/random_surfaces.hpp"
#include "tests/peers/sisl_peer.hpp"
#include "tests/peers/witness_table.hpp"
#include "tests/support/peer_conversion.hpp"
#include "tests/support/rng.hpp"
#include "tests/unit/peers/distance.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;
using peers::PeerJet;
using peers::PeerParameters;
using peers::PeerPoint;
using peers::PeerSurface;
using test::limn_point;

constexpr double kPosition = 1e-12;   // of the bounding box
constexpr double kDerivative = 1e-9;  // relative

/// How far two answers are apart, over a surface.
class Deviation {
 public:
  void add(const Vector3d& a, const Vector3d& b) {
    length_ = std::max({length_, a.norm(), b.norm()});
    greatest_ = std::max(greatest_, (a - b).norm());
  }
  double greatest() const { return greatest_; }
  /// Of the greatest length on the surface. One that is zero throughout is rounding of what
  /// cancels.
  double relative() const { return length_ > kDerivative ? greatest_ / length_ : 0.0; }

 private:
  double length_ = 0;
  double greatest_ = 0;
};

struct JetDeviation {
  void add(const SurfaceJet& a, const PeerJet& b) {
    of[0].add(a.point, limn_point(b.point));
    of[1].add(a.du, limn_point(b.du));
    of[2].add(a.dv, limn_point(b.dv));
    of[3].add(a.duu, limn_point(b.duu));
    of[4].add(a.duv, limn_point(b.duv));
    of[5].add(a.dvv, limn_point(b.dvv));
  }
  void expect_small(double box) const {
    EXPECT_LE(of[0].greatest(), kPosition * box);
    for (std::size_t i = 1; i < of.size(); ++i) EXPECT_LE(of[i].relative(), kDerivative) << i;
  }
  std::array<Deviation, 6> of;
};

SurfaceJet by_recursion(const BsplineSurface& surface, double u, double v) {
  std::array<Vector3d, 9> d;
  surface.derivatives({u, v}, {2, 2}, d);
  return {d[0], d[1], d[3], d[2], d[4], d[6]};
}

/// Inside, and at a knot of each direction.
std::vector<PeerParameters> some_places(test::Rng& rng, const PeerSurface& s) {
  std::vector<PeerParameters> out;
  for (int i = 0; i < 2; ++i) {
    out.push_back({rng.uniform(s.low(0), s.high(0)), rng.uniform(s.low(1), s.high(1))});
  }
  const auto at_knot = [&](std::size_t d) {
    return s.knots[d][static_cast<std::size_t>(rng.integer(0, std::ssize(s.knots[d]) - 1))];
  };
  out.push_back({at_knot(0), at_knot(1)});
  return out;
}

#if defined(LIMN_PEER_OCCT) && defined(LIMN_PEER_SISL)
TEST(KernelAgrees, WithOpenCascadeAndSislOnRandomSurfaces) {
  constexpr int kSurfaces = 10'000;
  test::Rng rng(0x6eed);
  for (int k = 0; k < kSurfaces; ++k) {
    SCOPED_TRACE("surface " + std::to_string(k));
    const PeerSurface data = peers::random_surface(rng);
    const BsplineSurface surface = test::limn_surface(data);
    const SurfaceEvaluator prepared(surface);
    const peers::OcctSurface occt(data);
    const peers::SislSurface sisl(data);
    JetDeviation from_occt;
    JetDeviation from_sisl;
    JetDeviation prepared_from_occt;
    for (const auto& [u, v] : some_places(rng, data)) {
      const SurfaceJet jet = by_recursion(surface, u, v);
      const PeerJet of_occt = occt.jet(u, v);
      from_occt.add(jet, of_occt);
      from_sisl.add(jet, sisl.jet(u, v));
      prepared_from_occt.add(prepared.jet(u, v), of_occt);
    }
    const double box = peers::box_diagonal(data);
    from_occt.expect_small(box);
    from_sisl.expect_small(box);
    prepared_from_occt.expect_small(box);
    if (testing::Test::HasFailure()) return;
  }
}
#endif

#ifdef LIMN_PEER_OCCT
TEST(KernelAgrees, WithOpenCascadeOnHigherDerivatives) {
  test::Rng rng(0x6eee);
  for (int k = 0; k < 300; ++k) {
    const PeerSurface data = peers::random_surface(rng);
    const BsplineSurface surface = test::limn_surface(data);
    const peers::OcctSurface occt(data);
    std::array<Deviation, 16> of;
    for (const auto& [u, v] : some_places(rng, data)) {
      std::array<Vector3d, 16> d;
      surface.derivatives({u, v}, {3, 3}, d);
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
          if (i + j > 0) of[i + 4 * j].add(d[i + 4 * j], limn_point(occt.derivative(u, v, i, j)));
        }
      }
    }
    for (int i = 1; i < 16; ++i)
      EXPECT_LE(of[i].relative(), kDerivative) << "surface " << k << " " << i;
  }
}
#endif

TEST(KernelAgrees, WithOpenNurbsRecordedAnswers) {
  const auto table =
      peers::read_witness_table(LIMN_SOURCE_DIR "/tests/golden/kernel/rhino3dm.json");
  ASSERT_EQ(table.size(), 200U);
  for (const auto& row : table) {
    const BsplineSurface surface = test::limn_surface(row.surface);
    std::array<Deviation, 8> of;
    for (const auto& place : row.places) {
      std::array<Vector3d, 4> u;
      std::array<Vector3d, 4> v;
      surface.derivatives({place.at.u, place.at.v}, {3, 0}, u);
      surface.derivatives({place.at.u, place.at.v}, {0, 3}, v);
      of[0].add(u[0], limn_point(place.point));
      for (std::size_t i = 0; i < 3; ++i) {
        of[1 + i].add(u[i + 1], limn_point(place.u_derivatives[i]));
        of[4 + i].add(v[i + 1], limn_point(place.v_derivatives[i]));
      }
      const auto n = normal({u[0], u[1], v[1], {}, {}, {}});
      if (n) of[7].add(*n, limn_point(place.normal));
    }
    EXPECT_LE(of[0].greatest(), kPosition * peers::box_diagonal(row.surface));
    for (std::size_t i = 1; i < 8; ++i) EXPECT_LE(of[i].relative(), kDerivative) << i;
  }
}

}  // namespace
}  // namespace limn
