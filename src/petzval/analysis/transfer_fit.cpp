// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/transfer_fit.h>
#include <petzval/analysis/transfer_polynomials.h>
#include <petzval/analysis/transfer_samples.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

double middle_of(std::vector<double> list) {
  const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
  std::nth_element(list.begin(), middle, list.end());
  return *middle;
}

Lens lens_with(const Lens& lens, const std::shared_ptr<const RayTransfer>& transfer) {
  Lens result = lens;
  Surface front, rear;
  front.transfer = transfer;
  front.stop = true;
  front.thickness_mm = transfer->length_mm;
  front.semi_diameter_mm = transfer->aperture_radii_mm.front();
  rear.thickness_mm = lens.surfaces.back().thickness_mm;
  rear.semi_diameter_mm = transfer->largest_radius_mm;
  result.surfaces = {front, rear};
  result.groups.clear();
  result.tolerances.clear();
  result.aperture = {Aperture::Kind::stop_semi_diameter_mm, transfer->aperture_radii_mm.front()};
  return result;
}

/// At some heights, by how much the light that a film point sees is another.
double worst_light(const Lens& lens, const Lens& fit, double film_radius_mm) {
  constexpr int heights = 6;
  const double nm = lens.reference_wavelength_nm;
  FieldTracer real(lens, nm), fitted(fit, nm);
  double worst = 0;
  for (int i = 0; i < heights; ++i) {
    const double height = film_radius_mm * i / heights;
    const auto field = real.object_field_at_image_height(height);
    if (!field) continue;
    const auto a = real.chief_ray(*field), b = fitted.chief_ray(*field);
    if (!a || !b) continue;
    const double light = real.g_sensor_sr(*a);
    if (light > 0) worst = std::max(worst, std::abs(fitted.g_sensor_sr(*b) / light - 1));
  }
  return worst;
}

struct FoundTerms {
  int degree = 0;
  std::vector<TransferPowers> terms;
  TransferCoefficients bands;
};

FoundTerms terms_for(const TransferSamples& samples, const TransferFitRequest& request, double efl_mm,
                     const std::string& name) {
  const double mm = request.tolerance_mm, rad = mm / efl_mm;
  const int most = most_degree_for(samples);
  FoundTerms found;
  found.degree = request.degree.value_or(1);
  for (;; ++found.degree) {
    if (found.degree > most && most < highest_transfer_degree)
      throw InputError(
          fmt::format("{}: too few rays for polynomials of degree {}, and none of degree {} is within "
                      "{:g} mm, {:g} rad of them; more rays or a larger tolerance would be right",
                      name, found.degree, most, mm, rad));
    found.terms = powers_up_to(found.degree);
    found.bands = fitted_bands(samples, found.terms);
    if (request.degree || errors_of(samples, found.terms, found.bands).within(mm, rad)) break;
    if (found.degree == highest_transfer_degree)
      throw InputError(
          fmt::format("{}: no ray transfer of degree {} or less is within {:g} mm, {:g} rad of its rays; a "
                      "smaller film radius, a smaller stop or a larger tolerance would be right",
                      name, highest_transfer_degree, mm, rad));
  }
  const std::vector<TransferPowers> fewer = needed_terms(samples, found.terms, found.bands, mm, rad);
  if (fewer.size() < found.terms.size()) {
    const auto again = fitted_bands(samples, fewer);
    if (request.degree || errors_of(samples, fewer, again).within(mm, rad))
      found.terms = fewer, found.bands = again;
  }
  return found;
}

/// Without length.
RayTransfer transfer_of(const TransferSamples& samples, const FoundTerms& found) {
  RayTransfer transfer;
  transfer.unit_mm = transfer.largest_radius_mm = samples.unit_mm;
  transfer.terms = found.terms;
  for (std::size_t b = 0; b < found.bands.size(); ++b)
    transfer.bands.push_back({samples.wavelengths_nm[b], found.bands[b], {}});
  transfer.aperture_radii_mm = samples.radii_mm;
  // Light that goes elsewhere than to the film was not fitted, and does not pass.
  transfer.aperture_radii_mm.push_back(samples.film_radius_mm);
  return transfer;
}

