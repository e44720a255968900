// SPDX-License-Identifier: BSD-3-Clause
// The native lens file, "petzval-lens/1" (docs/CONVENTIONS.md). lens_to_json() and lens_from_json() of
// lens_file.h are implemented here too.
#pragma once

#include <petzval/lens/formats/json_document.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/ray_transfer.h>

namespace petzval {

inline constexpr const char* native_format = "petzval-lens/1";

/// The names of the kinds in the file, in the order of the enumerations.
inline constexpr const char* aperture_keys[] = {
    "f_number",  "working_f_number",           "image_na",
    "object_na", "entrance_pupil_diameter_mm", "stop_semi_diameter_mm"};
inline constexpr const char* field_types[] = {"angle_deg", "object_height_mm", "paraxial_image_height_mm",
                                              "real_image_height_mm"};

/// As JSON has it. Bytes that are not UTF-8 cannot stand there; they become the replacement character.
std::string quoted(const std::string& text);

/// \throws InputError for whatever is not exactly in the format, or not a valid lens.
Lens read_native(const JsonDocument& document, const LensReadOptions& options);

/// The ray transfer of a surface.
std::shared_ptr<const RayTransfer> read_transfer(const JsonEntry& entry);
std::string transfer_text(const RayTransfer& transfer);

/// How a surface, or the lens, scatters.
Scatter read_scatter(const JsonEntry& entry);
std::string scatter_text(const Scatter& scatter);

/// The coating of a surface: the name of a bundled one, a reflectance, pairs of wavelength [nm] and
/// reflectance, or a stack of films.
Coating read_surface_coating(const JsonEntry& entry);
std::string coating_text(const Coating& coating);
/// The entries of a stack of films, which may be more than these.
Coating read_coating_stack(const JsonEntry& entry);

}  // namespace petzval
