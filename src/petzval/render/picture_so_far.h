// SPDX-License-Identifier: BSD-3-Clause
// From the sums on the film to a picture, also of work that is not done.
#pragma once

#include <petzval/render/passes.h>

#include <optional>
#include <span>
#include <vector>

namespace petzval::render {

/// The means over the samples that were taken, and over those that met a surface.
Rendering picture_so_far(const Film& film, const WavelengthGroups& groups, const SensorGeometry& sensor,
                         const Photosite& photosite, const Passes& passes);

/// Adds what tiles found elsewhere than in themselves; those whose strays have been added have none.
void add_strays(std::span<const TileResult> results, std::size_t groups, bool half, Film& film);

/// The picture of a pass that was stopped: its tiles that are done have a pass more than the others, which
/// are black if it was the first. Nothing if none is done.
std::optional<Rendering> picture_of_stopped_pass(const std::vector<PixelWindow>& tiles,
                                                 const std::vector<TileResult>& results, Film& film,
                                                 const WavelengthGroups& groups, const SensorGeometry& sensor,
                                                 const Photosite& photosite, const Passes& passes);

/// Some of its pixels. \param window  what it shows. \param part  what is wanted.
Rendering cropped(Rendering picture, const PixelWindow& window, const PixelWindow& part);

}  // namespace petzval::render
