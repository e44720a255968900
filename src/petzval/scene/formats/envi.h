// SPDX-License-Identifier: BSD-3-Clause
// ENVI images: a file of numbers and a header beside it.
#pragma once

#include <petzval/scene/spectral_cube.h>

#include <string>
#include <string_view>

namespace petzval {

/// Reads an ENVI image by its header (cube.hdr) or by the file of numbers (cube.img, .dat, .raw, .bsq, .bil,
/// .bip, .bin or no extension, with cube.hdr or cube.img.hdr beside it). All interleaves, both byte orders,
/// all real data types. Bands come sorted by wavelength, without those that `bbl` calls bad; numbers that
/// mean "no data" become 0. `reflectance scale factor` and `data reflectance gain values` make reflectances;
/// `data gain values` make radiance, in W·m⁻²·sr⁻¹·µm⁻¹ as ENVI has it, or in `data units`. \throws
/// InputError for a damaged header, data that are shorter or longer than it says, or more than a scene may
/// have, before room is made for them. \param check  is called before the numbers are read.
SpectralCube read_envi(const std::string& path, const CubeCheck& check = {});

/// Whether a path is read_envi()'s: a header, or a file with a header beside it.
bool is_envi_path(const std::string& path);

/// The file that read_envi() reads with this one: the numbers of a header, the header of a file of numbers.
/// Empty if there is none.
std::string envi_companion(const std::string& path);

/// The numbers of a header's data as they are in memory. \param file  for messages. \throws as read_envi.
SpectralCube decode_envi(std::string_view header_text, std::string_view data, const std::string& header_file,
                         const std::string& data_file);

}  // namespace petzval
