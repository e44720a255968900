// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/imaging/exact_blur.h>

#include <algorithm>

namespace petzval {

namespace {

/// Adds light × kernel, its middle at (row, column) of the result, which may lie outside.
void scatter(const Kernel& kernel, double light, int row, int column, const SensorGeometry& grid,
             std::vector<double>& sums) {
  const int top = row - kernel.radius, left = column - kernel.radius, size = kernel.size();
  const int from = std::max(0, -left), to = std::min(size, grid.columns - left);
  for (int i = std::max(0, -top); i < std::min(size, grid.rows - top); ++i) {
    const double* weights = kernel.weights.data() + static_cast<std::ptrdiff_t>(i) * size;
    double* out = sums.data() + static_cast<std::ptrdiff_t>(top + i) * grid.columns;
    for (int j = from; j < to; ++j) out[left + j] += light * weights[j];
  }
}

}  // namespace

CellPlane blur_exact(const CellPlane& source, const PsfField& psfs, int margin,
                     const ProgressCallback& progress) {
  CellPlane result(grown(source.grid, -margin));
  std::vector<double> sums(result.values.size());
  // Rows far enough apart to write to different rows work at the same time, turn by turn.
  const auto turns = std::min(static_cast<std::size_t>(2 * psfs.radius() + 1), source.rows());
  for (std::size_t turn = 0; turn < turns; ++turn) {
    const std::size_t count = (source.rows() - turn + turns - 1) / turns;
    parallel_for(count, [&](std::size_t i) {
      const std::size_t row = turn + i * turns;
      for (std::size_t column = 0; column < source.columns(); ++column) {
        const double light = double(source.row(row)[column]);
        if (light == 0) continue;
        const Kernel kernel =
            psfs.kernel_at(source.grid.x_mm(double(column) + 0.5), source.grid.y_mm(double(row) + 0.5));
        scatter(kernel, light, static_cast<int>(row) - margin, static_cast<int>(column) - margin, result.grid,
                sums);
      }
    });
    if (progress) progress(double(turn + 1) / double(turns), "blur");
  }
  std::transform(sums.begin(), sums.end(), result.values.begin(),
                 [](double sum) { return static_cast<float>(sum); });
  return result;
}

}  // namespace petzval
