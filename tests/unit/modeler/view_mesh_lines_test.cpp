#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "modeler/surface/primitives.hpp"
#include "modeler/view/raster/mesh_lines.hpp"
#include "tests/support/grid_mesh.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;

/// Of sums of a hundred lengths of about 10 mm.
constexpr double kRounding = 1e-10;

double total_length(const Polylines& lines) {
  double sum = 0;
  for (const auto& line : lines) {
    for (std::size_t i = 1; i < line.size(); ++i) sum += (line[i] - line[i - 1]).norm();
  }
  return sum;
}

TEST(MeshLines, IsolinesAreWhereAParameterHasAValue) {
  const Mesh mesh = test::grid_mesh(make_plane(Frame(), 40, 30).value(), 8, 12);
  const Polylines lines = isolines(mesh, 3);
  int along_v = 0;
  for (const auto& line : lines) {
    ASSERT_EQ(line.size(), 2U);
    // u and v are mm from the origin here: quarters of 40, or of 30.
    const bool is_u = std::abs(line[0].x() - line[1].x()) < kRounding;
    const double level = is_u ? line[0].x() / 10 : line[0].y() / 7.5;
    EXPECT_NEAR(level, std::round(level), kRounding);
    EXPECT_GE(std::round(level), 1);
    EXPECT_LE(std::round(level), 3);
    along_v += is_u;
  }
  EXPECT_GT(along_v, 0);
  EXPECT_NEAR(total_length(lines), 3 * 30 + 3 * 40, kRounding);
}

TEST(MeshLines, AnIsolineAlongEdgesIsThereOnce) {
  // Level 20 of u is a column of vertices.
  const Mesh mesh = test::grid_mesh(make_plane(Frame(), 40, 30).value(), 3, 4);
  EXPECT_NEAR(total_length(isolines(mesh, 1)), 30 + 40, kRounding);
}

TEST(MeshLines, NoIsolinesAreNone) {
  const Mesh mesh = test::grid_mesh(make_plane(Frame(), 40, 30).value(), 3, 4);
  EXPECT_TRUE(isolines(mesh, 0).empty());
  EXPECT_TRUE(isolines(Mesh(), 5).empty());
}

TEST(MeshLines, BordersEndAFace) {
  const Mesh plane = test::grid_mesh(make_plane(Frame(), 40, 30).value(), 5, 4);
  EXPECT_EQ(face_borders(plane).size(), 2U * (4 + 3));
  EXPECT_NEAR(total_length(face_borders(plane)), 2 * (40 + 30), kRounding);
}

TEST(MeshLines, SeamsAndPolesAreNoBorders) {
  const Frame frame;
  EXPECT_TRUE(face_borders(test::grid_mesh(make_torus(frame, 20, 5).value(), 20, 12)).empty());
  EXPECT_TRUE(face_borders(test::grid_mesh(make_sphere(frame, 20).value(), 20, 12)).empty());
  const Mesh tube = test::grid_mesh(make_cylinder(frame, 5, 10).value(), 21, 3);
  EXPECT_EQ(face_borders(tube).size(), 2U * 20);
}

TEST(MeshLines, WhereTwoFacesMeetTheBorderIsThereOnce) {
  // Two triangles of a square, each a face.
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (const std::uint32_t point : {0, 1, 2, 0, 2, 3}) {
    mesh.vertices.push_back({point, Vector3d::UnitZ(), Eigen::Vector2d::Zero()});
  }
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  mesh.faces = {{0, 1}, {1, 1}};
  EXPECT_EQ(face_borders(mesh).size(), 5U);
  mesh.faces = {{0, 2}};
  EXPECT_EQ(face_borders(mesh).size(), 4U);
}

TEST(MeshLines, ControlNetHasRowsAndColumns) {
  const BsplineSurface torus = make_torus(Frame(), 20, 5).value();
  const std::size_t columns = torus.knots(0).basis_count();
  const std::size_t rows = torus.knots(1).basis_count();
  const Polylines net = control_net(torus);
  ASSERT_EQ(net.size(), columns + rows);
  EXPECT_EQ(net.front().size(), columns);
  EXPECT_EQ(net.back().size(), rows);
  EXPECT_EQ(control_points(torus).size(), columns * rows);
  EXPECT_EQ(net.front()[1], torus.control_points()[1]);
  EXPECT_EQ(net.back()[1], torus.control_points()[2 * columns - 1]);
}

}  // namespace
}  // namespace limn
