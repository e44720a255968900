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

  bool of_a_preview() const;
  /// Of the kernels that are compared.
  LatticeSteps steps() const { return of_a_preview() ? LatticeSteps::coarse : LatticeSteps::fine; }
};

/// √(Σd²/(1 + Σh²)), as ProductPlan::estimated_error.
double kernel_difference(const Kernel& few, const Kernel& more);

}  // namespace petzval
