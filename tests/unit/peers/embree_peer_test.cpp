#include "tests/peers/embree_peer.hpp"

#include <gtest/gtest.h>

#include "tests/support/rng.hpp"
#include "tests/unit/peers/distance.hpp"

namespace limn::peers {
namespace {

constexpr int kCells = 100;

/// z = x^2 + y^2 over [-1, 1]^2; two triangles a cell.
PeerMesh paraboloid_mesh() {
  PeerMesh mesh;
  const auto place = [](int i) { return 2.0 * i / kCells - 1.0; };
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i)
      mesh.positions.insert(mesh.positions.end(),
                            {place(i), place(j), place(i) * place(i) + place(j) * place(j)});
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      const int corner = i + (kCells + 1) * j;
      const int above = corner + kCells + 1;
      mesh.triangles.insert(mesh.triangles.end(),
                            {corner, corner + 1, above, above, corner + 1, above + 1});
    }
  }
  return mesh;
}

TEST(EmbreePeer, HitsTheTriangleUnderARay) {
  // A chord of a cell's length, 0.02, lies 0.0001 above z = x^2, and the same for y.
  constexpr double kChord = 2e-4;
  constexpr double kSingle = 1e-5;  // single precision at numbers of about 3
  const PeerMesh mesh = paraboloid_mesh();
  const EmbreeMesh embree(mesh);
  test::Rng rng(0xe3b4ee);
  for (int k = 0; k < 200; ++k) {
    const double x = rng.uniform(-0.99, 0.99), y = rng.uniform(-0.99, 0.99);
    const PeerRay down = {{x, y, 3}, {0, 0, -2}};
    const auto hit = embree.first_hit(down);
    ASSERT_TRUE(hit.has_value()) << "ray " << k;
    EXPECT_NEAR(hit->t, (3 - x * x - y * y) / 2, kChord) << "ray " << k;
    PeerPoint met = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto corner = [&](int i) {
        const auto vertex = static_cast<std::size_t>(mesh.triangles[3 * hit->triangle + i]);
        return mesh.positions[3 * vertex + axis];
      };
      met[axis] = (1 - hit->a - hit->b) * corner(0) + hit->a * corner(1) + hit->b * corner(2);
    }
    EXPECT_LE(distance(met, along(down, hit->t)), kSingle) << "ray " << k;
  }
}

TEST(EmbreePeer, MissesWhatLiesBehindAndBeside) {
  const EmbreeMesh embree(paraboloid_mesh());
  EXPECT_FALSE(embree.first_hit({{0.1, 0.1, 3}, {0, 0, 1}}).has_value());
  EXPECT_FALSE(embree.first_hit({{1.1, 0.1, 3}, {0, 0, -1}}).has_value());
}

}  // namespace
}  // namespace limn::peers
