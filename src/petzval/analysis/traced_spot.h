// SPDX-License-Identifier: BSD-3-Clause
// The geometric PSF of traced rays, for pupils that no polynomial meets.
#pragma once

#include <petzval/analysis/field_tracer.h>
#include <petzval/wave/chord_sum.h>

#include <optional>

namespace petzval {

/// The light of a quadrature's rays in the cells of a grid, each ray spread over a square of one cell. No
/// diffraction. `captured` is the share of the rays' light inside. samples_per_cell is not used.
/// \param radial_nodes  of the quadrature, with 8/3 as many azimuths. \returns nothing where no ray passes.
std::optional<Psf> traced_spot(const FieldTracer& tracer, const ChiefRay& chief, const PsfGrid& grid,
                               int radial_nodes);

}  // namespace petzval
