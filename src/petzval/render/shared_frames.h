// SPDX-License-Identifier: BSD-3-Clause
// Pictures of one world by one camera whose lens alone is altered from frame to frame, as in a focus pull:
// they share their paths.
#pragma once

#include <petzval/render/camera/lens_camera.h>
#include <petzval/render/renderer.h>

#include <span>
#include <vector>

namespace petzval::render {

/// Fewer have little to share.
inline constexpr int fewest_sharing_frames = 4;

/// How many paths frames send so that a picture is no noisier than one of `samples_per_pixel` paths of its
/// own; for each half of each group of wavelengths.
struct SharedPaths {
  int own = 1;    ///< of a pixel in a frame that sends
  int every = 1;  ///< of so many frames one sends, each pixel others
};
SharedPaths shared_paths(const WavelengthGroups& groups, int samples_per_pixel, int frames);

/// Bytes at the peak of render_shared_frames(), beside world and lenses.
double shared_frames_bytes(const WavelengthGroups& groups, const PixelWindow& window, int frames);

/// Renders all frames. The path of each is a sample of every frame (share_tile()). How many land on a pixel
/// is left to chance, but how much of a uniform field they should carry is known (PupilEtendue): each half of
/// the paths is corrected by what it carries too much or too little, times the radiance that the other half
/// has found (control variates: Hammersley and Handscomb 1964), which leaves means as they are to a few parts
/// in ten thousand. The same arguments give the same bytes for any number of threads.
/// \param cameras  of the frames, all in one place, that can land light (LensCameraOptions::lands).
/// \param options  of which samples, seed, path, clipping, window and photosite count.
/// \throws InputError for options that frames cannot share: noise, pieces, light groups, first surfaces,
/// denoising, motion, checkpoints; and for more light than fits into memory; Cancelled.
std::vector<Rendering> render_shared_frames(const World& world, std::span<const LensCamera> cameras,
                                            const Transform& world_from_camera, const SensorGeometry& film,
                                            const RenderOptions& options,
                                            const ProgressCallback& progress = {});

}  // namespace petzval::render
