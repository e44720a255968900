// SPDX-License-Identifier: BSD-3-Clause
// Plots of analyses over field and frequency, the same for the program's --plot and for report pages.
#pragma once

#include <petzval/report/analysis_tables.h>
#include <petzval/report/svg_plot.h>

#include <vector>

namespace petzval {

// Rows of all of these are in the order fields × wavelengths, as the analyses give them.

Plot seidel_plot(const SeidelSums& sums);

/// A pair of curves a field and wavelength over frequency, tangential drawn through, sagittal dashed.
Plot mtf_plot(Fields::Kind kind, const std::vector<MtfRow>& rows, std::size_t frequencies);
/// A pair of curves a frequency over the field.
Plot mtf_field_plot(Fields::Kind kind, const std::vector<MtfRow>& rows, std::size_t frequencies);

/// A pair of curves a field and frequency over the place of the sensor.
Plot mtf_focus_plot(Fields::Kind kind, const std::vector<MtfRow>& rows);
/// 33 sensor shifts from −reach to +reach, for such a plot.
std::vector<double> even_shifts(double reach_mm);

/// The three curves by which designers know a lens: field upwards, aberration to the right.
Plot longitudinal_plot(const std::vector<AxialFocusRow>& rows);
/// \param reference  rows at the lens's reference wavelength, whose Petzval curve is drawn.
Plot field_curvature_plot(Fields::Kind kind, const std::vector<FieldCurvatureRow>& rows,
                          const std::vector<FieldCurvatureRow>& reference);
Plot distortion_plot(Fields::Kind kind, const std::vector<DistortionRow>& rows);
/// The image of a square grid, over the ideal one in grey.
Plot distortion_grid_plot(const DistortionGrid& grid);

/// A curve a field and wavelength over the radius; dashed beside it what an Airy pattern holds.
Plot encircled_energy_plot(Fields::Kind kind, const std::vector<EncircledEnergyRow>& rows);

Plot lateral_colour_plot(Fields::Kind kind, const std::vector<LateralColourRow>& rows);
Plot illumination_plot(const std::vector<IlluminationRow>& rows);
Plot vignetting_plot(Fields::Kind kind, const std::vector<VignettingRow>& rows);
/// A dot a ghost, a colour a wavelength; the brightest are named by their surfaces.
Plot ghost_plot(const std::vector<Ghost>& rows, std::size_t sensor);
Plot chief_ray_angle_plot(const std::vector<ChiefRayAngleRow>& rows);

}  // namespace petzval
