// SPDX-License-Identifier: BSD-3-Clause
// Where light is gathered.
#pragma once

#include <petzval/render/film/pixel_window.h>
#include <petzval/render/path_tracer.h>
#include <petzval/render/spectra/wavelength_groups.h>

#include <string>
#include <vector>

namespace petzval::render {

/// Sums over samples; doubles, so that a million of them lose nothing.
struct Film {
  PixelWindow window;
  std::vector<double> light;  ///< sums over samples, [band][pixel]
  std::vector<double> half;   ///< of every second pass, summed over bands: tells the noise if that is wanted
  std::vector<double> lamps;  ///< light that comes straight from a lamp, summed over bands
  /// Of first surfaces, if wanted: how many rays of each group of wavelengths met one, and sums over them.
  std::vector<double> met, depth, normal, albedo;  ///< [group][pixel], [pixel], [3][pixel], [band][pixel]
  std::vector<double> arriving;  ///< light that comes straight to what is seen, summed over rays, [band]
  std::uint64_t rays = 0, passed = 0;
  int passes = 0;  ///< rounds of samples that are in the sums

  /// \throws InputError if it would not fit into memory.
  Film(const PixelWindow& window, int bands, int groups, bool first_surfaces, bool noise);
  bool has_first_surfaces() const { return !met.empty(); }

  /// The sums of a window within this one; and how they are put back.
  Film part(const PixelWindow& tile) const;
  void put(const Film& tile);

 private:
  Film() = default;
};

/// Saves a film, whole or not at all, and reads it back. `fingerprint` says what is being rendered.
/// \throws InputError if a file is damaged or belongs to another picture; Failure.
void write_checkpoint(const std::string& path, const Film& film, const std::string& fingerprint);
bool read_checkpoint(const std::string& path, Film& film, const std::string& fingerprint);

}  // namespace petzval::render
