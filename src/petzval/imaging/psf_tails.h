// SPDX-License-Identifier: BSD-3-Clause
// Light that lands far from its chief ray: formed on coarser pixels, for it has no detail.
#pragma once

#include <petzval/imaging/cell_plane.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/optics/lens_data_table.h>
#include <petzval/sensor/sensor.h>

#include <optional>
#include <span>

namespace petzval {

/// A table in two, whose images add up to its own.
struct TailSplit {
  LensDataTable sharp;  ///< what lands within a round window about the chief ray, with soft edges
  LensDataTable tails;  ///< what lands beyond it
};

/// Parts a table whose PSFs reach far. Kernels of a sliver of light that is spread over millimetres would be
/// as large as the frame, or refused.
///
/// \param radius_um  of the window: it falls from half of that on, as a fifth-degree polynomial. \returns
/// nothing where no PSF reaches beyond twice that.
std::optional<TailSplit> split_tails(const LensDataTable& table, double radius_um);
/// How strong an image of tails is beside the whole one: the RMS of their light over what is lit, at the
/// wavelength where it is largest.
double tail_strength(const TailSplit& split);
/// As ImagingOptions::tail_pixels has it.
std::optional<TailSplit> split_table(const LensDataTable& table, const SensorGeometry& sensor,
                                     const ImagingOptions& options);

/// How many pixels of a frame a pixel is wide on which tails are formed: a sixteenth of
/// ImagingOptions::tail_pixels.
int tail_coarseness(int tail_pixels);

/// Pixels as large as `of_pixels` squared of a frame's, that cover it.
SensorGeometry coarse_frame(const SensorGeometry& frame, int of_pixels);

/// Adds light on coarse pixels to that of a frame whose middle they share. Within a coarse pixel light is a
/// parabola along either side, through the means of its neighbours: its own mean stays. \param rows  of the
/// frame; others are left alone.
void add_coarse(std::span<const float> coarse, const SensorGeometry& coarse_grid, int of_pixels,
                RowRange rows, const SensorGeometry& frame, std::span<float> pixels);

}  // namespace petzval
