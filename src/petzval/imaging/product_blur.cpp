// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/exact_blur.h>
#include <petzval/imaging/product_blur.h>

#include <cmath>
#include <cstddef>

namespace petzval {

namespace {

/// The cells of a ring, moved from one plane to another of the same grid.
void move_ring(const CellRing& ring, CellPlane& from, CellPlane& to) {
  for (std::size_t row = 0; row < from.rows(); ++row)
    for (std::size_t column = 0; column < from.columns(); ++column) {
      const double right = double(column) + 0.5 - double(from.grid.columns) / 2,
                   below = double(row) + 0.5 - double(from.grid.rows) / 2;
      if (!ring.holds(std::hypot(right, below))) continue;
      to.row(row)[column] = from.row(row)[column];
      from.row(row)[column] = 0;
    }
}

}  // namespace

CellPlane ProductBlur::blur(const CellPlane& source, int margin) const {
  if (plan().exact.empty()) return blur_by_product(source, margin);
  CellPlane inner = source, ring(source.grid);
  move_ring(plan().exact, inner, ring);
  CellPlane result = blur_by_product(inner, margin);
  const CellPlane exact = blur_exact(ring, *psfs_, margin);
  for (std::size_t i = 0; i < result.values.size(); ++i) result.values[i] += exact.values[i];
  return result;
}

}  // namespace petzval
