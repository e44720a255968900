// SPDX-License-Identifier: BSD-3-Clause
// Lens data tables for other programs.
#pragma once

#include <petzval/optics/lens_data_table.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

enum class TableTarget {
  iset,  ///< a MAT file with ISETCam's optics structure
  zemax  ///< a folder of text files as ISET imports them
};

/// The one grid of all PSFs that these files need.
struct TableExport {
  bool resample = false;                      ///< brings PSFs of several grids to one
  std::optional<double> psf_spacing_um = {};  ///< absent: the finest of the table; implies resample
  std::optional<int> psf_size = {};           ///< samples a side; absent: the widest PSF's; implies resample
  std::optional<double> psf_light = {};       ///< least share of its light that each PSF keeps; absent: 0.99
};

/// Writes a table for another program: a file, or a folder that is made if need be.
///
///     TableExport how;
///     how.resample = true;
///     export_table(read_table("edmund.h5"), TableTarget::iset, "edmund.mat", how);
///
/// \returns notes: of the grid, and of what the files cannot say.
/// \throws InputError for a table that the files cannot hold, a grid too large, or one that loses more light
/// than `psf_light` allows; Failure if it cannot be written.
std::vector<std::string> export_table(const LensDataTable& table, TableTarget target,
                                      const std::string& output, const TableExport& how = {});

}  // namespace petzval
