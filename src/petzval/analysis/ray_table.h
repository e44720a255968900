// SPDX-License-Identifier: BSD-3-Clause
// Rays in and out of a lens, as any program that traces it can write them.
#pragma once

#include <petzval/lens/ray_transfer.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// Rays through a lens from a front plane before it to a rear plane behind it; its file is described in
/// docs/RAY_TRANSFER.md.
struct RayTable {
  struct Row {
    double wavelength_nm = 0;
    TransferRay front, rear;
    std::vector<std::array<double, 2>> at_apertures;  ///< places [mm], as many as there are radii
  };
  std::string name;
  double length_mm = 0;                   ///< from the front plane to the rear plane
  double film_mm = 0;                     ///< from the rear plane to the film
  std::vector<double> aperture_radii_mm;  ///< the stop first
  std::vector<Row> rows;
};

/// \throws InputError with path and line.
RayTable read_ray_table(const std::string& path);
RayTable ray_table_of(std::string_view text, const std::string& path);
/// Every number survives.
std::string ray_table_text(const RayTable& table);

}  // namespace petzval
