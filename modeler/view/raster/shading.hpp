#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "modeler/view/raster/camera.hpp"
#include "modeler/view/raster/rasterizer.hpp"
#include "modeler/view/raster/scene.hpp"
#include "modeler/view/raster/scene_on_raster.hpp"
#include "modeler/view/raster/tone.hpp"

namespace limn {

enum class Shading {
  kSmooth,     ///< two lights and the sky, fixed to the camera; inside in the back's colour
  kZebra,      ///< stripes of light around the model, mirrored: they break where normals do
  kCurvature,  ///< SceneSurface::field in diverging colours; smooth where a surface has none
};

struct ShadingOptions {
  Shading shading = Shading::kSmooth;
  int zebra_stripes = 14;  ///< dark ones, from the left of the model to its right
  /// What field has the strongest colours; 0: what most_of() says.
  double field_scale = 0;
};

/// The magnitude that 95 of 100 values of the scene's fields do not exceed, so that poles and edges
/// do not take all the colours; 0 without fields. Of vertices, not of areas.
double most_of(const std::vector<SceneSurface>& surfaces);

/// Gives each sample of a raster its tone. Borrows all that it is made from.
/// Threads: any number may use one.
class Shader {
 public:
  /// `width` and `height` in samples. Precondition: a field has one value a vertex, or none.
  Shader(const Scene& scene, const SceneOnRaster& raster, const Camera& camera, int width,
         int height, const ShadingOptions& options);

  /// tones[i] += the mean of samples [i k, (i + 1) k) of row y, divided by k: k rows added make a
  /// pixel of k x k samples. Precondition: tones.size() * k == keys.size().
  void add_row(std::span<const std::uint64_t> keys, int y, int k, std::span<Tone> tones) const;

 private:
  struct Surface {
    const SceneSurface* shown = nullptr;
    Tone front;
    Tone back;
  };
  // Unit vectors in the model's frame: normals then need no turning.
  struct Sight {
    Eigen::Vector3f towards_eye;
    Eigen::Vector3f half;  ///< between that and the key light: the normal that glosses most
  };
  struct Lights {
    Eigen::Vector3f key, fill, up, right;
  };
  Tone tone_of_surface(const ScenePart& part, std::uint32_t triangle, int x, int y) const noexcept;
  Tone background(int y) const noexcept;
  Sight sight_at(int x, int y) const noexcept;
  Sight sight_along(const Eigen::Vector3d& towards_eye) const noexcept;
  float matt_light(const Eigen::Vector3f& n) const noexcept;

  const SceneOnRaster& raster_;
  const Camera& camera_;
  int width_;
  int height_;
  ShadingOptions options_;
  Lights lights_;
  Sight sight_;  ///< of all samples in a parallel projection
  std::vector<Surface> surfaces_;
  std::vector<Tone> lines_;
  std::vector<Tone> points_;
  std::vector<Tone> scale_;  ///< diverging colours, from -1 to 1
  double per_field_ = 0;     ///< 1 / the field of the strongest colour
};

}  // namespace limn
