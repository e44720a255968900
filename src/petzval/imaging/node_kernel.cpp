// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/imaging/node_kernel.h>

#include <cstddef>
#include <utility>

namespace petzval {

Kernel kernel_at_node(const PsfField& psfs, const OutwardAxis& across, const OutwardAxis& down, double column,
                      double row, bool mirrored) {
  const double cell_mm = psfs.cell_um() * mm_per_um;
  const double x_mm = across.position(column) * cell_mm, y_mm = down.position(row) * cell_mm;
  Kernel kernel = psfs.kernel_at(mirrored ? x_mm : -x_mm, y_mm);  // columns run along −x'
  if (mirrored)
    for (int i = -kernel.radius; i <= kernel.radius; ++i)
      for (int j = 1; j <= kernel.radius; ++j) std::swap(kernel.at(i, j), kernel.at(i, -j));
  return kernel;
}

std::vector<float> cell_weights(const std::vector<double>& nodes, int tile) {
  const auto cells = static_cast<std::size_t>(tile);
  std::vector<float> result(nodes.size() * cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::vector<double> weights = lagrange_weights(nodes, double(cell) / tile);
    for (std::size_t a = 0; a < nodes.size(); ++a) result[a * cells + cell] = static_cast<float>(weights[a]);
  }
  return result;
}

}  // namespace petzval
