// SPDX-License-Identifier: BSD-3-Clause
// Plots of what the rays across a pupil do: spots, fans, wavefronts.
#pragma once

#include <petzval/report/analysis_tables.h>
#include <petzval/report/svg_plot.h>

#include <vector>

namespace petzval {

// Rows of all of these are in the order fields × wavelengths, as the analyses give them.

/// A plot a field on a scale of its own, about the chief ray of its first wavelength, with that wavelength's
/// Airy circle.
std::vector<Plot> spot_plots(Fields::Kind kind, const std::vector<SpotDiagram>& diagrams,
                             const std::vector<SpotRow>& rows);
constexpr int spot_plots_across = 3;

/// A plot a surface: the outlines of the fields' light and the clear aperture in black.
std::vector<Plot> footprint_plots(Fields::Kind kind, const Lens& lens,
                                  const std::vector<Footprint>& footprints);
constexpr int footprint_plots_across = 4;
constexpr double footprint_plot_px = 300;

enum class FanQuantity { transverse, opd };
/// Two plots a field, tangential and sagittal, a curve a wavelength, all on one scale.
std::vector<Plot> fan_plots(Fields::Kind kind, const std::vector<AberrationFans>& rows, FanQuantity quantity);

/// A picture a field of one wavelength, all on one colour scale.
std::vector<Plot> wavefront_map_plots(Fields::Kind kind, const std::vector<WavefrontMap>& maps);
Plot wavefront_plot(Fields::Kind kind, const std::vector<WavefrontRow>& rows);
Plot zernike_plot(Fields::Kind kind, const std::vector<WavefrontZernikeRow>& rows, ZernikeOrder order);

}  // namespace petzval
