// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/lights/alter_lights.h>
#include <petzval/render/lights/light_reader.h>
#include <petzval/render/media/emission_reader.h>

#include <algorithm>

namespace petzval::render {

namespace {

/// pbrt-v4's "temperature": its radiance is no luminance, but 1 at each black body's strongest wavelength.
void read_temperatures(const Parameters& parameters, const GridBox& box, const WavelengthGroups& groups,
                       const LightOptions& options, Emission& emission) {
  if (parameters.find("Le"))
    throw scene_error(parameters.location_of("Le"), "a medium shines either by \"Le\" or by \"temperature\"");
  if (parameters.find(colour_of_light))
    throw scene_error(parameters.location_of("temperature"),
                      "a medium that shines by its temperatures takes no other colour");
  const double otherwise = parameters.number("temperaturecutoff", 0),
               offset = parameters.number("temperatureoffset", otherwise),
               scale = parameters.number("temperaturescale", 1);
  emission.temperatures = std::make_shared<const Temperatures>(
      GridSamples(box.cells, read_grid_samples(parameters, "temperature", box, 0, "temperature")), offset,
      scale, groups);
  const double times = options.scale * parameters.number(strength_of_medium, 1);
  emission.radiance = groups.sampled([&](double) { return times; });
}

}  // namespace

std::shared_ptr<Emission> read_emission(const Parameters& parameters, const GridBox* box,
                                        const WavelengthGroups& groups, const LightOptions& options,
                                        Unsupported& unsupported) {
  auto emission = std::make_shared<Emission>();
  if (box && parameters.find("temperature"))
    read_temperatures(parameters, *box, groups, options, *emission);
  else
    emission->radiance = medium_radiance(parameters, groups, options, unsupported);
  if (box && parameters.find("Lescale")) {
    emission->strength = std::make_shared<const GridSamples>(
        box->cells, read_grid_samples(parameters, "Lescale", *box, 0, "scale of light"));
  } else if (!box) {
    const double scale = parameters.number("Lescale", 1);
    if (!(scale >= 0 && scale <= densest))
      throw scene_error(parameters.location_of("Lescale"),
                        fmt::format("a scale of light of {:g}; 0 to {:g} would be right", scale, densest));
    for (Lanes& each : emission->radiance) each *= scale;
  }
  if (std::ranges::all_of(emission->radiance, &Lanes::is_black)) return nullptr;
  return emission;
}

}  // namespace petzval::render
