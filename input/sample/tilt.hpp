#pragma once

namespace limn {

/// The lean of a pen as PenSample has it.
struct Tilt {
  double x_rad = 0;  ///< -pi/2 to pi/2, positive when the upper end leans to the right
  double y_rad = 0;  ///< -pi/2 to pi/2, positive when it leans towards the user
};

/// Tilt from the two angles that some devices and files give instead, both in degrees:
///
///     tan(tilt_x) = cos(azimuth) / tan(altitude)
///     tan(tilt_y) = sin(azimuth) / tan(altitude)
///
///     altitude  angle between the pen and the tablet's plane: 90 upright, 0 flat. Clamped to
///               0..90: devices and files overshoot upright.
///     azimuth   direction in which the upper end leans: 0 to the right (+x), 90 towards the user
///               (+y), so clockwise seen from above. Any finite number of turns.
///
/// The azimuth is that of HID usage 0x0D/0x3F, a rotation about HID's z axis, counter-clockwise as
/// that axis points at the eye. HID's x, y and z (right, near, down) are right-handed, so it turns
/// from +x to +y. W3C Pointer Events have the same azimuth; Wintab's starts at the far edge:
/// azimuth = wintab - 90.
///
/// Uses + - * / and sqrt alone, so the result has the same bits on every machine; its error is that
/// of rounding the two angles. Precondition: both finite.
Tilt tilt_from_altitude_azimuth(double altitude_deg, double azimuth_deg) noexcept;

}  // namespace limn
