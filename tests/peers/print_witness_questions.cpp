// print_witness_questions SEED COUNT: random surfaces and three places on each, for rhino3dm.mjs.

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "tests/peers/random_surfaces.hpp"
#include "tests/peers/witness_table.hpp"

namespace limn::peers {

namespace {

double rounded(double x) { return std::round(1e3 * x) / 1e3; }

/// Small ones, for the table lies in the repository.
constexpr RandomSplines kSmall{.max_degree = 7, .max_interior_knots = 2, .decimals = 3};

WitnessedSurface question(test::Rng& rng) {
  WitnessedSurface out;
  out.surface = random_surface(rng, kSmall);
  const auto inside = [&](std::size_t d) {
    return rounded(rng.uniform(out.surface.low(d), out.surface.high(d)));
  };
  const auto at_knot = [&](std::size_t d) {
    const auto& knots = out.surface.knots[d];
    return knots[static_cast<std::size_t>(
        rng.integer(0, static_cast<std::int64_t>(knots.size()) - 1))];
  };
  out.places.resize(3);
  out.places[0].at = {inside(0), inside(1)};
  out.places[1].at = {inside(0), inside(1)};
  out.places[2].at = {at_knot(0), inside(1)};
  return out;
}

}  // namespace

}  // namespace limn::peers

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: print_witness_questions SEED COUNT\n";
    return 2;
  }
  limn::test::Rng rng(std::strtoull(argv[1], nullptr, 0));
  std::vector<limn::peers::WitnessedSurface> surfaces(std::strtoull(argv[2], nullptr, 0));
  for (auto& surface : surfaces) surface = limn::peers::question(rng);
  std::cout << limn::peers::witness_questions(surfaces);
  return 0;
}
