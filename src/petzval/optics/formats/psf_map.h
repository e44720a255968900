// SPDX-License-Identifier: BSD-3-Clause
// PSFs over the frame as arrays: maps that other programs computed or somebody measured.
#pragma once

#include <petzval/optics/formats/ray_trace_data.h>

#include <string>

namespace petzval {

/// A table over the frame from an archive of NumPy arrays (.npz). All is as a picture shows it: x to the
/// right, y downwards, from the middle of the frame.
///
/// | array | shape | |
/// |---|---|---|
/// | `psf` | (rows, columns, wavelengths, height, width) | light about the places, in any unit; the sample
/// [height/2][width/2], whole numbers from 0, is at the place. (rows, columns, height, width) with one
/// wavelength | | `x_mm`, `y_mm` | (columns), (rows) | the places, increasing, two or more of each | |
/// `wavelengths_nm` | (wavelengths) | increasing | | `spacing_um` | one number | from sample to sample | |
/// `focal_length_mm` | one number | | | `f_number` | one number | needed unless the level of the light is
/// given | | `relative_illumination` | (rows, columns[, wavelengths]) | absent: even | | `paraxial_x_mm`,
/// `paraxial_y_mm` | (rows, columns) | where a lens without distortion would image what is imaged at the
/// place; absent: there | | `object_distance_mm`, `magnification` | one number each | absent: an object at
/// infinity |
///
/// A place is common to all wavelengths: lateral colour moves the light in the windows of the PSFs.
/// \throws InputError naming the array, and what would be right.
ImportedTable read_psf_map(const std::string& path, const RayTraceReading& reading = {});

}  // namespace petzval
