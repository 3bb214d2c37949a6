#include "modeler/view/raster/picture_of.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <system_error>
#include <thread>

#include "modeler/view/raster/scene_on_raster.hpp"

namespace limn {
namespace {

using Eigen::Vector3d;

/// 8 MB of keys a thread.
constexpr int kBandSamples = 1 << 20;
/// Bands a thread, so that all end about the same time.
constexpr int kBandsPerThread = 4;
constexpr int kMostThreads = 256;
constexpr double kWidestLine = 1000;  // pixels

Expected<void> check_range(const char* name, int value, int most) {
  const std::string bounds = "1 to " + std::to_string(most);
  if (value < 1) {
    return fail(ErrorCode::kOutOfRange, name, std::to_string(value) + " is too few",
                "give " + bounds);
  }
  if (value > most) {
    return fail(ErrorCode::kLimit, name, std::to_string(value) + " is more than limn draws",
                "give " + bounds);
  }
  return {};
}

Expected<void> check_options(const ScenePictureOptions& options) {
  constexpr int kMostPixels = ScenePictureOptions::kMostPixels;
  if (auto checked = check_range("width", options.width, kMostPixels); !checked) return checked;
  if (auto checked = check_range("height", options.height, kMostPixels); !checked) return checked;
  if (auto checked = check_range("samples per side", options.samples_per_side,
                                 ScenePictureOptions::kMostSamples);
      !checked) {
    return checked;
  }
  constexpr int kMostStripes = 1000;
  if (auto checked = check_range("zebra stripes", options.shading.zebra_stripes, kMostStripes);
      !checked) {
    return checked;
  }
  if (!std::isfinite(options.shading.field_scale) || options.shading.field_scale < 0) {
    return fail(ErrorCode::kOutOfRange, "field scale", "it is not a number from 0 up",
                "give 0 to have it chosen");
  }
  return check_range("threads", options.threads, kMostThreads);
}

Expected<void> check_width(const char* name, double width) {
  if (width > 0 && width <= kWidestLine) return {};
  return fail(ErrorCode::kOutOfRange, name, "a width is not above 0, or above 1000 pixels",
              "give the width in pixels");
}

Expected<void> check_scene(const Scene& scene) {
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const SceneSurface& surface = scene.surfaces[i];
    const auto& vertices = surface.mesh.vertices;
    const std::string at = "surface " + std::to_string(i);
    if (!std::all_of(vertices.begin(), vertices.end(),
                     [](const MeshVertex& vertex) { return vertex.normal.allFinite(); })) {
      return fail(ErrorCode::kOutOfRange, at, "a normal is not finite",
                  "mend the mesh: a normal is a unit vector, or zero where there is none");
    }
    if (!surface.field.empty() && surface.field.size() != vertices.size()) {
      return fail(ErrorCode::kPointCount, at,
                  std::to_string(surface.field.size()) + " values are given for " +
                      std::to_string(vertices.size()) + " vertices",
                  "give one value a vertex, or none");
    }
    if (!std::all_of(surface.field.begin(), surface.field.end(),
                     [](double value) { return std::isfinite(value); })) {
      return fail(ErrorCode::kOutOfRange, at, "a value of its field is not finite",
                  "give 0 where a curvature has no value");
    }
  }
  for (const SceneLines& lines : scene.lines) {
    if (auto checked = check_width("lines", lines.width); !checked) return checked;
  }
  for (const ScenePoints& points : scene.points) {
    if (auto checked = check_width("points", points.width); !checked) return checked;
  }
  return {};
}

Expected<Camera> camera_of(const Scene& scene, const ScenePictureOptions& options) {
  if (auto checked = check_options(options); !checked) return tl::unexpected(checked.error());
  if (auto checked = check_scene(scene); !checked) return tl::unexpected(checked.error());
  std::vector<std::span<const Vector3d>> places;
  for (const SceneSurface& surface : scene.surfaces) places.emplace_back(surface.mesh.points);
  for (const SceneLines& lines : scene.lines) {
    for (const auto& line : lines.lines) places.emplace_back(line);
  }
  for (const ScenePoints& points : scene.points) places.emplace_back(points.points);
  return place_camera(options.view, places, options.width, options.height);
}

/// Rows of pixels that are drawn together.
int rows_per_band(const ScenePictureOptions& options) {
  const int samples_per_row = options.width * options.samples_per_side * options.samples_per_side;
  const int by_memory = std::max(kBandSamples / samples_per_row, 1);
  if (options.threads == 1) return std::min(by_memory, options.height);
  const int shares = options.threads * kBandsPerThread;
  return std::min(by_memory, (options.height + shares - 1) / shares);
}

/// Draws and shades rows of pixels [first, first + count).
void draw_rows(const SceneOnRaster& raster, const Shader& shader, RasterBand& band, int first,
               int count, int samples, PixelImage& image) {
  band.restart(first * samples, count * samples);
  raster.draw_surfaces(band);
  raster.draw_lines(band);
  std::vector<Tone> tones(static_cast<std::size_t>(image.width));
  for (int row = first; row < first + count; ++row) {
    std::fill(tones.begin(), tones.end(), Tone());
    for (int y = row * samples; y < (row + 1) * samples; ++y) {
      shader.add_row(band.row(y), y, samples, tones);
    }
    const auto width = static_cast<std::size_t>(image.width);
    to_pixels(tones, std::span(image.pixels).subspan(static_cast<std::size_t>(row) * width, width));
  }
}

std::optional<SeenFace> seen_face(const Scene& scene, const SceneOnRaster& raster,
                                  std::uint64_t key) {
  const std::uint32_t id = RasterBand::id_of(key);
  if (id == RasterBand::kNothing) return std::nullopt;
  const ScenePart part = raster.part_of(id);
  const auto& faces = scene.surfaces[part.index].mesh.faces;
  const auto behind = std::upper_bound(
      faces.begin(), faces.end(), id - part.first_id,
      [](std::uint32_t triangle, const MeshFace& face) { return triangle < face.first; });
  return SeenFace{static_cast<std::uint32_t>(part.index),
                  static_cast<std::uint32_t>(behind - faces.begin() - 1),
                  RasterBand::nearness_of(key)};
}

/// Runs `work` in this thread and up to count - 1 others, until all have come back.
template <class Work>
void run_in_threads(int count, const Work& work) {
  std::vector<std::thread> others;
  others.reserve(static_cast<std::size_t>(count) - 1);
  try {
    for (int i = 1; i < count; ++i) others.emplace_back(work);
  } catch (const std::system_error&) {
    // The machine gives no more threads: those there are do the work.
  }
  work();
  for (std::thread& thread : others) thread.join();
}

}  // namespace

