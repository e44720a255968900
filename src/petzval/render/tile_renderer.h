// SPDX-License-Identifier: BSD-3-Clause
// The samples of one tile of a picture, in one pass.
#pragma once

#include <petzval/render/camera/film_camera.h>
#include <petzval/render/film/film.h>
#include <petzval/render/film/film_sampling.h>
#include <petzval/render/renderer.h>

#include <vector>

namespace petzval::render {

/// What is rendered, and how; all of it outlives the tiles.
struct TileTask {
  const World& world;
  const FilmCamera& camera;
  const Transform& world_from_camera;
  const SensorGeometry& sensor;
  const FilmSampling& sampling;   ///< where samples begin
  const FilmSampling& gathering;  ///< and which pixels their light goes to: the same without waves
  const RenderOptions& options;
};

/// Samples [first, last) of a pixel for one group of wavelengths.
struct SampleRange {
  int first = 0, last = 0;
};

/// Light that landed outside of the tile that found it.
struct Stray {
  std::size_t at;  ///< as Film::at() has it
  double light;
};

/// All that one tile adds in one pass, beside what it has added to its own pixels.
struct TileResult {
  bool done = false;
  std::vector<std::vector<Stray>> strays;  ///< by group of wavelengths
  std::vector<Stray> outside;              ///< beyond the film's window: into Film::outside
  std::vector<ExactSum> arriving;          ///< for Film::arriving
  std::uint64_t rays = 0, passed = 0;
};

/// Takes samples for each pixel of a tile. Of the film, only the tile's own pixels are changed, and those
/// when the tile is done: one that is stopped leaves nothing.
/// \param of_group  the samples to be taken, by group of wavelengths. \param half  whether they are of the
/// half whose light is also gathered in Film::half.
TileResult render_tile(const TileTask& task, const PixelWindow& tile,
                       const std::vector<SampleRange>& of_group, bool half, Film& film);

}  // namespace petzval::render
