// SPDX-License-Identifier: BSD-3-Clause
// How much of a light each band of a scene or an image stands for.
#pragma once

#include <petzval/colour/spectrum.h>

#include <optional>
#include <span>
#include <vector>

namespace petzval {

/// Whether 90 % of the light lies within 100 nm: a line, an LED of one colour, a lamp behind a filter.
bool is_narrow(const Spectrum& light);

/// The light in each band, per nm: value times band_widths_nm() is the light that the band stands for.
///   - Several bands share out the light between the first and the last of them (BandResampling).
///   - A narrow light that the bands reach falls into them wholly: the first and the last take what lies
///     beyond them, and a single band takes all of it.
///   - A single band of a broad light stands for 1 nm, because its width cannot be known.
///   - Bands of a given width stand for the light within half of it on both sides, as through filters.
/// \param light  zero beyond its ends, on any scale. \param bands_nm  strictly increasing.
/// \param width_nm  of every band. \throws InputError unless it is positive.
std::vector<double> band_light(const Spectrum& light, std::span<const double> bands_nm,
                               std::optional<double> width_nm = {});

}  // namespace petzval
