// SPDX-License-Identifier: BSD-3-Clause
// Lists of wavelengths as users write them.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace petzval {

/// "400:10:700" (from, step, to), "450,550,650", "587.5618", and mixtures. \returns nm, strictly increasing.
/// \throws InputError, for µm too, saying what would be right.
std::vector<double> parse_wavelengths_nm(const std::string& text);

/// Those of the bands that are meant, for messages: "350, 790 to 800". Empty if none is.
std::string runs_of_bands(const std::vector<double>& bands_nm,
                          const std::function<bool(double nm)>& is_meant);

}  // namespace petzval
