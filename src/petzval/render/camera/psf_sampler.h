// SPDX-License-Identifier: BSD-3-Clause
// Places drawn as a point-spread function has its light.
#pragma once

#include <petzval/wave/psf.h>

#include <array>
#include <vector>

namespace petzval::render {

/// Inverts the cumulative sums of a PSF: rows first, then columns within the row. Light lies evenly over the
/// square about each sample. Where samples stand for values of a band-limited PSF, what that square would
/// take from its contrast is given back to them beforehand, to the fourth order of their spacing.
class PsfSampler {
 public:
  /// \param samples  that the values are of the PSF at their places, not its light in their cells.
  PsfSampler(const Psf& psf, bool samples);

  /// Along s and t of Psf [µm] for two numbers in [0, 1).
  std::array<double, 2> place(double u, double v) const;

 private:
  int size_;
  double spacing_um_;
  std::vector<float> rows_, columns_;  ///< light up to the end of each: of all, and of its row
};

}  // namespace petzval::render
