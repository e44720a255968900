// SPDX-License-Identifier: BSD-3-Clause
// Apertures, poses, groups and tolerances of lenses as Python has them: in the form of the native file.
#pragma once

#include "bind.h"

namespace petzval::python {

/// A dict that cannot be altered: altering the lens takes an assignment of a whole one.
nb::object read_only(const nb::object& dict);

/// ({"rectangle": (8, 5)}, {"ellipse": (3, 3), "obscures": True}).
nb::tuple apertures_to(const std::vector<ApertureFigure>& apertures);
/// \throws InputError for what is no aperture, saying what would be right.
std::vector<ApertureFigure> apertures_from(const nb::iterable& apertures);

/// {"tilt_x_deg": 0.1}, without what is 0.
nb::object pose_to(const Pose& pose);
/// \throws InputError for another key.
Pose pose_from(const nb::dict& dict);

/// ({"surfaces": (2, 3), "pose": {…}, "pivot_mm": 1.5},).
nb::tuple groups_to(const std::vector<SurfaceGroup>& groups);
std::vector<SurfaceGroup> groups_from(const nb::iterable& groups);

/// ("element_tilt_deg@2-3=0.05",).
nb::tuple tolerances_to(const std::vector<Tolerance>& tolerances);
std::vector<Tolerance> tolerances_from(const std::vector<std::string>& texts);

}  // namespace petzval::python
