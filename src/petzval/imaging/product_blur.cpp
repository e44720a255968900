// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/exact_blur.h>
#include <petzval/imaging/product_blur.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace petzval {

namespace {

/// A share of each cell's light, by its distance from the axis, moved from one plane to another of the same
/// grid.
template <typename ShareAt>
void move_light(const ShareAt& share_at, CellPlane& from, CellPlane& to) {
  for (std::size_t row = 0; row < from.rows(); ++row)
    for (std::size_t column = 0; column < from.columns(); ++column) {
      const double right = double(column) + 0.5 - double(from.grid.columns) / 2,
                   below = double(row) + 0.5 - double(from.grid.rows) / 2;
      const float light = from.row(row)[column], moved = share_at(std::hypot(right, below)) * light;
      to.row(row)[column] = moved;
      from.row(row)[column] = light - moved;
    }
}

void add(const CellPlane& more, CellPlane& sum) {
  for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += more.values[i];
}

}  // namespace

CellPlane ProductBlur::blur(const CellPlane& source, int margin) const {
  if (plan().exact.empty() && !inner_)  // no light is moved, so that none need be copied
    return std::visit([&](const auto& by) { return by.blur(source, margin); }, by_);
  if (plan().exact.empty()) return blur_by_product(source, margin);
  CellPlane rest = source, ring(source.grid);
  move_light([&](double radius) { return plan().exact.holds(radius) ? 1.0F : 0.0F; }, rest, ring);
  CellPlane result = blur_by_product(std::move(rest), margin);
  add(psfs_->symmetry() == KernelSymmetry::mirrored ? blur_mirrored(ring, *psfs_, margin)
                                                    : blur_exact(ring, *psfs_, margin),
      result);
  return result;
}

CellPlane ProductBlur::blur_by_product(CellPlane source, int margin) const {
  const auto by_own_tiles = [&] {
    return std::visit([&](const auto& by) { return by.blur(source, margin); }, by_);
  };
  if (!inner_) return by_own_tiles();
  CellPlane light(source.grid);
  const double end = inner_->plan().zone.to;
  const auto share_at = [&](double radius) {
    return static_cast<float>(std::clamp((end - radius) / ProductPlan::fade, 0.0, 1.0));
  };
  move_light(share_at, source, light);
  CellPlane result = by_own_tiles();
  add(inner_->blur(light, margin), result);
  return result;
}

}  // namespace petzval
