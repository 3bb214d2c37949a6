// The spline kernel: evaluation, closest points, rays and knot insertion, beside Open CASCADE, SISL
// and Embree on the same surface; accuracy and misses.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "modeler/bspline/curve_evaluator.hpp"
#include "modeler/bspline/refine.hpp"
#include "modeler/bspline/volume_evaluator.hpp"
#include "modeler/surface/surface_index.hpp"
#include "tests/bench/areas.hpp"
#include "tests/bench/measure.hpp"
#include "tests/bench/surface_questions.hpp"
#include "tests/peers/embree_peer.hpp"
#include "tests/peers/known_surfaces.hpp"
#include "tests/peers/occt_peer.hpp"
#include "tests/peers/sisl_peer.hpp"
#include "tests/support/peer_conversion.hpp"
#include "tests/support/rng.hpp"

namespace limn::bench {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using peers::PeerParameters;
using peers::PeerRay;
using peers::PeerSurface;
using test::limn_point;
using test::peer_point;

constexpr const char* kOcct = "Open CASCADE";
constexpr const char* kSisl = "SISL";
/// Beyond it some peers need seconds an answer.
constexpr int kMostForPeers = 103;
constexpr const char* kEmbree = "Embree on triangles, inexact";

std::string name_of(const std::string& job, int n) {
  return "kernel/" + job + ", " + std::to_string(n) + "^2";
}

/// A job of limn's and the same of its peers, each `count` times a run.
class Comparison {
 public:
  Comparison(std::string row, std::string unit, double per_second, std::size_t count)
      : row_(std::move(row)),
        unit_(std::move(unit)),
        factor_(per_second / static_cast<double>(count)) {}

  template <class Run>
  Comparison& limn(Run run, Effort effort = {0.05, 7}) {
    jobs_.insert(jobs_.begin(), {"limn", run, effort});
    goals_.insert(goals_.begin(), std::nullopt);
    parts_.insert(parts_.begin(), 1.0);
    return *this;
  }
  /// `part` of the count is run, for peers that take long.
  template <class Run>
  Comparison& peer(const char* name, std::optional<Goal> goal, Run run, Effort effort = {0.05, 5},
                   double part = 1) {
    jobs_.push_back({name, run, effort});
    goals_.push_back(goal);
    parts_.push_back(part);
    return *this;
  }
  /// One row a peer, or one without.
  void run(const RowSink& sink) const {
    const auto seconds = measure(jobs_);
    const double cost = seconds[0] * factor_;
    if (jobs_.size() == 1) sink({row_, cost, unit_, std::nullopt, std::nullopt});
    for (std::size_t i = 1; i < jobs_.size(); ++i) {
      sink({row_, cost, unit_, Peer{seconds[i] * factor_ / parts_[i], jobs_[i].name}, goals_[i]});
    }
  }