Expected<PixelImage> picture_of(const Scene& scene, const ScenePictureOptions& options) {
  const auto camera = camera_of(scene, options);
  if (!camera) return tl::unexpected(camera.error());
  const int samples = options.samples_per_side;
  const int width = options.width * samples;
  const int height = options.height * samples;
  SceneOnRaster raster(scene, *camera, width, height, samples);
  const Shader shader(scene, raster, *camera, width, height, options.shading);
  PixelImage image{options.width, options.height, {}};
  image.pixels.resize(static_cast<std::size_t>(image.width) *
                      static_cast<std::size_t>(image.height));

  const int rows = rows_per_band(options);
  const int bands = (options.height + rows - 1) / rows;
  if (bands > 1) raster.index_rows();
  std::atomic<int> next_band = 0;
  run_in_threads(std::min(options.threads, bands), [&] {
    RasterBand band(width);
    for (int i = next_band++; i < bands; i = next_band++) {
      const int first = i * rows;
      draw_rows(raster, shader, band, first, std::min(rows, options.height - first), samples,
                image);
    }
  });
  return image;
}

Expected<std::string> scene_to_png(const Scene& scene, const ScenePictureOptions& options) {
  const auto image = picture_of(scene, options);
  if (!image) return tl::unexpected(image.error());
  return encode_png(*image);
}

Expected<std::vector<std::optional<SeenFace>>> faces_seen(const Scene& scene,
                                                          const ScenePictureOptions& options) {
  const auto camera = camera_of(scene, options);
  if (!camera) return tl::unexpected(camera.error());
  SceneOnRaster raster(scene, *camera, options.width, options.height, 1);
  raster.index_rows();
  std::vector<std::optional<SeenFace>> seen;
  seen.reserve(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height));
  const int rows = std::min(std::max(kBandSamples / options.width, 1), options.height);
  RasterBand band(options.width);
  for (int first = 0; first < options.height; first += rows) {
    band.restart(first, std::min(rows, options.height - first));
    raster.draw_surfaces(band);
    for (int y = first; y < band.end_row(); ++y) {
      for (const std::uint64_t key : band.row(y)) seen.push_back(seen_face(scene, raster, key));
    }
  }
  return seen;
}

}  // namespace limn
