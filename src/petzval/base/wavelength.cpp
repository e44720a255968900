// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/wavelength.h>

#include <cmath>

namespace petzval {

std::string wavelength_fault(double nm) {
  if (!(nm > 0) || !std::isfinite(nm))
    return fmt::format("{:g} is no wavelength; a positive number of nm would be right", nm);
  if (nm >= shortest_wavelength_nm) return {};
  // Twelve digits: 0.55 µm are 550 nm.
  constexpr double nm_per_um = 1e3, nm_per_m = 1e9;
  for (const double unit_nm : {nm_per_um, nm_per_m})
    if (nm * unit_nm >= shortest_wavelength_nm && nm * unit_nm <= shortest_wavelength_nm * nm_per_um)
      return fmt::format("wavelengths are in nm; {:.12g} would be right for {:g}", nm * unit_nm, nm);
  return fmt::format("wavelengths are in nm; {:g} is none of light, which begins at {:g}", nm,
                     shortest_wavelength_nm);
}

void require_wavelength(double nm, const std::string& what) {
  const std::string fault = wavelength_fault(nm);
  if (!fault.empty()) throw InputError(what + ": " + fault);
}

}  // namespace petzval
