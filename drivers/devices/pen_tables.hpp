#pragma once

#include <span>
#include <vector>

#include "drivers/devices/pen_spec.hpp"

namespace limn {

// The vendors' tables, each in its own file; pen_spec.cpp puts them together.
std::span<const PenSpec> wacom_pens() noexcept;
std::span<const PenSpec> kye_pens() noexcept;
std::span<const PenSpec> veikk_pens() noexcept;
/// UC-Logic, Huion, Gaomon.
void append_uclogic_pens(std::vector<PenSpec>& rows);
/// XP-Pen, UGEE, Parblo.
void append_ugee_pens(std::vector<PenSpec>& rows);

}  // namespace limn
