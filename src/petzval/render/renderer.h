// SPDX-License-Identifier: BSD-3-Clause
// From a scene and a camera to a picture.
#pragma once

#include <petzval/base/progress.h>
#include <petzval/render/camera/camera_motion.h>
#include <petzval/render/camera/clipping_planes.h>
#include <petzval/render/camera/film_camera.h>
#include <petzval/render/film/film.h>
#include <petzval/render/film/film_sampling.h>
#include <petzval/render/rendering.h>
#include <petzval/sensor/sensor.h>

#include <array>
#include <optional>

namespace petzval::render {

/// What one of several processes renders of a picture. Pieces are put together from their checkpoints
/// (merge_checkpoints), which then is what one process would have left.
struct FilmPiece {
  std::optional<PixelWindow> region;  ///< pixels of the picture; absent: all
  /// Samples a pixel [first, last) of all; multiples of those of a pass (samples_a_pass()). Absent: all.
  std::optional<std::array<int, 2>> samples;

  bool is_whole() const { return !region && !samples; }
};

struct RenderOptions {
  /// Camera paths a pixel. Each serves the up to eight wavelengths of one group; at least one for every group
  /// is taken.
  int samples_per_pixel = 16;
  /// If positive: rendering ends as soon as the noise (film/noise.h) is estimated to be below, and after
  /// `samples_per_pixel`, taken in whole passes, at the latest. Decided after passes over the whole picture,
  /// so that threads and interruptions change nothing.
  double noise = 0;
  std::uint64_t seed = 1;
  PathOptions path;
  ClippingPlanes clipping;
  std::optional<PixelWindow> window;  ///< only these pixels are rendered: the whole picture
  FilmPiece piece;                    ///< and of it this
  Photosite photosite;  ///< over which each pixel's value is a mean, and the low-pass filter before it
  bool first_surfaces = false;
  /// The picture is denoised (film/denoise.h); what checkpoints hold is not. Taken in two halves, so that
  /// there are at least four samples a pixel for each group of wavelengths. Without light groups and pieces.
  bool denoise = false;
  bool light_groups = false;           ///< also what each light gives (Rendering::light_groups)
  std::optional<CameraMotion> motion;  ///< of the camera: each sample is taken at a time of its own
  /// A file to resume from and to save to; empty: none. Kept when the picture is done, or stopped: more
  /// samples are added to those in it.
  std::string checkpoint;
  std::string fingerprint;  ///< of scene, lens and options, kept in the checkpoint
  double checkpoint_seconds = 60;
  /// Called with passes done and all; returning false ends rendering there (after a checkpoint, if one is
  /// kept).
  std::function<bool(int, int)> after_pass;
  /// Given the picture so far before Cancelled leaves render_picture(), if a tile of it is done: what the
  /// checkpoint has, or else all samples of the tiles that are done.
  std::function<void(Rendering)> so_far;
  /// Given the picture after passes, at most so often, but after the first.
  std::function<void(const Rendering&)> preview;
  double preview_seconds = 5;
};

/// Renders a picture. The same arguments give the same bytes for any number of threads, and whether or not it
/// was interrupted and resumed. \param world_from_camera  camera space: looking along +z, x right, y up, film
/// at 0. \throws InputError, Failure, Cancelled.
Rendering render_picture(const World& world, const FilmCamera& camera, const Transform& world_from_camera,
                         const SensorGeometry& film, const RenderOptions& options,
                         const ProgressCallback& progress = {});

/// Samples a pixel of one pass over the picture.
int samples_a_pass(const WavelengthGroups& groups);

/// How many paths a pixel are really taken: at least one for every group of wavelengths.
int effective_samples(const WavelengthGroups& groups, int samples_per_pixel);

}  // namespace petzval::render
