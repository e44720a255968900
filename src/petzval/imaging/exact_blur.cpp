// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/imaging/exact_blur.h>

#include <algorithm>

namespace petzval {

namespace {

/// Whether a kernel is seen in a mirror, and which way.
struct Mirrored {
  bool rows = false, columns = false;
};

/// Adds light × kernel, its middle at (row, column) of the result, which may lie outside.
void scatter(const Kernel& kernel, const Mirrored& mirrored, double light, int row, int column,
             const SensorGeometry& grid, std::vector<double>& sums) {
  const int top = row - kernel.radius, left = column - kernel.radius, size = kernel.size();
  const int from = std::max(0, -left), to = std::min(size, grid.columns - left);
  for (int i = std::max(0, -top); i < std::min(size, grid.rows - top); ++i) {
    const int of_kernel = mirrored.rows ? size - 1 - i : i;
    const double* weights = kernel.weights.data() + static_cast<std::ptrdiff_t>(of_kernel) * size;
    double* out = sums.data() + static_cast<std::ptrdiff_t>(top + i) * grid.columns;
    if (mirrored.columns)
      for (int j = from; j < to; ++j) out[left + j] += light * weights[size - 1 - j];
    else
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
        scatter(kernel, {}, light, static_cast<int>(row) - margin, static_cast<int>(column) - margin,
                result.grid, sums);
      }
    });
    if (progress) progress(double(turn + 1) / double(turns), "blur");
  }
  std::transform(sums.begin(), sums.end(), result.values.begin(),
                 [](double sum) { return static_cast<float>(sum); });
  return result;
}

CellPlane blur_mirrored(const CellPlane& source, const PsfField& psfs, int margin) {
  CellPlane result(grown(source.grid, -margin));
  std::vector<double> sums(result.values.size());
  const std::size_t rows = source.rows(), columns = source.columns(), half = (rows + 1) / 2;
  const auto turns = std::min(static_cast<std::size_t>(2 * psfs.radius() + 1), half);
  const auto cell = [&](std::size_t row, std::size_t column, const Kernel& kernel, const Mirrored& mirrored) {
    const double light = double(source.row(row)[column]);
    if (light != 0)
      scatter(kernel, mirrored, light, static_cast<int>(row) - margin, static_cast<int>(column) - margin,
              result.grid, sums);
  };
  // Rows above the axis, each with that below, work at the same time as those of blur_exact() do.
  for (std::size_t turn = 0; turn < turns; ++turn)
    parallel_for((half - turn + turns - 1) / turns, [&](std::size_t i) {
      const std::size_t row = turn + i * turns, other_row = rows - 1 - row;
      for (std::size_t column = 0; column < (columns + 1) / 2; ++column) {
        const std::size_t other_column = columns - 1 - column;
        if (source.row(row)[column] == 0 && source.row(row)[other_column] == 0 &&
            source.row(other_row)[column] == 0 && source.row(other_row)[other_column] == 0)
          continue;
        const Kernel kernel =
            psfs.kernel_at(source.grid.x_mm(double(column) + 0.5), source.grid.y_mm(double(row) + 0.5));
        const bool two_rows = other_row != row, two_columns = other_column != column;
        cell(row, column, kernel, {});
        if (two_columns) cell(row, other_column, kernel, {false, true});
        if (two_rows) cell(other_row, column, kernel, {true, false});
        if (two_rows && two_columns) cell(other_row, other_column, kernel, {true, true});
      }
    });
  std::transform(sums.begin(), sums.end(), result.values.begin(),
                 [](double sum) { return static_cast<float>(sum); });
  return result;
}

}  // namespace petzval
