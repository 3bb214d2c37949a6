#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "modeler/view/pixel_image.hpp"
#include "modeler/view/raster/camera.hpp"
#include "modeler/view/raster/scene.hpp"
#include "modeler/view/raster/shading.hpp"

namespace limn {

struct ScenePictureOptions {
  static constexpr int kMostPixels = 8192;  ///< a side
  static constexpr int kMostSamples = 4;

  View view;
  int width = 1280;  ///< pixels, 1 to kMostPixels
  int height = 800;
  ShadingOptions shading;
  /// A pixel is the mean, in linear light, of this many samples a side: 1 to kMostSamples.
  int samples_per_side = 3;
  /// Rows of the picture are drawn by so many threads at once; the pixels do not depend on it.
  int threads = 1;
};

/// The picture of a scene, without a GPU: the same pixels on each run of a build, whatever the
/// number of threads. A camera inside the model shows it from there.
///
/// Memory: 4 bytes a pixel, 16 a vertex, and 8 MB or a row of samples a thread.
/// Errors: as place_camera() (an empty scene, a coordinate that is not finite, a camera that sees
/// nothing); kOutOfRange for a normal, a field's value or a width that is not finite, and for
/// options below their range; kLimit for those above it; kPointCount for a field that has not one
/// value a vertex. Precondition: triangles, vertices and faces of meshes are of ones that are
/// there.
Expected<PixelImage> picture_of(const Scene& scene, const ScenePictureOptions& options = {});

/// The same as the bytes of a PNG file. Errors: also those of encode_png().
Expected<std::string> scene_to_png(const Scene& scene, const ScenePictureOptions& options = {});

/// What the centre of a pixel shows.
struct SeenFace {
  std::uint32_t surface = 0;  ///< of Scene::surfaces
  std::uint32_t face = 0;     ///< of its mesh
  float nearness = 0;         ///< Camera::nearness
  friend bool operator==(const SeenFace&, const SeenFace&) = default;
};

/// Which faces a picture shows where, in rows from the top left; none for the background. Lines and
/// points are not drawn. Errors as picture_of().
Expected<std::vector<std::optional<SeenFace>>> faces_seen(const Scene& scene,
                                                          const ScenePictureOptions& options = {});

}  // namespace limn
