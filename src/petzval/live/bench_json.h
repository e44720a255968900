// SPDX-License-Identifier: BSD-3-Clause
// What the bench shows, as JSON for the page.
#pragma once

#include <petzval/flare/scene_sources.h>
#include <petzval/live/bench.h>
#include <petzval/live/message.h>
#include <petzval/report/svg_plot.h>
#include <petzval/trace/tracer.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace petzval {

/// A plot as its numbers; the page draws it. A value that is not finite is null.
nlohmann::json plot_json(const Plot& plot);

/// Surfaces, glass, rays and first-order data of a lens as it is used. Where no ray of a field passes,
/// "blocked" says which surface is in the way.
nlohmann::json layout_json(const Lens& lens);

/// Ghosts of the lens, the brightest first; the way of one of them through it, of the sun's light or
/// else of light along the axis; and where on the sensor light from infinity lands: pairs of the tangent of
/// its angle from the axis and its height [mm]. \throws InputError for lenses that have no ghosts to follow.
nlohmann::json stray_json(const CoatedLens& coated, const std::optional<Sun>& sun,
                          const std::optional<GhostPair>& ghost, double sensor_reflectance);

/// Where on the sensor bright sources of a scene are imaged [mm], as the upright picture shows it; those
/// whose chief ray does not arrive are left out.
nlohmann::json sources_json(const Lens& lens, const SourcesFound& found);

/// What keeps the light of an object field from the sensor, in a line: "rays miss surface 3". Told by the
/// rays of a fan that get farthest. \param surface  its number; -1: none is to blame.
std::string blocking_surface(const Tracer& tracer, const Lens& lens, double object_field, int& surface);

/// Glasses whose names have these letters and digits, or, for two numbers ("1.62 60"), those nearest to them
/// as nd and Vd; at most `most`.
nlohmann::json glasses_json(const std::string& text, std::size_t most = 40);

}  // namespace petzval
