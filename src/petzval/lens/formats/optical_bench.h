// SPDX-License-Identifier: BSD-3-Clause
// Text files of the Optical Bench of photonstophotos.net, where people keep prescriptions from patents.
#pragma once

#include <petzval/lens/lens_file.h>

#include <string>

namespace petzval {

/// Whether a text has the section `[lens data]`, by which such files are known.
bool is_optical_bench(const std::string& text);

/// Reads a lens, with a state for each setting: a column of `[variable distances]`, the first of which it is
/// left in. Glasses are those of the
/// catalogue where a row names one with the index that the row gives, else nd and Vd. The lens is open to
/// the f-number of the file, else to the diameter of its stop; fields go up to half of the angle of view.
/// \throws InputError with file and line.
LensFile read_optical_bench(const std::string& text, const std::string& file, const LensReadOptions& options);

}  // namespace petzval
