// SPDX-License-Identifier: BSD-3-Clause
// Where light is gathered.
#pragma once

#include <petzval/render/film/exact_sum.h>
#include <petzval/render/film/pixel_window.h>
#include <petzval/render/path_tracer.h>
#include <petzval/render/spectra/wavelength_groups.h>

#include <cstdint>
#include <map>
#include <vector>

namespace petzval::render {

/// Sums over samples, the same bits in whatever order they are gathered.
struct Film {
  PixelWindow window;
  std::vector<ExactSum> light;       ///< sums over samples, [band][pixel]
  std::vector<ExactSum> of_sources;  ///< the same of each light of the scene, if wanted, [light][band][pixel]
  /// Of every second pass: its light, summed over bands or [band][pixel], and its first surfaces, the planes
  /// below in their order.
  std::vector<ExactSum> half, half_first;
  std::vector<ExactSum> lamps;  ///< light that comes straight from a lamp, summed over bands
  /// Of first surfaces, if wanted: how many rays of each group of wavelengths met one, and sums over them.
  std::vector<ExactSum> met, depth, normal, albedo;  ///< [group][pixel], [pixel], [3][pixel], [band][pixel]
  std::vector<ExactSum> arriving;  ///< light that comes straight to what is seen, summed over rays, [band]
  std::map<std::uint64_t, ExactSum>
      outside;        ///< beyond the window: by plane · whole.size() + pixel of `whole`
  PixelWindow whole;  ///< the picture that the window is a piece of
  std::uint64_t rays = 0, passed = 0;
  int first_pass = 0;  ///< of the rounds of samples that are in the sums
  int passes = 0;      ///< how many of them are

  /// What is kept of every second pass.
  enum class Half { none, sum_of_bands, all };

  /// \throws InputError if it would not fit into memory.
  /// \param half  with `all`, its first surfaces too. \param sources  lights whose light is kept apart, too.
  Film(const PixelWindow& window, int bands, int groups, bool first_surfaces, Half half,
       std::size_t sources = 0);
  int end_pass() const { return first_pass + passes; }
  std::size_t sources() const { return light.empty() ? 0 : of_sources.size() / light.size(); }
  /// The sums of a pixel in a plane: the bands of all light, then those of each source.
  ExactSum& at(std::size_t index) {
    return index < light.size() ? light[index] : of_sources[index - light.size()];
  }
  bool has_first_surfaces() const { return !met.empty(); }

  /// The sums of a window within this one; and how they are put back.
  Film part(const PixelWindow& tile) const;
  void put(const Film& tile);

  /// Adds the sums of a piece: those of a window within this one, and what fell beside it into this one.
  /// Its passes are left to the caller.
  void add(const Film& piece);

 private:
  Film() = default;
};

}  // namespace petzval::render