/// \param lens  what else than its surfaces the fit has.
TransferFit fit_with(const TransferSamples& samples, const FoundTerms& found, const Lens& lens,
                     RayTransfer transfer) {
  TransferFit fit;
  for (const auto& band : found.bands)
    fit.determinant_error =
        std::max(fit.determinant_error, std::abs(band[0][0] * band[3][0] - band[1][0] * band[2][0] - 1));
  try {
    fit.lens = lens_with(lens, made_ready(std::move(transfer)));
  } catch (const InputError& error) {
    throw InputError(lens.name + ": " + error.what());
  }
  const TransferErrors errors = errors_of(samples, found.terms, found.bands);
  fit.accuracy.median_mm = middle_of(errors.mm);
  fit.accuracy.worst_mm = *std::max_element(errors.mm.begin(), errors.mm.end());
  fit.accuracy.median_rad = middle_of(errors.rad);
  fit.accuracy.worst_rad = *std::max_element(errors.rad.begin(), errors.rad.end());
  fit.accuracy.rays = errors.mm.size();
  fit.degree = found.degree;
  fit.terms = found.terms.size();
  return fit;
}

}  // namespace

TransferFit fit_transfer(const Lens& lens, const TransferFitRequest& request) {
  const TransferSamples samples = transfer_samples(lens, request);
  const FoundTerms found = terms_for(samples, request, std::abs(first_order(lens).efl_mm), lens.name);
  RayTransfer transfer = transfer_of(samples, found);
  transfer.length_mm = lens.total_track_mm() - lens.surfaces.back().thickness_mm;
  TransferFit fit = fit_with(samples, found, lens, std::move(transfer));
  fit.accuracy.worst_light = worst_light(lens, fit.lens, samples.film_radius_mm);
  return fit;
}

TransferFit fit_transfer(const RayTable& table, const TransferFitRequest& request) {
  const std::string name = table.name.empty() ? "a table of rays" : table.name;
  const TransferSamples samples = transfer_samples(table, request);
  const double film_radius_mm = samples.film_radius_mm;
  // The power, for what the tolerance of a place is worth in direction.
  const auto rough = fitted_bands(samples, powers_up_to(std::min(2, most_degree_for(samples))));
  const double power = std::abs(rough[rough.size() / 2][2][0]);
  if (!(power > 0)) throw InputError(name + ": has no power");
  const FoundTerms found = terms_for(samples, request, 1 / power, name);
  RayTransfer transfer = transfer_of(samples, found);
  transfer.length_mm = table.length_mm;
  Lens lens;
  lens.name = name;
  lens.wavelengths_nm = samples.wavelengths_nm;
  lens.reference_wavelength_nm = samples.wavelengths_nm[samples.wavelengths_nm.size() / 2];
  lens.fields = {Fields::Kind::paraxial_image_height_mm,
                 {0, 0.5 * film_radius_mm, 0.7 * film_radius_mm, 0.95 * film_radius_mm}};
  Surface last;
  last.thickness_mm = table.film_mm;
  lens.surfaces = {last};
  return fit_with(samples, found, lens, std::move(transfer));
}

RayTable ray_table(const Lens& lens, const TransferFitRequest& request) {
  const TransferSamples samples = transfer_samples(lens, request);
  RayTable table;
  table.name = lens.name;
  table.length_mm = lens.total_track_mm() - lens.surfaces.back().thickness_mm;
  table.film_mm = lens.surfaces.back().thickness_mm;
  table.aperture_radii_mm = samples.radii_mm;
  for (std::size_t b = 0; b < samples.wavelengths_nm.size(); ++b)
    for (const auto* rays : {&samples.fitted[b], &samples.held[b]})
      for (const TransferSample& sample : *rays)
        table.rows.push_back({samples.wavelengths_nm[b],
                              sample.front,
                              sample.rear,
                              {sample.at_apertures.begin(), sample.at_apertures.end() - 1}});
  return table;
}

}  // namespace petzval
