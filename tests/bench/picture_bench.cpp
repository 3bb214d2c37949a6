// Pictures without a GPU: a million shaded triangles, beside Mesa's llvmpipe.

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "modeler/surface/primitives.hpp"
#include "modeler/view/raster/picture_of.hpp"
#include "tests/bench/areas.hpp"
#include "tests/bench/measure.hpp"
#include "tests/peers/osmesa_peer.hpp"
#include "tests/support/grid_mesh.hpp"

namespace limn::bench {

namespace {

constexpr int kWidth = 1280;
constexpr int kHeight = 800;
/// 2 (n - 1)^2 triangles: 999,698.
constexpr int kSide = 708;

constexpr Effort kEffort = {0.2, 7};

#ifdef LIMN_PEER_OSMESA
Camera camera_of(const Scene& scene, const ScenePictureOptions& options) {
  const std::span<const Eigen::Vector3d> places[] = {scene.surfaces[0].mesh.points};
  return place_camera(options.view, places, kWidth, kHeight).value();
}

peers::PeerDrawing peer_drawing(const Mesh& mesh, const Camera& camera) {
  peers::PeerDrawing out;
  const auto add = [](std::vector<float>& to, const Eigen::Vector3d& v) {
    for (int k = 0; k < 3; ++k) to.push_back(static_cast<float>(v[k]));
  };
  for (const MeshVertex& vertex : mesh.vertices) {
    add(out.places, mesh.points[vertex.point]);
    const Eigen::Vector3d& n = vertex.normal;
    add(out.normals, {n.dot(camera.right), n.dot(camera.up), n.dot(camera.back)});
  }
  for (const auto& triangle : mesh.triangles) {
    out.corners.insert(out.corners.end(), triangle.begin(), triangle.end());
  }
  return out;
}

/// From the raster's (x, y, n, w) to OpenGL's clip coordinates: -w to w to the right, up and away.
std::array<float, 16> clip_matrix(const Camera& camera) {
  glm::dmat4 clip(1);  // clip[column][row]
  clip[0][0] = 2.0 / kWidth;
  clip[3][0] = -1;
  clip[1][1] = -2.0 / kHeight;
  clip[3][1] = 1;
  clip[2][2] = -2;
  clip[3][2] = 1;
  const glm::dmat4 matrix = clip * camera.to_raster(kWidth, kHeight);
  std::array<float, 16> out;
  for (int i = 0; i < 16; ++i) {
    out[static_cast<std::size_t>(i)] = static_cast<float>(matrix[i / 4][i % 4]);
  }
  return out;
}

/// Pixels that both show as model, of those that one does: 1 for the same outline.
double agreement(const std::vector<std::optional<SeenFace>>& seen,
                 const std::vector<std::uint32_t>& of_peer) {
  double both = 0;
  double either = 0;
  const std::uint32_t background = of_peer[0];
  for (std::size_t y = 0; y < kHeight; ++y) {
    for (std::size_t x = 0; x < kWidth; ++x) {
      const bool a = seen[y * kWidth + x].has_value();
      const bool b = of_peer[(kHeight - 1 - y) * kWidth + x] != background;
      both += a && b ? 1 : 0;
      either += a || b ? 1 : 0;
    }
  }
  return either > 0 ? both / either : 0;
}
#endif

}  // namespace

void picture_area(const RowSink& sink) {
  Scene scene;
  scene.surfaces.emplace_back();
  scene.surfaces[0].mesh = test::grid_mesh(make_torus(Frame(), 20, 8).value(), kSide, kSide);
  ScenePictureOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.samples_per_side = 1;
  const auto draw = [&] { keep(picture_of(scene, options)->pixels.data()); };
  std::vector<Job> jobs = {{"limn", draw, kEffort}};
  const std::string row = "picture/1M triangles shaded, 1280x800";
  constexpr double kMilliseconds = 1e3;

#ifdef LIMN_PEER_OSMESA
  const Camera camera = camera_of(scene, options);
  const std::array<float, 16> matrix = clip_matrix(camera);
  peers::OsmesaRenderer mesa(peer_drawing(scene.surfaces[0].mesh, camera), kWidth, kHeight);
  if (mesa.complaint().empty()) {
    jobs.push_back({"Mesa", [&] { mesa.draw(matrix); }, kEffort});
    const auto seconds = measure(jobs);
    sink({row, seconds[0] * kMilliseconds, "ms", Peer{seconds[1] * kMilliseconds, mesa.name()},
          at_least_ratio(2)});
    constexpr double kLeastAgreement = 0.999;  // rims are sampled alike but for the last bit
    sink({"picture/outline other than the peer's",
          1 - agreement(*faces_seen(scene, options), mesa.pixels()), "of the model", std::nullopt,
          at_most(1 - kLeastAgreement)});
  } else {
    std::fprintf(stderr, "limn-bench: %s\n", mesa.complaint().c_str());
    sink({row, measure(jobs)[0] * kMilliseconds, "ms", std::nullopt, std::nullopt});
  }
#else
  sink({row, measure(jobs)[0] * kMilliseconds, "ms", std::nullopt, std::nullopt});
#endif
  options.samples_per_side = 3;
  const auto fine = measure({{"limn", draw, kEffort}});
  sink({row + ", 3x3 samples", fine[0] * kMilliseconds, "ms", std::nullopt, std::nullopt});
}

}  // namespace limn::bench
