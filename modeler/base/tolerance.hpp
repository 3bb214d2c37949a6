#pragma once

namespace limn {

/// Places nearer than this are the same, in mm. For coincidence only: fits and meshes have
/// tolerances that users choose.
inline constexpr double kGeometric = 1e-9;

}  // namespace limn
