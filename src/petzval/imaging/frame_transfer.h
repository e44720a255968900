// SPDX-License-Identifier: BSD-3-Clause
// What a lens passes of waves, zone by zone of a frame, and what kernels on cells make of it.
#pragma once

#include <petzval/imaging/frame_zones.h>
#include <petzval/optics/lens_data_table.h>

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

namespace petzval {

/// What becomes of waves of one frequency, over the PSFs of a zone. Mean squares, relative to the contrast of
/// the scene.
struct PassedWaves {
  double by_lens = 0;   ///< of what the lens passes
  double on_cells = 0;  ///< of what kernels pass, without source filter and pixels
  double both = 0;      ///< of the product of the two

  /// Of what is wrong with the picture. \param of_cells  what source filter and taps pass. \param wanted what
  /// the photosite passes.
  double error(double of_cells, double wanted) const {
    return of_cells * of_cells * on_cells - 2 * of_cells * wanted * both + wanted * wanted * by_lens;
  }
};

/// The OTFs of a table's PSFs along the radius and across, about their centroids, by zones of a frame. A PSF
/// stands for the part of the frame that lies nearer to it than to others.
class FrameTransfer {
 public:
  FrameTransfer(const LensDataTable& table, double wavelength_nm, const SensorGeometry& sensor);

  /// By DetailBands. \param cells  a pixel; their kernels see PSFs through the window.
  std::vector<PassedWaves> passed(std::size_t zone, int cells) const;

 private:
  using Otf = std::vector<std::complex<float>>;  ///< at the middles of DetailBands
  struct Line {
    Otf otf;
    std::array<double, FrameZones::count> weight{};
  };

  /// A PSF, and how much of each zone it stands for with what it sends down and across.
  struct Share {
    std::size_t entry;
    std::array<double, FrameZones::count> down, across;
  };
  void add(const LensDataTable& table, const std::vector<Share>& shares, double pitch_um);

  /// Those in which no place of a coarse lattice lies: by all places.
  void fill_empty_zones();

  std::vector<Line> lines_;
};

}  // namespace petzval
