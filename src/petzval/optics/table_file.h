// SPDX-License-Identifier: BSD-3-Clause
// The lens data table as one HDF5 file.
//
// With F fields, W wavelengths and PSFs of at most N × N samples, the file holds
//
//     /                      attributes format = "petzval-optics/1", lens_name, lens_json, provenance,
//                            object_distance_mm (infinity: inf), vertex_to_sensor_mm
//     object_field           [F] deg or mm (attribute units); dimension scale
//     wavelength             [W] nm; dimension scale
//     real_image_height      [F × W] mm
//     g_source, g_sensor     [F × W] sr
//     psf                    [F × W × N × N] float32, gzip: each PSF in the middle of its square (sample
//     [N/2][N/2]
//                            is the chief ray), zeros around it
//     psf_size               [F × W] samples a side that belong to the PSF
//     psf_spacing            [F × W] µm
//     psf_captured           [F × W] share of the light inside the window
//     first_order            group with the paraxial data as attributes, the unit in each name; those that
//                            are not known (NaN in memory) are left out
//
// Where places lie over the frame, format is "petzval-optics/2", F counts places (a dataset `place` numbers
// them), and instead of object_field and real_image_height there are
//
//     image_x, image_y       [X], [Y] mm, F = X × Y: place row · X + column
//     object_x, object_y     [F × W] deg or mm: the object's field as a vector
//     psf_azimuth            [F × W] deg: direction of a PSF's rows, anticlockwise from +y' as seen from the
//                            film; columns run a quarter turn clockwise from it
//
// with units and long_name on every dataset and dimension labels on every axis. A user block of 512 bytes in
// front, which HDF5 readers skip, holds size and checksum of the rest, so that a damaged file is told before
// HDF5, which damaged files crash, gets to see it. Files of the same layout without it (made in Python, say)
// are read on request.
#pragma once

#include <petzval/optics/lens_data_table.h>

#include <string>

namespace petzval {

/// Writes a table, whole or not at all; the same table gives the same bytes. Not to be called from two
/// threads at once, nor together with read_table: HDF5 has one state a process. \throws InputError if the
/// table is not valid, Failure if it cannot be written.
void write_table(const LensDataTable& table, const std::string& path);

enum class TableOrigin {
  petzval,   ///< begins with the checksum, or is refused
  elsewhere  ///< no checksum is asked for: a program of its own reads it, which a damaged file may crash
};

/// Reads a table and checks everything: layout, sizes (before any memory is taken for them), axes, values.
/// \throws InputError naming file and dataset.
LensDataTable read_table(const std::string& path, TableOrigin origin = TableOrigin::petzval);

/// Reads a table without a checksum and writes it with one, in this process, which a damaged file may crash.
/// \throws InputError, Failure as both.
void seal_table(const std::string& path, const std::string& sealed);

}  // namespace petzval
