// SPDX-License-Identifier: BSD-3-Clause
// What an image asks of the table that its lens has, and what a stored table misses of it.
#pragma once

#include <petzval/imaging/spread_wanted.h>
#include <petzval/scene/scene.h>
#include <petzval/sensor/sensor.h>
#include <petzval/simulate/image.h>

#include <array>

namespace petzval {

/// How far beyond a frame a table reaches: where the scene that fills it does, and PSFs spread into its
/// corner.
double beyond_frame_mm(double half_diagonal_mm, double pitch_um);

/// What places over the frame must cover: a frame, and cells about it in whose light its pixels share.
std::array<double, 2> half_frame_mm(const SensorGeometry& frame);

/// How closely an image asks a table to say how light spreads.
SpreadWanted spread_wanted(const ImageOptions& options, double pitch_um);
/// The same, of this scene by this lens.
SpreadWanted spread_wanted(const ImageOptions& options, double pitch_um, const Scene& scene,
                           const FirstOrder& lens);

/// Whether the image is formed from mixtures of the PSFs of neighbouring fields.
bool mixes_psfs(const ImageOptions& options);

/// What a stored table misses between its fields (error_between_fields()); 0: not known.
double stored_table_error(const TableCamera& camera, const Scene& scene, const ImageOptions& options);

}  // namespace petzval
