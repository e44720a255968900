// SPDX-License-Identifier: BSD-3-Clause
// The light of the cells of an image, from samples of its wave.
#pragma once

#include <petzval/wave/chord_kernel.h>

#include <cstddef>
#include <vector>

namespace petzval {

/// Finer samples of a wave without detail finer than a band allows, from its own: `factor` − 1 between two of
/// them, each a sum over `reach` neighbours on either side. Sinc under a window that keeps to the band (J. J.
/// Knab, IEEE Trans. Inf. Theory 25, 1979, eq. 20), to 1e-4 of the largest value at worst.
struct FinerSamples {
  int factor = 1, reach = 0;
  std::vector<float> weights;  ///< [1 … factor − 1][2·reach]

  /// For samples `step` apart, in units of those that the band just allows.
  static FinerSamples of_step(double step);

  /// Samples that `count` finer ones need. The first is reach − 1 before the first of these.
  int needed(int count) const { return (count + factor - 1) / factor + (reach > 0 ? 2 * reach - 1 : 0); }
  int before() const { return reach > 0 ? reach - 1 : 0; }
};

/// Cells of cell × cell samples. Column 0 of the cells lies about s = 0 and mirrors itself.
struct CellGrid {
  int columns = 0, rows = 0;  ///< of samples; multiples of cell
  int cell = 1;
  FinerSamples along_s, along_t;  ///< how they follow from those of the wave
};

/// cells[i·columns/cell + j] = Σ |U|² over the samples of each cell, with fourth-order weights at its edges.
void sum_cell_light(const WaveSamples& wave, const CellGrid& grid, std::vector<double>& cells);

}  // namespace petzval
