// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/imaging/layer_stack.h>

#include <algorithm>

namespace petzval {

namespace {

/// What is known of a cell is at least this part of a white world, lest negative lobes of kernels make it
/// vanish: half of what a guess weighs.
constexpr double least_known = 0.02;

}  // namespace

void LayerStack::add(int band, BlurredLayer layer) {
  if (layer.light.values.size() != CellPlane(grid_).values.size())
    throw InputError("a layer on another grid than the image");
  std::optional<CellPlane>& image = bands_[static_cast<std::size_t>(band)];
  if (!layer.white) {
    image = std::move(layer.light);
    return;
  }
  parallel_for(layer.light.rows(), [&](std::size_t row) {
    float* light = layer.light.row(row);
    const float* white = layer.white->row(row);
    const float* unknown = layer.unknown ? layer.unknown->row(row) : nullptr;
    const float* share = image && layer.share ? layer.share->row(row) : nullptr;
    const float* behind = image ? image->row(row) : nullptr;
    for (std::size_t column = 0; column < layer.light.columns(); ++column) {
      const double all = double(white[column]);
      if (!(all > 0)) {  // beyond the last field of the lens
        if (behind != nullptr) light[column] = behind[column];
        continue;
      }
      const double known =
          std::max(all - (unknown != nullptr ? double(unknown[column]) : 0.0), least_known * all);
      double result = double(light[column]) * all / known;
      if (share != nullptr) result += (1 - double(share[column]) / known) * double(behind[column]);
      light[column] = static_cast<float>(result);
    }
  });
  image = std::move(layer.light);
}

}  // namespace petzval
