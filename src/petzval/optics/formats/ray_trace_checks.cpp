// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/wavelength.h>
#include <petzval/optics/formats/ray_trace_checks.h>

#include <cmath>

namespace petzval {

namespace {

/// Zemax writes 10^10 mm for infinity.
constexpr double infinity_mm = 1e9;
/// At infinity the magnification is 0, or f over those 10^10 mm.
constexpr double magnification_at_infinity = 1e-6;
/// Numbers below are micrometres: no lens refracts light of 100 nm, and infrared ends before 100 µm.

void require_size(std::size_t size, std::size_t expected, const RayTraceData& data, const char* what) {
  if (size != expected)
    throw InputError(fmt::format("{} has {} values; {} field heights × {} wavelengths need {}", what, size,
                                 data.field_height_mm.size(), data.wavelengths_nm.size(), expected));
}

}  // namespace

void require_whole(const RayTraceData& data) {
  const std::size_t expected = data.field_height_mm.size() * data.wavelengths_nm.size();
  if (expected == 0) throw InputError("there are no field heights or no wavelengths");
  require_size(data.distorted_height_mm.size(), expected, data, "the geometry");
  require_size(data.relative_illumination.size(), expected, data, "the relative illumination");
  require_size(data.psf.size(), expected, data, "the list of PSFs");
  if (!data.transmittance.empty() && data.transmittance.size() != data.wavelengths_nm.size())
    throw InputError("the transmittance has another number of wavelengths");
  for (const double height : data.field_height_mm)
    if (!(std::isfinite(height) && height >= 0))
      throw InputError(fmt::format("a field height is {} mm; heights are finite and start at 0", height));
  for (const double nm : data.wavelengths_nm) require_wavelength(nm, "the wavelengths");
}

bool has_finite_object(const RayTraceData& data, std::vector<std::string>& notes) {
  const double distance = data.object_distance_mm, m = data.magnification;
  if (std::isnan(distance)) {
    if (std::abs(m) > magnification_at_infinity)
      throw InputError(fmt::format(
          "does not say the object distance, which a magnification of {:g} needs; a distance in mm, or a "
          "magnification of 0 and an object at infinity, would be right",
          m));
    notes.emplace_back("the file does not say the object distance: the object is taken to be at infinity");
    return false;
  }
  if (distance <= 0)
    throw InputError(fmt::format(
        "the object distance is {:g} mm; it counts from the object to the first vertex, so that a positive "
        "one (infinity: 1e10) would be right",
        distance));
  if (distance >= infinity_mm) return false;
  if (m == 0)
    notes.push_back(fmt::format(
        "the magnification is 0: the object is taken to be at infinity, though its distance is {:g} mm",
        distance));
  return m != 0;
}

double height_scale(bool finite_object, double efl_mm, double magnification) {
  const double scale = finite_object ? magnification : efl_mm;
  const char* const name = finite_object ? "magnification" : "focal length";
  if (std::isnan(scale))
    throw InputError(fmt::format(
        "the {} is missing: without it paraxial image heights and object fields cannot be turned into each "
        "other",
        name));
  if (!std::isfinite(scale) || scale == 0)
    throw InputError(fmt::format(
        "the {} is {:g}: with it paraxial image heights and object fields cannot be turned into each other",
        name, scale));
  return std::abs(scale);
}

}  // namespace petzval
