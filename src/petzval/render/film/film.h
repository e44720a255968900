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
  /// Of first surfaces, if wanted: sums over rays that met one, and how many did.
  std::vector<double> met, depth, normal, albedo;  ///< [pixel], [pixel], [pixel][3], [band][pixel]
  std::uint64_t rays = 0, passed = 0;
  int passes = 0;  ///< rounds of samples that are in the sums

  /// \throws InputError if it would not fit into memory.
  Film(const PixelWindow& window, int bands, bool first_surfaces, bool noise);
  bool has_first_surfaces() const { return !met.empty(); }
};

/// Saves a film, whole or not at all, and reads it back. `fingerprint` says what is being rendered.
/// \throws InputError if a file is damaged or belongs to another picture; Failure.
void write_checkpoint(const std::string& path, const Film& film, const std::string& fingerprint);
bool read_checkpoint(const std::string& path, Film& film, const std::string& fingerprint);

}  // namespace petzval::render
