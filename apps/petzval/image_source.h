// SPDX-License-Identifier: BSD-3-Clause
// Where the light of `image` comes from: a scene, and the lens data table that images it.
#pragma once

#include <petzval/base/progress.h>
#include <petzval/imaging/depth_image.h>
#include <petzval/optics/lens_data_table.h>
#include <petzval/scene/scene.h>

#include <optional>

#include "image_option.h"

namespace petzval::app {

struct SceneAndTable {
  Scene scene;
  LensDataTable table;  ///< of a scene with depth only the lens's name and paraxial optics
  std::optional<DepthCamera> depth;
};

/// How many fields and wavelengths a lens's table has: what a picture needs, or what tells how far light
/// spreads, to a per cent of the field.
enum class TableDetail { full, outline };

/// Reads the scene and the stored table, or builds the table of the lens, focused as asked, with the scene
/// where it stands. \param sensor  how far from the axis light is wanted; the scene's own image if there is
/// none. \throws InputError naming the file or the option.
SceneAndTable read_source(const ImageChoice& choice, const std::optional<SensorGeometry>& sensor,
                          const ProgressCallback& progress, const Shared& shared,
                          TableDetail detail = TableDetail::full);

/// How wide [degrees] a chart or a photograph without an angle of its own is made, to fill the frame, to
/// about a per cent and in a fraction of the time of an image; nothing for other scenes, and without a
/// sensor. \throws as read_source().
std::optional<double> filling_angle_deg(const ImageChoice& choice, const Shared& shared);

/// Whether the scene is one that filling_angle_deg() has an angle for.
bool fills_frame(const ImageChoice& choice);

/// A chart or a photograph without an angle of its own fills the frame; without a sensor the frame follows
/// the scene.
SensorGeometry fit_to_each_other(const ImageChoice& choice, const ImagingOptions& options, Scene& scene,
                                 const LensDataTable& table, const std::optional<DepthCamera>& depth,
                                 const std::optional<SensorGeometry>& sensor, const Shared& shared);

}  // namespace petzval::app
