// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/lights/alter_lights.h>
#include <petzval/render/lights/light_reader.h>
#include <petzval/render/media/emission_reader.h>

#include <algorithm>

namespace petzval::render {

namespace {

/// Of media whose colour is from place to place another.
void require_its_own_colour(const Parameters& parameters, const char* name) {
  if (parameters.find(colour_of_light))
    throw scene_error(parameters.location_of(name),
                      "a medium that shines by a grid of temperatures or colours takes no other colour");
}

double read_light_scale(const Parameters& parameters) {
  const double scale = parameters.number("Lescale", 1);
  if (!(scale >= 0 && scale <= densest))
    throw scene_error(parameters.location_of("Lescale"),
                      fmt::format("a scale of light of {:g}; 0 to {:g} would be right", scale, densest));
  return scale;
}

/// pbrt-v4's "temperature": its radiance is no luminance, but 1 at each black body's strongest wavelength.
void read_temperatures(const Parameters& parameters, const GridBox& box, const WavelengthGroups& groups,
                       const LightOptions& options, Emission& emission) {
  if (parameters.find("Le"))
    throw scene_error(parameters.location_of("Le"), "a medium shines either by \"Le\" or by \"temperature\"");
  require_its_own_colour(parameters, "temperature");
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
    const double scale = read_light_scale(parameters);
    for (Lanes& each : emission->radiance) each *= scale;
  }
  if (std::ranges::all_of(emission->radiance, &Lanes::is_black)) return nullptr;
  return emission;
}

std::shared_ptr<Emission> read_colour_emission(const Parameters& parameters, const GridBox& box,
                                               const WavelengthGroups& groups, const LightOptions& options) {
  const double scale =
      options.scale * parameters.number(strength_of_medium, 1) * read_light_scale(parameters);
  if (!parameters.find("Le")) return nullptr;
  require_its_own_colour(parameters, "Le");
  if (!parameters.find("sigma_a"))
    throw scene_error(parameters.location_of("Le"),
                      "a medium in colours shines only where it absorbs; "
                      "\"rgb sigma_a\" beside \"rgb Le\" would be right");
  // pbrt-v4 scales D65 to the ∫ ȳ dλ of an even spectrum of 1, and leaves it so here.
  constexpr double of_even_light = 106.856895;
  const SceneSpectrum d65 = white_light();
  auto emission = std::make_shared<Emission>();
  emission->radiance = groups.sampled([&](double) { return scale; });
  emission->colours = std::make_shared<const ColourSamples>(
      box.cells, read_grid_colours(parameters, "Le", box),
      groups.sampled([&](double nm) { return of_even_light / d65.photometric * d65.at(nm); }), groups);
  return scale > 0 ? emission : nullptr;
}

}  // namespace petzval::render
