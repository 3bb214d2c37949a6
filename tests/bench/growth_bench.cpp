// How the kernel's costs grow with the number of control points, from 13^2 to 1003^2 of them: an
// evaluation and an edit are to cost the same, a query to grow as a tree does. On a stroke, where
// one question is near the one before, and anywhere, where hardly anything asked for is in a cache.

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "modeler/surface/surface_index.hpp"
#include "tests/bench/areas.hpp"
#include "tests/bench/growth_plot.hpp"
#include "tests/bench/measure.hpp"
#include "tests/bench/surface_questions.hpp"
#include "tests/peers/known_surfaces.hpp"
#include "tests/support/peer_conversion.hpp"

namespace limn::bench {
namespace {

constexpr int kSides[] = {13, 33, 103, 323, 1003};
constexpr Effort kEffort = {0.05, 5};
constexpr std::size_t kQuestions = 10'000;
constexpr std::size_t kEdits = 100;

/// Parameters along a stroke across the surface, as a pen's samples follow each other.
std::vector<Eigen::Vector2d> places_on_stroke(std::size_t count) {
  std::vector<Eigen::Vector2d> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(count);
    out.emplace_back(0.2 + 0.6 * x, 0.5 + 0.2 * std::sin(5 * x));
  }
  return out;
}

/// Places of a surface, and questions whose answers are near them.
struct Questions {
  Questions(const SurfaceEvaluator& evaluator, std::vector<Eigen::Vector2d> where,
            std::vector<Eigen::Vector3d> beside, std::vector<Ray> through)
      : surface(&evaluator),
        places(std::move(where)),
        points(std::move(beside)),
        rays(std::move(through)),
        jets(places.size()) {}

  void evaluate() {
    surface->jets(places, jets);
    keep(jets.data());
  }
  void ask_closest(const SurfaceIndex& index) const {
    for (const Eigen::Vector3d& p : points) keep(index.closest_point(p).distance);
  }
  void shoot(const SurfaceIndex& index) const {
    for (const Ray& ray : rays) keep(index.first_hit(ray).has_value());
  }

  const SurfaceEvaluator* surface;
  std::vector<Eigen::Vector2d> places;
  std::vector<Eigen::Vector3d> points;
  std::vector<Ray> rays;
  std::vector<SurfaceJet> jets;
};

/// The same questions as points and rays that follow each other.
Questions questions_on_stroke(const SurfaceEvaluator& evaluator) {
  std::vector<Eigen::Vector2d> places = places_on_stroke(kQuestions);
  std::vector<Eigen::Vector3d> points;
  std::vector<Ray> rays;
  for (const Eigen::Vector2d& at : places) {
    const SurfaceJet jet = evaluator.jet(at.x(), at.y());
    const Eigen::Vector3d eye(50, 50, 400);
    points.push_back(jet.point + 2 * *normal(jet));
    rays.push_back({eye, jet.point - eye});
  }
  return {evaluator, std::move(places), std::move(points), std::move(rays)};
}

/// One surface with what is asked of it.
struct Subject {
  explicit Subject(int side)
      : evaluator(test::limn_surface(peers::wavy_sheet(side))),
        index(evaluator.surface()),
        anywhere(evaluator, random_places(kQuestions, 0), points_beside(evaluator, kQuestions),
                 rays_through(evaluator, kQuestions)),
        on_stroke(questions_on_stroke(evaluator)),
        edited(evaluator.surface()) {}

  void edit() {
    const std::size_t middle = edited.control_points().size() / 2;
    for (std::size_t i = 0; i < kEdits; ++i) {
      const BsplineSurface seen = edited;  // a viewer's: the edit may not write in place
      keep(edited.set_control_point(middle, {1, 2, 3}).has_value());
      keep(seen.data().count());
    }
  }

  SurfaceEvaluator evaluator;
  SurfaceIndex index;
  Questions anywhere;
  Questions on_stroke;
  BsplineSurface edited;
};

struct Work {
  const char* name;
  std::size_t count;  ///< jobs a run
  double goal;        ///< cost on the largest surface against that on `from`
  std::size_t from;   ///< of kSides
  void (*run)(Subject&);
};

/// What costs the same, but for what is far apart in memory: nearly all is near on a stroke, and
/// anywhere only what the smallest surface has.
constexpr double kSame = 2;
constexpr double kSameAnywhere = 3;
const double kLogarithm = std::log2(1000.0 * 1000.0) / std::log2(10.0 * 10.0);
/// An edit of 10^6 is set against one of 10^4: 13^2 points fit one page.
constexpr std::size_t kOf103 = 2;

const Work kWorks[] = {
    {"jets on a stroke", kQuestions, kSame, 0, [](Subject& s) { s.on_stroke.evaluate(); }},
    {"closest points on a stroke", kQuestions, kLogarithm, 0,
     [](Subject& s) { s.on_stroke.ask_closest(s.index); }},
    {"first hits on a stroke", kQuestions, kLogarithm, 0,
     [](Subject& s) { s.on_stroke.shoot(s.index); }},
    {"jets anywhere", kQuestions, kSameAnywhere, 0, [](Subject& s) { s.anywhere.evaluate(); }},
    {"closest points anywhere", kQuestions, kLogarithm, 0,
     [](Subject& s) { s.anywhere.ask_closest(s.index); }},
    {"first hits anywhere", kQuestions, kLogarithm, 0,
     [](Subject& s) { s.anywhere.shoot(s.index); }},
    {"edit of one point", kEdits, kSame, kOf103, [](Subject& s) { s.edit(); }},
};

}  // namespace

Picture growth_area(const RowSink& sink) {
  std::vector<std::unique_ptr<Subject>> subjects;
  for (const int side : kSides) subjects.push_back(std::make_unique<Subject>(side));
  std::vector<GrowthCurve> curves;
  for (const Work& work : kWorks) {
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      jobs.push_back({std::to_string(kSides[i]),
                      [&subject = *subjects[i], &work] { work.run(subject); }, kEffort});
    }
    const std::vector<double> seconds = measure(jobs);
    GrowthCurve curve{work.name, {}, {}};
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      curve.control_points.push_back(kSides[i] * kSides[i]);
      curve.cost.push_back(1e9 * seconds[i] / static_cast<double>(work.count));
      sink({"growth/" + curve.name + ", " + std::to_string(kSides[i]) + "^2", curve.cost.back(),
            "ns", std::nullopt, std::nullopt});
    }
    sink({"growth/" + curve.name + ", 1003^2 against " + std::to_string(kSides[work.from]) + "^2",
          curve.cost.back() / curve.cost[work.from], "times", std::nullopt, at_most(work.goal)});
    curves.push_back(std::move(curve));
  }
  return draw_growth(curves);
}

}  // namespace limn::bench
