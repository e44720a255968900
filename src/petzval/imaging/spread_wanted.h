// SPDX-License-Identifier: BSD-3-Clause
// How closely a table of one image must say how light spreads, and how far two kernels are apart.
#pragma once

#include <petzval/imaging/kernel_maker.h>

namespace petzval {

/// How closely a table must say how light spreads.
struct SpreadWanted {
  double cell_um = 0;    ///< of the cells that the image will be formed on
  double tolerance = 0;  ///< ProductOptions::tolerance
  double tail_um = 0;    ///< light that lands farther from its chief ray is formed apart; 0: none is
  double contrast = 1;   ///< of noise in such cells, over its mean, for which the tolerance is to hold

  bool of_a_preview() const;
  /// Of the kernels that are compared.
  LatticeSteps steps() const { return of_a_preview() ? LatticeSteps::coarse : LatticeSteps::fine; }
};

/// Of a scene whose cells differ by so much over their mean: the contrast of noise that stands for it. With
/// up to 2.5 an error that is estimated for noise as strong as its mean has a caution that covers it, but not
/// of lights in darkness.
double contrast_of_noise(double contrast);

/// √(Σd²/(1/c² + Σh²)), d the difference, h the weights of `more`: the relative error of an image of noise of
/// contrast c.
double kernel_difference(const Kernel& few, const Kernel& more, double contrast);

}  // namespace petzval
