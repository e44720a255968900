// SPDX-License-Identifier: BSD-3-Clause
// Entries of the formats that lens data tables come in, and maps of sharpness.
#pragma once

#include <string_view>

namespace petzval::fuzz {

/// ISET's structure is refused in one line, or makes a valid table that goes to ISET's terms and back the
/// same.
bool try_iset_mat_table(std::string_view bytes);
bool try_iset_mat_hdf5_table(std::string_view bytes);

/// Parameters are refused in one line, or come back the same when written.
bool try_isetparms(std::string_view bytes);

/// A listing is refused in one line, or makes a PSF that is listed and read back the same.
bool try_psf_listing(std::string_view bytes);

/// Measurements are refused in one line, or make a valid table, or one that is refused in one line.
bool try_measured(std::string_view bytes);

/// What Petzval keeps beside a table is refused in one line, or kept again the same.
bool try_kept(std::string_view bytes);

/// What `petzval sfr` prints of a picture is refused in one line, or makes edges whose numbers are all
/// finite.
bool try_sfr_map(std::string_view bytes);

}  // namespace petzval::fuzz
