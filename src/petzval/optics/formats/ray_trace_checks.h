// SPDX-License-Identifier: BSD-3-Clause
// Whether the content of a file of another program can be that of a lens.
#pragma once

#include <petzval/optics/formats/ray_trace_data.h>

#include <string>
#include <vector>

namespace petzval {

/// \throws InputError unless every field has every wavelength, heights are finite and wavelengths are in nm.
void require_whole(const RayTraceData& data);

/// Whether the object is nearer than infinity: at `object_distance_mm`, seen at a magnification other than 0.
/// \param notes  get a line where only one of the two says so. \throws InputError for a distance that is not
/// positive, and for a magnification without a distance.
bool has_finite_object(const RayTraceData& data, std::vector<std::string>& notes);

/// Millimetres of paraxial image height per unit of object field: |efl| for objects at infinity, else |m|.
/// \throws InputError where it is missing, 0 or that of a lens that forms no image.
double height_scale(bool finite_object, double efl_mm, double magnification);

}  // namespace petzval
