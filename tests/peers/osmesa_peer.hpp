#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace limn::peers {

#ifdef LIMN_PEER_OSMESA

/// Triangles with a normal a vertex, as graphics libraries take them.
struct PeerDrawing {
  std::vector<float> places;           ///< three a vertex
  std::vector<float> normals;          ///< three a vertex, in the camera's frame
  std::vector<std::uint32_t> corners;  ///< three a triangle
};

/// Mesa's llvmpipe, without a window: draws into memory, in the calling thread alone.
class OsmesaRenderer {
 public:
  /// Everything is on the renderer's side afterwards; drawing costs drawing.
  OsmesaRenderer(const PeerDrawing& mesh, int width, int height);
  ~OsmesaRenderer();
  OsmesaRenderer(const OsmesaRenderer&) = delete;
  OsmesaRenderer& operator=(const OsmesaRenderer&) = delete;

  /// What went wrong while it was made; empty if nothing did.
  const std::string& complaint() const;
  /// "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string name() const;

  /// Draws the mesh with its normals, two lights, sky and gloss a pixel, both sides, and waits for
  /// the pixels. `matrix`: to clip coordinates, column by column.
  void draw(const std::array<float, 16>& matrix);

  /// 0x00RRGGBB in rows from the bottom.
  const std::vector<std::uint32_t>& pixels() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

#endif

}  // namespace limn::peers
