// SPDX-License-Identifier: BSD-3-Clause
// What the relative illumination of a file is relative to.
#pragma once

#include <string>
#include <vector>

namespace petzval {

/// Files have relative illumination in per cent (CODE V prints it so): values that are 100 on the axis, to
/// the 1 % by which files round, are divided by 100. \param values  [field][wavelength], field-major, the
/// axis first. \param notes  get a line then.
void take_per_cent(std::vector<double>& values, std::size_t wavelengths, std::vector<std::string>& notes);

/// Of a uniform wall it is 1 on the axis at every wavelength. Programs that divide by the brightest point of
/// the field give less there: values are divided by what they are on the axis, unless that is 1 to 1 %, or
/// dark.
void make_relative_to_axis(std::vector<double>& values, std::size_t wavelengths,
                           std::vector<std::string>& notes);

}  // namespace petzval
