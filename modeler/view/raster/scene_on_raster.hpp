#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <vector>

#include "modeler/view/raster/camera.hpp"
#include "modeler/view/raster/rasterizer.hpp"
#include "modeler/view/raster/scene.hpp"

namespace limn {

/// A part of a scene, and the primitives of the raster that are its own.
struct ScenePart {
  enum class Kind { kSurface, kLines, kPoints };
  Kind kind = Kind::kSurface;
  std::size_t index = 0;       ///< into the scene's list of that kind
  std::uint32_t first_id = 0;  ///< a surface's triangle t is first_id + t
  std::uint32_t end_id = 0;

  bool has(std::uint32_t id) const noexcept { return id >= first_id && id < end_id; }
};

/// A triangle as a sample sees it.
struct TrianglePlace {
  /// Of its corners, 0 to 1, 1 together; linear in the model, not on the raster.
  std::array<double, 3> weights;
  bool is_front = true;  ///< seen from outside
};

/// A scene with all its vertices on the raster of a camera: transformed once, drawn band by band.
/// Primitives are numbered through: the triangles of the surfaces in order, then one number a
/// SceneLines, then one a ScenePoints.
///
/// Borrows the scene. Threads: any number may draw and ask at once.
class SceneOnRaster {
 public:
  /// Lines are `samples_per_pixel` times as wide. Precondition: all triangles and vertices of the
  /// meshes are of ones that are there; fewer than 2^32 - 1 primitives.
  SceneOnRaster(const Scene& scene, const Camera& camera, int width, int height,
                int samples_per_pixel);

  /// Notes the rows that triangles lie in, so that a band costs what lies in it. Worth it from two
  /// bands on.
  void index_rows();

  void draw_surfaces(RasterBand& band) const;
  void draw_lines(RasterBand& band) const;  ///< and points

  /// Precondition: the number of a primitive.
  ScenePart part_of(std::uint32_t id) const noexcept;

  /// Where the centre of sample (x, y) lies in a triangle that covers it.
  TrianglePlace place_in(std::size_t surface, std::uint32_t triangle, int x, int y) const noexcept;

 private:
  struct Rows {
    std::int32_t top = 0;
    std::int32_t bottom = 0;  ///< both may be covered
  };
  struct Surface {
    const Mesh* mesh = nullptr;
    std::uint32_t first_id = 0;
    std::vector<RasterVertex> vertices;  ///< those of the mesh
    std::vector<Rows> blocks;            ///< of kBlock triangles; empty where rows are not indexed
  };
  struct Segment {
    LineOnRaster line;
    std::uint32_t id = 0;
  };
  static constexpr std::size_t kBlock = 256;

  /// How lines and points are drawn.
  struct Pen {
    double radius = 1;        ///< samples
    double lift_samples = 0;  ///< as if they were so much nearer
    bool in_front = false;
    std::uint32_t id = 0;
  };
  void add_segment(const glm::dvec4& from, const glm::dvec4& to, const Pen& pen);
  std::array<glm::dvec4, 3> corners_of(const Mesh& mesh, std::uint32_t triangle) const noexcept;
  void draw_clipped(const Surface& surface, std::uint32_t triangle, RasterBand& band) const;

  glm::dmat4 matrix_;
  bool is_perspective_;
  double sample_lift_;  ///< of nearness (a factor in perspective), for one sample's length
  std::vector<Surface> surfaces_;
  std::uint32_t first_lines_ = 0;  ///< number of the first SceneLines
  std::uint32_t first_points_ = 0;
  std::vector<Segment> segments_;
};

}  // namespace limn