 private:
  std::string row_;
  std::string unit_;
  double factor_;
  std::vector<Job> jobs_;
  std::vector<std::optional<Goal>> goals_;
  std::vector<double> parts_;
};

/// A surface as each library has it.
struct Subject {
  explicit Subject(int count)
      : n(count),
        data(peers::wavy_sheet(count)),
        surface(test::limn_surface(data)),
        evaluator(surface)
#ifdef LIMN_PEER_OCCT
        ,
        occt(data)
#endif
#ifdef LIMN_PEER_SISL
        ,
        sisl(data)
#endif
  {
  }
  int n;
  PeerSurface data;
  BsplineSurface surface;
  SurfaceEvaluator evaluator;
#ifdef LIMN_PEER_OCCT
  peers::OcctSurface occt;
#endif
#ifdef LIMN_PEER_SISL
  peers::SislSurface sisl;
#endif
};

void random_points(const Subject& s, const RowSink& sink) {
  const auto at = random_places(100'000, 0);
  std::vector<SurfaceJet> jets(at.size());
  Comparison compare(name_of("point and second derivatives at random", s.n), "ns", 1e9, at.size());
  compare.limn([&] {
    s.evaluator.jets(at, jets);
    keep(jets.data());
  });
#ifdef LIMN_PEER_OCCT
  compare.peer(kOcct, at_least_ratio(5), [&] {
    for (const Vector2d& p : at) keep(s.occt.jet(p.x(), p.y()));
  });
#endif
#ifdef LIMN_PEER_SISL
  compare.peer(kSisl, at_least_ratio(5), [&] {
    for (const Vector2d& p : at) keep(s.sisl.jet(p.x(), p.y()));
  });
#endif
  compare.run(sink);
#ifdef LIMN_PEER_OCCT
  double worst = 0;
  for (std::size_t i = 0; i < at.size(); i += 10) {
    const auto jet = s.occt.jet(at[i].x(), at[i].y());
    worst = std::max(worst, (limn_point(jet.point) - jets[i].point).norm());
  }
  sink({name_of("point, largest distance from Open CASCADE's", s.n), worst, "mm", std::nullopt,
        at_most(1e-12 * 142)});  // of the bounding box's diagonal
#endif
}

void grid(const Subject& s, const RowSink& sink) {
  constexpr std::size_t kSide = 1000;
  std::vector<double> along(kSide);
  for (std::size_t i = 0; i < kSide; ++i) along[i] = static_cast<double>(i) / (kSide - 1);
  std::vector<SurfaceFrame> frames(kSide * kSide);
  Comparison compare(name_of("first derivatives and normal on a grid", s.n), "ns", 1e9,
                     frames.size());
  compare.limn([&] {
    s.evaluator.grid(along, along, frames);
    keep(frames.data());
  });
#ifdef LIMN_PEER_OCCT
  peers::PeerGrid of_occt;
  compare.peer(kOcct, at_least_ratio(5), [&] {
    s.occt.grid(along, along, of_occt);
    keep(of_occt.jets.data());
  });
#endif
#ifdef LIMN_PEER_SISL
  peers::PeerGrid of_sisl;
  compare.peer(kSisl, at_least_ratio(3), [&] {
    s.sisl.grid(along, along, of_sisl);
    keep(of_sisl.jets.data());
  });
#endif
  compare.run(sink);
}

void closest(const Subject& s, const SurfaceIndex& index, const RowSink& sink) {
  const auto points = points_beside(s.evaluator, 10'000);
  Comparison compare(name_of("closest point, global", s.n), "us", 1e6, points.size());
  compare.limn([&] {
    for (const Vector3d& p : points) keep(index.closest_point(p).distance);
  });
#ifdef LIMN_PEER_OCCT
  const std::size_t some = s.n > 50 ? 50 : 500;
  if (s.n <= kMostForPeers) {
    compare.peer(
        kOcct, at_least_ratio(s.n > 50 ? 1000 : 100),
        [&] {
          for (std::size_t i = 0; i < some; ++i) keep(s.occt.closest(peer_point(points[i])));
        },
        {0.05, 3}, static_cast<double>(some) / static_cast<double>(points.size()));
  }
#endif
#ifdef LIMN_PEER_SISL
  const std::size_t few = s.n > 50 ? 10 : 200;
  if (s.n <= kMostForPeers) {
    compare.peer(
        kSisl, std::nullopt,
        [&] {
          for (std::size_t i = 0; i < few; ++i) keep(s.sisl.closest(peer_point(points[i]), 1e-9));
        },
        {0.05, 3}, static_cast<double>(few) / static_cast<double>(points.size()));
  }
#endif
  compare.run(sink);
#ifdef LIMN_PEER_OCCT
  // A local search of Open CASCADE's from each of many places may do no better.
  int wrong = 0;
  double slack = 0;
  constexpr std::size_t kSide = 200;
  std::vector<double> along(kSide);
  for (std::size_t i = 0; i < kSide; ++i) along[i] = (static_cast<double>(i) + 0.5) / kSide;
  std::vector<SurfaceFrame> sampled(kSide * kSide);
  s.evaluator.grid(along, along, sampled);
  for (const Vector3d& p : points) {
    const ClosestPoint found = index.closest_point(p);
    slack = std::max(slack, found.slack);
    if (const auto other =
            s.occt.closest_near(peer_point(p), {found.parameter.x(), found.parameter.y()})) {
      const Vector3d at = s.evaluator.point(other->u, other->v);
      if ((at - p).norm() < found.distance - 1e-9) ++wrong;
    }
    double least = 1e300;
    for (const SurfaceFrame& frame : sampled)
      least = std::min(least, (frame.point - p).squaredNorm());
    if (std::sqrt(least) < found.distance - 1e-9) ++wrong;
  }
  sink({name_of("closest point, wrong of 10,000", s.n), static_cast<double>(wrong), "points",
        std::nullopt, at_most(0)});
  sink({name_of("closest point, largest distance left open", s.n), slack, "mm", std::nullopt,
        at_most(1.001e-9)});
#endif
}

#ifdef LIMN_PEER_EMBREE
/// Triangles as fine as the sheet's bends ask: 10 a span and direction, 400 a direction at most.
peers::EmbreeMesh embree_mesh(const Subject& s) {
  const int side = std::min(400, 10 * (s.n - 3)) + 1;
  std::vector<double> along;
  for (int i = 0; i < side; ++i) along.push_back(static_cast<double>(i) / (side - 1));
  std::vector<SurfaceFrame> frames(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  s.evaluator.grid(along, along, frames);
  peers::PeerMesh mesh;
  for (const SurfaceFrame& f : frames) {
    mesh.positions.insert(mesh.positions.end(), {f.point.x(), f.point.y(), f.point.z()});
  }
  for (int j = 0; j + 1 < side; ++j) {
    for (int i = 0; i + 1 < side; ++i) {
      const int a = i + side * j;
      mesh.triangles.insert(mesh.triangles.end(),
                            {a, a + 1, a + side + 1, a, a + side + 1, a + side});
    }
  }
  return peers::EmbreeMesh(mesh);
}
#endif

void rays(const Subject& s, const SurfaceIndex& index, const RowSink& sink) {
  const std::vector<Ray> all = rays_through(s.evaluator, 10'000);
  std::vector<PeerRay> same;
  for (const Ray& ray : all) same.push_back({peer_point(ray.origin), peer_point(ray.direction)});
  Comparison compare(name_of("first hit of a ray", s.n), "us", 1e6, all.size());
  compare.limn([&] {
    for (const Ray& ray : all) keep(index.first_hit(ray).has_value());
  });
#ifdef LIMN_PEER_OCCT
  const std::size_t some = 500;
  if (s.n <= kMostForPeers) {
    compare.peer(
        kOcct, at_least_ratio(100),
        [&] {
          for (std::size_t i = 0; i < some; ++i) keep(s.occt.first_hit(same[i]));
        },
        {0.05, 3}, static_cast<double>(some) / static_cast<double>(all.size()));
  }
#endif
#ifdef LIMN_PEER_SISL
  const std::size_t few = 20;
  if (s.n <= kMostForPeers) {
    compare.peer(
        kSisl, std::nullopt,
        [&] {
          for (std::size_t i = 0; i < few; ++i) keep(s.sisl.first_hit(same[i], 1e-9));
        },
        {0.05, 3}, static_cast<double>(few) / static_cast<double>(all.size()));
  }
#endif
#ifdef LIMN_PEER_EMBREE
  const peers::EmbreeMesh mesh = embree_mesh(s);
  compare.peer(kEmbree, at_least_ratio(1.0 / 8), [&] {
    for (const PeerRay& ray : same) keep(mesh.first_hit(ray));
  });
#endif
  compare.run(sink);
  // Each ray goes through a point of the sheet: at t = 1 at the latest it has hit.
  int missed = 0;
  double off = 0;
  for (const Ray& ray : all) {
    const auto hit = index.first_hit(ray);
    if (!hit || hit->t > 1 + 1e-9) ++missed;
    if (hit) off = std::max(off, (ray.origin + hit->t * ray.direction - hit->point).norm());
  }
  sink({name_of("first hit, missed of 10,000", s.n), static_cast<double>(missed), "rays",
        std::nullopt, at_most(0)});
  sink({name_of("first hit, largest distance from the ray", s.n), off, "mm", std::nullopt,
        at_most(1e-9)});
}

void insertion(const Subject& s, const RowSink& sink) {
  std::vector<double> added(100);
  for (std::size_t i = 0; i < added.size(); ++i) {
    added[i] = (static_cast<double>(i) + 0.37) / static_cast<double>(added.size());
  }
  Comparison compare(name_of("100 + 100 knots inserted", s.n), "ms", 1e3, 1);
  compare.limn([&] { keep(insert_knots(s.surface, {added, added}).has_value()); });
#ifdef LIMN_PEER_OCCT
  compare.peer(kOcct, at_least_ratio(10), [&] { keep(s.occt.with_knots(added, added)); });
#endif
#ifdef LIMN_PEER_SISL
  compare.peer(kSisl, at_least_ratio(5), [&] { keep(s.sisl.with_knots(added, added)); });
#endif
  compare.run(sink);
}

/// Uniform cubic knots over [0, 1].
KnotVector cubic_knots(int count) {
  std::vector<double> interior;
  for (int i = 1; i < count - 3; ++i) interior.push_back(static_cast<double>(i) / (count - 3));
  return *KnotVector::make_clamped(3, 0, 1, interior);
}

/// Curves and volumes, prepared against the recursion: the peers here are of surfaces.
void curves_and_volumes(const RowSink& sink) {
  constexpr const char* kRecursion = "limn's own recursion";
  constexpr std::size_t kPlaces = 100'000;
  test::Rng rng(11);
  const auto anywhere = [&rng] {
    return Vector3d(rng.uniform(0, 1), rng.uniform(0, 1), rng.uniform(0, 1));
  };
  const KnotVector along = cubic_knots(103);
  std::vector<Vector3d> points(103);
  for (Vector3d& p : points) p = 100 * anywhere();
  const CurveEvaluator<3> curve(*BsplineCurve<3>::make(along, points));
  std::vector<double> us(kPlaces);
  for (double& u : us) u = rng.uniform(0, 1);
  std::vector<CurveJet<3>> curve_jets(kPlaces);
  Comparison("kernel/point and three derivatives of a curve, 103", "ns", 1e9, kPlaces)
      .limn([&] {
        curve.jets(us, curve_jets);
        keep(curve_jets.data());
      })
      .peer(kRecursion, at_least_ratio(3),
            [&] {
              std::array<Vector3d, 4> d;
              for (const double u : us) {
                curve.curve().derivatives(u, d);
                keep(d[0]);
              }
            })
      .run(sink);

  const KnotVector side = cubic_knots(10);
  points.resize(1000);
  for (Vector3d& p : points) p = 100 * anywhere();
  const VolumeEvaluator volume(*BsplineVolume::make({side, side, side}, points));
  std::vector<Vector3d> at(kPlaces);
  for (Vector3d& p : at) p = anywhere();
  std::vector<VolumeJet> jets(kPlaces);
  Comparison("kernel/point and tangents of a volume, 10^3", "ns", 1e9, kPlaces)
      .limn([&] {
        volume.jets(at, jets);
        keep(jets.data());
      })
      .peer(kRecursion, at_least_ratio(3),
            [&] {
              std::array<Vector3d, 8> d;
              for (const Vector3d& p : at) {
                volume.volume().derivatives({p.x(), p.y(), p.z()}, {1, 1, 1}, d);
                keep(d[0]);
              }
            })
      .run(sink);
}

}  // namespace

void kernel_area(const RowSink& sink) {
  curves_and_volumes(sink);
  for (const int n : {13, 103, 1003}) {
    const Subject subject(n);
    if (n == 103) {
      random_points(subject, sink);
      grid(subject, sink);
      insertion(subject, sink);
    }
    const SurfaceIndex index(subject.surface);
    closest(subject, index, sink);
    rays(subject, index, sink);
  }
}

}  // namespace limn::bench
