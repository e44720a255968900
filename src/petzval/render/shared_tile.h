// SPDX-License-Identifier: BSD-3-Clause
// The paths of one tile of several frames, and what each gives to every frame.
#pragma once

#include <petzval/render/camera/lens_camera.h>
#include <petzval/render/film/film_sampling.h>
#include <petzval/render/group_samples.h>
#include <petzval/render/renderer.h>

#include <array>
#include <span>
#include <vector>

namespace petzval::render {

/// Columns, or rows, of frames that share paths.
inline constexpr int most_shared_side = 32767;

/// Frames that are rendered together; all of it outlives the tiles.
struct SharedTask {
  const World& world;
  std::span<const LensCamera> cameras;  ///< one a frame, in one place
  const Transform& world_from_camera;
  const SensorGeometry& sensor;
  const FilmSampling& sampling;
  const RenderOptions& options;
};

/// Which paths of a tile: `own` of each pixel, in every `every`-th frame from a random one on.
struct SharedSamples {
  int group = 0, own = 1, every = 1;
  GroupSamples numbers = {};
};

/// What has landed on a pixel, over all paths: light [W·m⁻²·nm⁻¹], and how much a uniform field of unit
/// radiance would have given [sr].
struct alignas(64) SharedCell {
  Lanes light = Lanes::all(0), field = Lanes::all(0);
};

/// What one tile's paths give to one frame.
struct SharedBox {
  PixelWindow window;  ///< that holds where they land; may be empty
  std::vector<SharedCell> cells;
  std::vector<std::pair<Pixel, float>> lamps;  ///< light that comes straight from a lamp
  std::uint64_t rays = 0, passed = 0;          ///< that this frame sent
};

struct SharedTileResult {
  std::vector<SharedBox> frames;
  std::array<double, lane_count> arriving{};  ///< as PathLight has it, summed over rays
};

/// Follows the samples that every frame draws in a tile. The path of each is a sample of every frame whose
/// lens lets its ray through to the film. Its light is divided by the density with which all of them, with
/// any wavelength leading, would have found the ray (balance heuristic: Veach and Guibas, SIGGRAPH 1995), in
/// the phase space dA dα dβ of the film, which a lens conserves, so that densities on different films are
/// those of one ray. \throws Cancelled.
SharedTileResult share_tile(const SharedTask& task, const PixelWindow& tile, const SharedSamples& samples);

}  // namespace petzval::render
