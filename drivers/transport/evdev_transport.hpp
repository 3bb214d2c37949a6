#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/transport/transport.hpp"
#include "input/base/error.hpp"

namespace limn {

/// Opens an event node of Linux (/dev/input/event3): frames as the kernel's driver decoded them,
/// with the kernel's times (CLOCK_MONOTONIC). Others may read the same device: nothing is grabbed.
///
/// The kernel tells changes only, so whoever comes later must be told the state:
///
///   - The first frame is the whole state, as it is then: every key, every axis but those of
///     multi-touch slots. A pen that rested in range when limn came is seen with all its axes as
///     soon as anything about it changes.
///   - SYN_DROPPED (the kernel's queue overran): libevdev asks the kernel for the state. What
///     differs comes as one frame, together with what had come of the torn one, behind
///     lost(1, true). No frame holds a SYN_DROPPED, so a decoder need not wait for a state that it
///     has already, nor count the loss again.
///   - tell_whole_state(), or a frame of more than kMaxFrameEvents events (its loss is told as
///     above): the next frame is the whole state again.
///
/// The device's report descriptor comes from sysfs, where a HID device is behind the node: the
/// kernel's own sizes are rounded (see EvdevPenDecoder).
///
/// Errors: kIo: no such node, no permission, held by another program for itself alone, no event
/// node; kMissing in a build without libevdev.
Expected<std::unique_ptr<Transport>> open_evdev(const std::string& node);

}  // namespace limn
