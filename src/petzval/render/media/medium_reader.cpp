// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/media/medium.h>
#include <petzval/render/spectra/named_spectra.h>

#include <algorithm>

namespace petzval::render {

namespace {

/// Far above any medium, far below what a float holds.
constexpr double densest = 1e12;

/// The coefficient `name`, 1 if there is none (pbrt-v4), times `scale`.
BandSpectrum read_coefficient(const Parameters& parameters, const char* name, double scale,
                              const WavelengthGroups& groups, Unsupported& unsupported) {
  const auto given = spectrum_parameter(parameters, name, SpectrumRole::unbounded, unsupported);
  const SceneSpectrum spectrum = given ? *given : constant_spectrum(1);
  return groups.sampled([&](double nm) {
    const double value = scale * spectrum.at(nm);
    if (!(value >= 0 && value <= densest))
      throw scene_error(
          parameters.location_of(name),
          fmt::format("a coefficient of {:g} at {:g} nm; 0 to {:g} would be right", value, nm, densest));
    return value;
  });
}

double read_scale(const Parameters& parameters) {
  const double scale = parameters.number("scale", 1);
  if (!(scale >= 0)) throw scene_error(parameters.location_of("scale"), "0 or more would be right");
  return scale;
}

double read_g(const Parameters& parameters) {
  const double g = parameters.number("g", 0);
  if (!(std::abs(g) < 1))
    throw scene_error(parameters.location_of("g"),
                      fmt::format("a mean cosine of {:g}; above -1 and below 1 would be right", g));
  return g;
}

Medium make_medium(const MediumDescription& description, const WavelengthGroups& groups,
                   Unsupported& unsupported) {
  const Parameters& parameters = description.entity.parameters;
  Medium medium;
  if (description.entity.type != "homogeneous") {
    unsupported.report(parameters.location(), fmt::format("a medium \"{}\"", description.entity.type));
    medium.absorption = medium.scattering = groups.sampled([](double) { return 0; });
    return medium;
  }
  const double scale = read_scale(parameters);
  if (const Parameter* preset = parameters.find("preset"))
    unsupported.report(preset->at, "a medium by \"preset\" (\"sigma_a\" and \"sigma_s\" say what it is)");
  medium.absorption = read_coefficient(parameters, "sigma_a", scale, groups, unsupported);
  medium.scattering = read_coefficient(parameters, "sigma_s", scale, groups, unsupported);
  medium.g = read_g(parameters);
  medium.scatters =
      std::ranges::any_of(medium.scattering, [](const Lanes& each) { return !each.is_black(); });
  parameters.find("type");
  unsupported.report_unused(parameters, fmt::format("medium \"{}\"", description.name));
  return medium;
}

}  // namespace

std::vector<Medium> make_media(const SceneDescription& scene, const WavelengthGroups& groups,
                               Unsupported& unsupported) {
  std::vector<Medium> media;
  for (const MediumDescription& description : scene.media)
    media.push_back(make_medium(description, groups, unsupported));
  return media;
}

}  // namespace petzval::render
