#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "modeler/fit/banded_system.hpp"
#include "tests/support/for_all.hpp"

namespace limn::fit_detail {
namespace {

/// A diagonally dominant system with full blocks where the band, or its cyclic continuation, is.
template <int kBlock, int kRight>
void agrees_with_dense(test::Rng& rng, int blocks, bool cyclic) {
  const int size = blocks * kBlock;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd right(size, kRight);
  BandedSystem<kBlock, kRight> system;
  system.reset(blocks, cyclic);
  for (int r = 0; r < size; ++r) {
    for (int q = 0; q < kRight; ++q) system.right(r, q) = right(r, q) = rng.uniform(-1, 1);
    for (int c = 0; c <= r; ++c) {
      const int apart = std::abs(r / kBlock - c / kBlock);
      const bool coupled = apart <= 3 || (cyclic && blocks - apart <= 3);
      if (!coupled) continue;
      const double value = r == c ? 8.0 * kBlock : rng.uniform(-1, 1);
      system.at(r, c) = value;
      dense(r, c) = dense(c, r) = value;
    }
  }
  ASSERT_TRUE(system.solve());
  const Eigen::MatrixXd expected = dense.ldlt().solve(right);
  constexpr double kTolerance = 1e-13;  // well-conditioned: a few roundings of numbers below 1
  for (int r = 0; r < size; ++r) {
    for (int q = 0; q < kRight; ++q) EXPECT_NEAR(system.right(r, q), expected(r, q), kTolerance);
  }
}

TEST(BandedSystem, AgreesWithADenseSolver) {
  test::for_all(20, [](test::Rng& rng) {
    for (const int blocks : {1, 2, 4, 5, 6, 7, 9, 30}) {
      agrees_with_dense<1, 2>(rng, blocks, false);
      agrees_with_dense<2, 1>(rng, blocks, false);
      agrees_with_dense<3, 1>(rng, blocks, false);
    }
  });
}

TEST(BandedSystem, AgreesWithADenseSolverWhereItRunsRound) {
  test::for_all(20, [](test::Rng& rng) {
    for (const int blocks : {4, 5, 6, 7, 8, 9, 30}) {
      agrees_with_dense<1, 2>(rng, blocks, true);
      agrees_with_dense<2, 1>(rng, blocks, true);
    }
  });
}

TEST(BandedSystem, RefusesWhatIsNotPositiveDefinite) {
  BandedSystem<1, 1> system;
  system.reset(2, false);
  system.at(0, 0) = 1;
  system.at(1, 0) = 2;
  system.at(1, 1) = 1;
  EXPECT_FALSE(system.solve());
  system.reset(5, true);
  EXPECT_FALSE(system.solve());
}

}  // namespace
}  // namespace limn::fit_detail
