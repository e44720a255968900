// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/optics/table_interpolation.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr int lowest_order = 4, highest_order = 8;
/// Half the range of a table with a single wavelength [nm].
constexpr double single_wavelength_reach_nm = 0.5;
/// Rounding of a wavelength that was computed, not typed [nm].
constexpr double wavelength_rounding_nm = 1e-6;
/// A polynomial is handed on as a monotone cubic through this many points: of fourth order in 1/1024, it adds
/// less than 1e-10 of the range.
constexpr int polynomial_samples = 1025;

/// The three fits of the paper at one wavelength.
struct Polynomials {
  PolynomialFit height;              ///< over field; through the axis
  PolynomialFit g_source, g_sensor;  ///< over real image height
};

/// Field and height of the height polynomial at even steps of field, from the axis to the last field.
struct SampledHeights {
  std::vector<double> fields, heights_mm;
  bool monotone = true;
};

SampledHeights sampled_heights(const PolynomialFit& height, double last_field) {
  SampledHeights samples;
  for (int k = 0; k < polynomial_samples; ++k) {
    const double field = last_field * k / (polynomial_samples - 1);
    const double value = height(field);
    if (k > 0 && value <= samples.heights_mm.back()) samples.monotone = false;
    samples.fields.push_back(field);
    samples.heights_mm.push_back(value);
  }
  return samples;
}

}  // namespace

RadialFit RadialFit::parse(const std::string& text) {
  if (text == "monotone") return {};
  if (text.size() == 1 && text[0] >= '0' + lowest_order && text[0] <= '0' + highest_order)
    return {text[0] - '0'};
  throw InputError(fmt::format("there is no fit \"{}\"; use monotone, or a polynomial order from {} to {}",
                               text, lowest_order, highest_order));
}

/// The table at one wavelength, by field.
struct RadialProfiles::Columns {
  std::vector<double> fields, height_mm, g_source_sr, g_sensor_sr;

  Polynomials polynomials(int order) const {
    return {fit_polynomial(fields, height_mm, order, Powers::no_constant),
            fit_polynomial(height_mm, g_source_sr, order), fit_polynomial(height_mm, g_sensor_sr, order)};
  }
};

RadialProfiles::RadialProfiles(const LensDataTable& table, RadialFit fit)
    : fit_(fit),
      fields_(table.fields),
      wavelengths_nm_(table.wavelengths_nm),
      real_image_height_mm_(table.real_image_height_mm),
      g_source_sr_(table.g_source_sr),
      g_sensor_sr_(table.g_sensor_sr) {
  require_by_height(table, "curves over field height belong to centred lenses");
  if (fit.polynomial_order != 0 &&
      (fit.polynomial_order < lowest_order || fit.polynomial_order > highest_order))
    throw InputError(
        fmt::format("a fit of order {} was asked for; use monotone, or a polynomial order from {} to {}",
                    fit.polynomial_order, lowest_order, highest_order));
  const std::size_t needed =
      fit.polynomial_order == 0 ? 2 : static_cast<std::size_t>(fit.polynomial_order) + 1;
  if (fields_.size() < needed)
    throw InputError(
        fmt::format("the lens data table has {} fields; this fit needs {}", fields_.size(), needed));
}

RadialProfiles::Columns RadialProfiles::columns_at(double wavelength_nm) const {
  const bool single = wavelengths_nm_.size() == 1;
  const double reach = single ? single_wavelength_reach_nm : wavelength_rounding_nm;
  const double front = wavelengths_nm_.front(), back = wavelengths_nm_.back();
  if (!(wavelength_nm >= front - reach && wavelength_nm <= back + reach))
    throw InputError(
        fmt::format("the lens data table covers {} to {} nm, not {} nm; build it for more wavelengths", front,
                    back, wavelength_nm));
  const std::size_t count = wavelengths_nm_.size(),
                    below = single ? 0 : bracket(wavelengths_nm_, wavelength_nm);
  const std::size_t above = single ? 0 : below + 1;
  const double share = single ? 0
                              : std::clamp((wavelength_nm - wavelengths_nm_[below]) /
                                               (wavelengths_nm_[above] - wavelengths_nm_[below]),
                                           0.0, 1.0);
  const auto blended = [&](const std::vector<double>& values) {
    std::vector<double> column;
    for (std::size_t f = 0; f < fields_.size(); ++f)
      column.push_back((1 - share) * values[f * count + below] + share * values[f * count + above]);
    return column;
  };
  Columns columns{fields_, blended(real_image_height_mm_), blended(g_source_sr_), blended(g_sensor_sr_)};
  columns.height_mm.front() = 0;  // of the axis, but for rounding
  return columns;
}

RadialProfile RadialProfiles::at_wavelength(double wavelength_nm) const {
  using Start = MonotoneCubic::Start;
  Columns columns = columns_at(wavelength_nm);
  if (fit_.polynomial_order != 0) {
    const Polynomials polynomials = columns.polynomials(fit_.polynomial_order);
    SampledHeights samples = sampled_heights(polynomials.height, columns.fields.back());
    if (!samples.monotone)
      throw InputError(
          fmt::format("the polynomial of order {} through the image heights at {} nm turns back between "
                      "fields; use a lower order or the monotone fit",
                      fit_.polynomial_order, wavelength_nm));
    columns = {std::move(samples.fields), std::move(samples.heights_mm), {}, {}};
    for (const double height : columns.height_mm) {
      columns.g_source_sr.push_back(polynomials.g_source(height));
      columns.g_sensor_sr.push_back(polynomials.g_sensor(height));
    }
  }
  const Start even = fit_.polynomial_order == 0 ? Start::even : Start::free;
  const Start odd = fit_.polynomial_order == 0 ? Start::odd : Start::free;
  RadialProfile profile;
  profile.g_source_ = MonotoneCubic(columns.height_mm, std::move(columns.g_source_sr), even);
  profile.g_sensor_ = MonotoneCubic(columns.height_mm, std::move(columns.g_sensor_sr), even);
  profile.field_ = MonotoneCubic(std::move(columns.height_mm), std::move(columns.fields), odd,
                                 MonotoneCubic::Beyond::linear);
  return profile;
}

FitResiduals RadialProfiles::residuals_at(double wavelength_nm) const {
  const Columns columns = columns_at(wavelength_nm);
  if (fit_.polynomial_order == 0) return {};
  const Polynomials fits = columns.polynomials(fit_.polynomial_order);
  const double source = columns.g_source_sr.front(), sensor = columns.g_sensor_sr.front();
  return {fits.height.rms_residual * um_per_mm,
          fits.height.max_residual * um_per_mm,
          fits.g_source.rms_residual / source,
          fits.g_source.max_residual / source,
          fits.g_sensor.rms_residual / sensor,
          fits.g_sensor.max_residual / sensor,
          sampled_heights(fits.height, columns.fields.back()).monotone};
}

}  // namespace petzval
