#pragma once

#include <cassert>

/// States a precondition that the caller must keep. A broken one is the caller's bug, never bad
/// input: bad input gives an Error. Checked unless NDEBUG is defined.
#define LIMN_EXPECT(condition) assert(condition)
