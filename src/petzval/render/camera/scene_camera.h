// SPDX-License-Identifier: BSD-3-Clause
// The camera that a scene file asks for, and what the user wants instead.
#pragma once

#include <petzval/render/camera/camera_motion.h>
#include <petzval/render/camera/clipping_planes.h>
#include <petzval/render/camera/lens_camera.h>
#include <petzval/render/camera/perspective_camera.h>
#include <petzval/render/film/pixel_window.h>
#include <petzval/render/pbrt/scene_description.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace petzval::render {

/// What the user asks for; what is absent is as the scene has it.
struct CameraChoice {
  std::optional<Lens> lens;
  bool pinhole = false;          ///< the scene's perspective, whatever camera it has
  std::optional<Sensor> sensor;  ///< its size, pitch, photosite and low-pass filter in place of the scene's
                                 ///< film
  std::optional<int> columns, rows;  ///< with a sensor, of its middle
  std::optional<double> film_diagonal_mm;
  std::optional<double> aperture_diameter_mm;  ///< of the stop
  bool scene_stop = true;  ///< the scene says how wide its lens's stop is, unless there is a diameter
  LensCameraOptions options;
};

/// Where the scene's file wants its film: the one or the other, or nothing.
struct SceneFocus {
  std::optional<double> film_distance_mm;  ///< from the last vertex
  std::optional<double> distance_m;        ///< from the film to what is sharp
};

/// A camera as it is used: how many pixels, how large, and either a lens or an ideal perspective.
struct SceneCamera {
  SensorGeometry film;
  Photosite photosite;
  std::optional<Lens> lens;
  SceneFocus focus;  ///< of a scene's lens; the lens is not focused yet
  PerspectiveOptions perspective;
  LensCameraOptions options;
  Transform world_from_camera;         ///< when exposure begins
  std::optional<CameraMotion> motion;  ///< while it lasts; absent: none
  ClippingPlanes clipping;
  std::optional<PixelWindow> crop;  ///< what is rendered of the film; absent: all of it
  std::vector<std::string> notes;

  /// The same camera with its film elsewhere. \throws InputError unless it has a lens and the distance is
  /// positive.
  SceneCamera with_film_distance_mm(double distance_mm) const;
  double film_distance_mm() const;
  std::unique_ptr<const FilmCamera> make(const WavelengthGroups& groups) const;
};

/// Reads the Film and Camera of a scene: perspective, realistic (pbrt-v4's parameters: lensfile,
/// aperturediameter [mm], focusdistance [scene units]; or those of the assignment of CS348B, 2006: specfile,
/// aperture_diameter, filmdistance, filmdiag [mm], hither, yon [scene units]), and film sizes. \throws
/// InputError with file, line and column for bad values, and through `unsupported`. The lens has its stop,
/// but not yet its focus.
SceneCamera set_up_camera(const SceneDescription& scene, const CameraChoice& choice,
                          Unsupported& unsupported);

}  // namespace petzval::render
