// How the kernel's costs grow with the number of control points, from 13^2 to 1003^2 of them: an
// evaluation and an edit are to cost the same, a query to grow as a tree does.

#include <cmath>
#include <memory>
#include <string>
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

/// The jobs of one surface, and what they work on.
class Subject {
 public:
  explicit Subject(int side)
      : evaluator_(test::limn_surface(peers::wavy_sheet(side))),
        index_(evaluator_.surface()),
        places_(random_places(10'000, 0)),
        jets_(places_.size()),
        points_(points_beside(evaluator_, places_.size())),
        rays_(rays_through(evaluator_, places_.size())),
        edited_(evaluator_.surface()) {}

  std::size_t count() const { return places_.size(); }
  void evaluate() {
    evaluator_.jets(places_, jets_);
    keep(jets_.data());
  }
  void ask_closest() {
    for (const Eigen::Vector3d& p : points_) keep(index_.closest_point(p).distance);
  }
  void shoot() {
    for (const Ray& ray : rays_) keep(index_.first_hit(ray).has_value());
  }
  void edit() {
    const std::size_t middle = edited_.control_points().size() / 2;
    for (int i = 0; i < kEdits; ++i) {
      const BsplineSurface seen = edited_;  // a viewer's: the edit may not write in place
      keep(edited_.set_control_point(middle, {1, 2, 3}).has_value());
      keep(seen.data().count());
    }
  }
  static constexpr int kEdits = 100;

 private:
  SurfaceEvaluator evaluator_;
  SurfaceIndex index_;
  std::vector<Eigen::Vector2d> places_;
  std::vector<SurfaceJet> jets_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Ray> rays_;
  BsplineSurface edited_;
};

}  // namespace

Picture growth_area(const RowSink& sink) {
  std::vector<GrowthCurve> curves = {{"point, derivatives", {}, {}},
                                     {"closest point", {}, {}},
                                     {"first hit of a ray", {}, {}},
                                     {"edit of one point", {}, {}}};
  const std::vector<double> goals = {
      3,  // the caches hold the smallest surface
      std::log2(1000.0 * 1000.0) / std::log2(10.0 * 10.0),
      std::log2(1000.0 * 1000.0) / std::log2(10.0 * 10.0),
      2,
  };
  std::vector<std::unique_ptr<Subject>> subjects;
  for (const int side : kSides) subjects.push_back(std::make_unique<Subject>(side));
  using Work = void (Subject::*)();
  const Work works[] = {&Subject::evaluate, &Subject::ask_closest, &Subject::shoot, &Subject::edit};
  for (std::size_t k = 0; k < curves.size(); ++k) {
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      jobs.push_back({std::to_string(kSides[i]),
                      [&subject = *subjects[i], work = works[k]] { (subject.*work)(); }, kEffort});
    }
    const std::vector<double> seconds = measure(jobs);
    const std::size_t of_one = works[k] == &Subject::edit ? Subject::kEdits : subjects[0]->count();
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      curves[k].control_points.push_back(kSides[i] * kSides[i]);
      curves[k].cost.push_back(1e9 * seconds[i] / static_cast<double>(of_one));
      sink({"growth/" + curves[k].name + ", " + std::to_string(kSides[i]) + "^2",
            curves[k].cost.back(), "ns", std::nullopt, std::nullopt});
    }
    // An edit of 10^6 is set against one of 10^4: 13^2 points fit one page.
    const std::size_t first = works[k] == &Subject::edit ? 2 : 0;
    sink({"growth/" + curves[k].name + ", 1003^2 against " + std::to_string(kSides[first]) + "^2",
          curves[k].cost.back() / curves[k].cost[first], "times", std::nullopt, at_most(goals[k])});
  }
  return draw_growth(curves);
}

}  // namespace limn::bench
