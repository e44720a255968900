// SPDX-License-Identifier: BSD-3-Clause
// What stands before the lens of the bench, and the bands in which a stage shows it.
#pragma once

#include <petzval/scene/scene.h>
#include <petzval/simulate/image.h>

#include <string>
#include <vector>

namespace petzval {

/// A flat scene that a page may choose.
struct BenchScene {
  std::string path = {};  ///< as read_scene() takes it
  /// Of a spectral file, whose samples and bands are what they are; empty: a chart or a photograph.
  std::vector<double> file_bands_nm = {};
  std::string usual_illuminant = {};    ///< of reflectances, unless the page names another
  std::size_t samples = 0;              ///< of a file
  std::vector<std::string> notes = {};  ///< what had to be assumed

  bool is_spectral() const { return !file_bands_nm.empty(); }
  /// Of the wavelengths that a stage would like, those within the bands of the file, with its ends in the
  /// place of what lies beyond. A file that ends before the visible or begins behind it: as many of its own
  /// bands, evenly spread. \returns strictly increasing.
  std::vector<double> wavelengths_nm(const std::vector<double>& liked_nm) const;
};

/// Reads a file to its end and says how it is to be asked for. \throws InputError for whatever read_scene()
/// refuses, for files that leave open what their numbers are, and for more than most_bench_values.
BenchScene bench_scene(const std::string& path);

/// Samples times bands that a scene of the bench has at most: 1 GiB.
constexpr std::size_t most_bench_values = std::size_t{1} << 28;

/// A spectral file at these wavelengths, to be placed. \param illuminant  empty: its own.
Scene read_bench_scene(const BenchScene& scene, const std::string& illuminant,
                       const std::vector<double>& wavelengths_nm);

/// Where the object of the table stands, and as wide as its sensor sees, as photographs are.
void place_bench_scene(Scene& scene, const TableCamera& optics, const ImageOptions& options);

}  // namespace petzval
