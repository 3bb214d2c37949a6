#pragma once

#include <filesystem>
#include <string>

#include "tests/peers/peer_surface.hpp"

namespace limn::peers {

// tests/golden/kernel/rhino3dm.json: surfaces, places on them and what a library that is not linked
// here answered there.

/// What openNURBS says of one place. It has no mixed derivatives in JavaScript.
struct WitnessedPlace {
  PeerParameters at;
  PeerPoint point = {};
  PeerPoint normal = {};                        ///< S_u x S_v of unit length
  std::array<PeerPoint, 3> u_derivatives = {};  ///< S_u, S_uu, S_uuu
  std::array<PeerPoint, 3> v_derivatives = {};
};

struct WitnessedSurface {
  PeerSurface surface;
  std::vector<WitnessedPlace> places;
};

/// Of a file that rhino3dm.mjs wrote. Throws what nlohmann/json throws where it is another.
std::vector<WitnessedSurface> read_witness_table(const std::filesystem::path& file);

/// What rhino3dm.mjs reads: the surfaces and the places alone, a surface a line.
std::string witness_questions(const std::vector<WitnessedSurface>& surfaces);

}  // namespace limn::peers
