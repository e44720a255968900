// SPDX-License-Identifier: BSD-3-Clause
// petzval image of scenes with depth: options, focus, what there is to say.
#pragma once

#include <petzval/camera/mounted_lens.h>
#include <petzval/imaging/depth_field.h>
#include <petzval/imaging/depth_image.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "command.h"

namespace petzval::app {

/// Adds --layers.
void add_depth_options(CLI::App& command, DepthOptions& options);

/// Says when a depth map is not used. \throws InputError for --layers without one.
void check_depth(const Scene& scene, bool used, const DepthOptions& options, const Shared& shared);

/// Where --focus auto focuses: on the depth in the middle of the picture, from the sensor plane (absent:
/// infinity).
std::optional<double> depth_focus_m(const Scene& scene, MountedLens camera);

/// How far from the axis light will be wanted [mm].
double depth_image_height_mm(const Scene& scene, const Lens& lens,
                             const std::optional<SensorGeometry>& sensor);

/// A table of nothing but the lens's name and paraxial optics.
LensDataTable facts_alone(const Lens& lens);

/// Adds the layers, if there are any.
nlohmann::ordered_json with_layers(nlohmann::ordered_json summary, const DepthReport& report);
void print_layers(const DepthReport& report, double pitch_um);

}  // namespace petzval::app
