// SPDX-License-Identifier: BSD-3-Clause
// A spectrum as one line of text, for attributes of files.
#pragma once

#include <petzval/colour/spectrum.h>

#include <string>
#include <string_view>

namespace petzval {

/// "400:0.12 410:0.13": wavelength [nm] and value, with the fewest digits that read back exactly.
std::string spectrum_text(const Spectrum& spectrum);

/// Reads what spectrum_text wrote. \throws InputError for anything else.
Spectrum parse_spectrum_text(std::string_view text);

}  // namespace petzval
