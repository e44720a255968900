// SPDX-License-Identifier: BSD-3-Clause
// The text files from which ISET imports a lens: ISETPARMS.TXT, distortion, illumination and PSF listings.
#pragma once

#include <petzval/base/staged_files.h>
#include <petzval/optics/formats/iset_mat_table.h>

#include <string>
#include <vector>

namespace petzval {

/// Whose conventions hold where files do not say.
enum class ListingProgram { zemax, codev };

/// Reads the files beside an ISETPARMS file, or the one *ISETPARMS*.TXT of a folder. With its base name:
///   <base>_DI_.dat   height of the real chief ray [mm], a row a field height, a column a wavelength
///   <base>_RI_.dat   relative illumination, likewise
///   <base>_2D_PSF_Fld<i>_Wave<j>.dat, or <base>_PSF_<i>_<j>.dat   listings (psf_listing.h), i and j from 1
///   <base>_PETZVAL.json   what Petzval keeps beside them, where it wrote them
/// Upper and lower case are the same, a base name loses its extension if need be.
///
/// Away from the axis is where the listing's image point lies (y upwards on the page); in a listing that does
/// not say, down for Zemax, since ISET's macros place the field at −y′, and up for CODE V.
/// \throws InputError naming what is missing or wrong.
RayTraceFile read_zemax_table(const std::string& path, ListingProgram program, const PsfLie& lie = {});

/// Writes the files into a folder, staged: they appear with files.commit().
/// \param base_name  of the files. \returns notes. \throws InputError, Failure as StagedFiles.
std::vector<std::string> write_zemax_table(const RayTraceData& data, const std::string& folder,
                                           const std::string& base_name, StagedFiles& files);

}  // namespace petzval
