// SPDX-License-Identifier: BSD-3-Clause
// Grids of samples, as media have them.
#pragma once

#include <petzval/render/media/density_grid.h>
#include <petzval/render/pbrt/scene_description.h>

#include <memory>

namespace petzval::render {

/// Far above any medium, far below what a float holds.
inline constexpr double densest = 1e12;

/// "nx", "ny" and "nz" of a medium, and from where to where its box reaches: "p0" and "p1".
struct GridBox {
  std::array<int, 3> cells;
  Vector3 low, high;

  double count() const { return static_cast<double>(cells[0]) * cells[1] * cells[2]; }
};

/// \throws InputError with file, line and column.
GridBox read_grid_box(const MediumDescription& description);

/// Numbers from `least` to densest, one for each cell. \param what  for messages: "density". \throws
/// InputError.
std::vector<float> read_grid_samples(const Parameters& parameters, const char* name, const GridBox& box,
                                     double least, const char* what);

/// Colours "rgb", one for each cell and none negative, three numbers each. \throws InputError.
std::vector<double> read_grid_colours(const Parameters& parameters, const char* name, const GridBox& box);

/// \throws InputError for a box without volume.
std::shared_ptr<const DensityGrid> make_density_grid(const MediumDescription& description, const GridBox& box,
                                                     std::vector<float> values);

}  // namespace petzval::render
