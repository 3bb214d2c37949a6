#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace limn::test {

/// What a program of libspnav's is told; a button has its number, from 0 on, in axes[0].
struct SpnavTold {
  char kind = ' ';  ///< 'm'otion, 'p'ress, 'r'elease
  std::array<int, 6> axes{};
  int period_ms = 0;  ///< of a motion: since the one before

  friend bool operator==(const SpnavTold&, const SpnavTold&) = default;
};

/// A report of a 3D mouse, and when it came.
struct MouseReport {
  double seconds = 0;
  std::vector<std::uint8_t> bytes;
};

/// How such reports come to spacenavd.
struct SpacenavdView {
  /// The descriptor calls the axes relative.
  bool relative = false;
  /// From an event node, on which Linux tells of absolute axes what changes and of relative ones no
  /// zero, and where spacenavd's dead zone takes what is hardly anything. Else every report comes
  /// as it is, and rest is told once.
  bool by_event_node = true;
};

/// spacenavd 1.1's numbers (dev_usb_linux.c, dev.c and event.c, unless configured otherwise) of the
/// reports of a device of 3Dconnexion's: translations in number 1, rotations behind them or in
/// number 2, buttons in number 3. Absolute axes of -350 to 350 are scaled to -500 to 500, relative
/// ones are told as they are, and its frame is x, -z, -y of the device's. Periods are those of the
/// reports.
std::vector<SpnavTold> by_spacenavd(std::span<const MouseReport> reports, SpacenavdView view);

}  // namespace limn::test
