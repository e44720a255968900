// SPDX-License-Identifier: BSD-3-Clause
// Field values of any kind, turned into object fields.
#pragma once

#include <petzval/lens/lens.h>

#include <vector>

namespace petzval {

/// "angle_deg", "object_height_mm", "paraxial_image_height_mm", "real_image_height_mm".
const char* to_string(Fields::Kind kind);

/// "deg" or "mm".
const char* field_unit(Fields::Kind kind);

/// `count` ≥ 2 fields in even steps from zero to the largest of `fields`, with the sign of that.
std::vector<double> even_fields(const std::vector<double>& fields, int count);

/// The object field (degrees when the object is at infinity, else object height in mm) of a field value.
/// Image heights are paraxial or real at the lens's reference wavelength. An angle on a finite object is
/// measured at the entrance pupil; an object height needs a finite object. \throws InputError when the lens
/// cannot have such a field, or no chief ray reaches that real height.
double object_field(const Lens& lens, Fields::Kind kind, double value);

/// Where a perfect lens would image an object field [mm, signed]: f tan θ, or m h.
double ideal_image_height_mm(const Lens& lens, double object_field, double wavelength_nm);

}  // namespace petzval
