// SPDX-License-Identifier: BSD-3-Clause
// The first way to the sensor: a flat spectral scene through a lens (Maeda, Catrysse & Wandell 2005).
#pragma once

#include <petzval/base/context.h>
#include <petzval/image/spectral_image.h>
#include <petzval/imaging/depth_image.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/optics/lens_data_table.h>
#include <petzval/scene/scene_file.h>
#include <petzval/simulate/camera.h>
#include <petzval/simulate/flare.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace petzval {

/// A scene to be read (read_scene). What its options leave open follows from the camera: a chart or a
/// photograph without an angle is made as wide as the sensor's frame and the reach of the PSFs need.
struct SceneRequest {
  std::string name;  ///< a file, or the name of a chart or of a bundled scene
  SceneOptions options = {};
};

/// A lens data table in the place of a lens, with the sensor behind it.
struct TableCamera {
  LensDataTable table;
  std::optional<Sensor> sensor = {};  ///< absent: what fits the scene
};

/// What light comes through.
using Optics = std::variant<Camera, TableCamera>;

struct ImageOptions {
  ImagingOptions imaging = {};  ///< its photosite is the sensor's
  DepthOptions depth = {};
  /// The least width of a chart or a photograph that fills the frame: the same scale in several images.
  std::optional<double> least_scene_angle_deg = {};
  FlareOptions flare = {};  ///< of scenes on a plane or all around, through a lens
  /// A piece of the image for one of several processes (simulate/image_pieces.h): its bands from the first
  /// up to the second, which go into `checkpoint` alone. Absent: all.
  std::optional<std::array<int, 2>> bands = {};
  /// A file of bands; without `bands` it holds all of them, and none is formed again. Empty: none.
  std::string checkpoint = {};
};

/// What is known before light is computed: the scene where it stands, the table of the lens focused on it,
/// the frame.
struct ImagePlan {
  Scene scene;
  LensDataTable table;  ///< of a scene with depth, only the lens's name and paraxial optics
  std::optional<DepthCamera> depth;
  SensorGeometry frame;
  ImageOptions options;
  std::optional<LitLens> lens = {};  ///< if it is not a table alone
  /// Of earlier images of the same scene; absent: there are none.
  std::shared_ptr<FormationMemory> memory = {};
};

/// What there is to say about an image.
struct ImageReport {
  ImagingReport imaging;
  std::vector<DepthLayer> layers;         ///< of a scene with depth
  double pupil_to_sensor_mm = 0;          ///< the viewpoint of such a scene
  std::string method;                     ///< how the image was blurred, in a line
  std::optional<FlareLayers> flare = {};  ///< that the image has, if any was asked for
};

/// Reads the scene, focuses the lens, makes its table, and fits scene and frame to each other. Notes tell
/// what was chosen where nothing was said. \throws InputError for what does not fit, saying what would be
/// right; Cancelled.
ImagePlan plan_image(const SceneRequest& scene, Optics optics, const ImageOptions& options = {},
                     const Context& context = {});
/// The same of a scene in memory, which is taken as it is: its angle and its distance are its own.
ImagePlan plan_image(Scene scene, Optics optics, const ImageOptions& options = {},
                     const Context& context = {});

/// The irradiance on the sensor, with its provenance, the lens's facts and the light of the scene. Notes are
/// those of form_image(). \param report  may be null. \throws InputError; Cancelled.
SpectralImage image(const ImagePlan& plan, const Context& context = {}, ImageReport* report = nullptr);
/// plan_image() and image() in one.
///
///     ImageOptions options;
///     options.imaging.product.tolerance = 1e-2;
///     const SpectralImage light = image(SceneRequest{.name = "studio"}, camera, options);
SpectralImage image(const SceneRequest& scene, Optics optics, const ImageOptions& options = {},
                    const Context& context = {}, ImageReport* report = nullptr);
SpectralImage image(Scene scene, Optics optics, const ImageOptions& options = {}, const Context& context = {},
                    ImageReport* report = nullptr);
/// The same without an image: each band is handed over as it is ready, in order; those of a scene with depth
/// wait for its nearest layer.
void image_bands(const ImagePlan& plan, const TakeBand& take, const Context& context = {},
                 ImageReport* report = nullptr);

/// Whether plan_image() chooses the width of this scene.
bool fills_frame(const SceneRequest& scene, const Optics& optics, const ImageOptions& options);
/// The width that it would choose [degrees], to about a per cent and in a fraction of the time of an image;
/// nothing if the scene has one of its own. \throws InputError; Cancelled.
std::optional<double> filling_angle_deg(const SceneRequest& scene, const Optics& optics,
                                        const ImageOptions& options, const Context& context = {});

}  // namespace petzval
