// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/units.h>
#include <petzval/base/version.h>
#include <petzval/colour/band_light.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/flare/starburst.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/simulate/flare.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

namespace petzval {

namespace {

std::string suns_text(std::size_t count) {
  return count == 1 ? "a sun" : fmt::format("{} suns", count);
}

void add_layer(const SpectralImage& layer, SpectralImage& light) {
  if (layer.columns() != light.columns() || layer.rows() != light.rows() ||
      layer.wavelengths_nm() != light.wavelengths_nm() || layer.pitch_um() != light.pitch_um())
    throw InputError("a layer of light has another frame or other bands than the picture it is added to");
  for (int band = 0; band < light.bands(); ++band) {
    const std::span<float> to = light.band(band);
    const std::span<const float> from = layer.band(band);
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
    light.release_memory();
  }
}

/// Nobody meters by the suns themselves.
void mark_lamps(const SpectralImage& suns, SpectralImage& light) {
  if (light.lamps.empty()) light.lamps.resize(light.band_size());
  for (int band = 0; band < suns.bands(); ++band) {
    const std::span<const float> values = suns.band(band);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i] > 0) light.lamps[i] = 1;
  }
}

/// Suns are geometric, whose stars begin where they end; what the scene holds has been blurred.
SpectralImage stars_of(const LitLens& lens, const SensorGeometry& frame,
                       const std::vector<double>& wavelengths_nm, const FlareLayers& layers,
                       const GhostLightOptions& how, const Context& context) {
  const std::span<const BrightSource> all(layers.sources);
  SpectralImage stars = result_within(context, [&](const ProgressCallback&) {
    return starburst_light(lens.lens, frame, wavelengths_nm, all.first(layers.sun_count), how);
  });
  const SpectralImage held = result_within(context, [&](const ProgressCallback&) {
    return starburst_light(lens.lens, frame, wavelengths_nm, all.subspan(layers.sun_count), how, lens.psf_mm);
  });
  for (int band = 0; band < stars.bands(); ++band)
    std::ranges::transform(stars.band(band), held.band(band), stars.band(band).begin(), std::plus<>());
  stars.provenance = fmt::format("petzval {} stars: {} sources through {}", version(), layers.sources.size(),
                                 lens.lens.name);
  return stars;
}

}  // namespace

BrightSource Sun::at(const std::vector<double>& wavelengths_nm) const {
  constexpr double most_deg = 80;
  if (!(std::abs(right_deg) < most_deg && std::abs(up_deg) < most_deg))
    throw InputError(
        fmt::format("a sun at {:g}, {:g} degrees; less than {:g} from the axis would be right (`sun`)",
                    right_deg, up_deg, most_deg));
  if (!(illuminance_lx > 0 && std::isfinite(illuminance_lx)))
    throw InputError(fmt::format("a sun of {:g} lx; more than 0 would be right (`sun`)", illuminance_lx));
  if (!(diameter_deg >= 0 && diameter_deg <= 60))
    throw InputError(fmt::format("`sun_diameter_deg` is {:g}; 0 to 60 would be right", diameter_deg));
  const Spectrum spectrum = illuminant(light);
  const double seen_lx = luminance(spectrum);
  if (!(seen_lx > 0))
    throw InputError(
        fmt::format("no eye sees {}, so that lux say nothing of it; a light within 370 to 730 nm would be "
                    "right (`sun_light`)",
                    light));
  BrightSource source;
  source.name = fmt::format("sun at {:g}, {:g} degrees", right_deg, up_deg);
  source.right = std::tan(radians(right_deg));
  source.up = std::tan(radians(up_deg));
  source.radius_rad = radians(diameter_deg) / 2;
  for (const double value : band_light(spectrum, wavelengths_nm))
    source.irradiance.push_back(value * illuminance_lx / seen_lx);
  return source;
}

Sun parse_sun(const std::string& text) {
  const std::size_t comma = text.find(','), colon = text.find(':');
  const std::optional<double> right = parse_number(text.substr(0, comma));
  const std::optional<double> up =
      comma == std::string::npos
          ? std::nullopt
          : parse_number(text.substr(comma + 1, colon == std::string::npos ? colon : colon - comma - 1));
  Sun sun;
  const std::optional<double> lux =
      colon == std::string::npos ? sun.illuminance_lx : parse_number(text.substr(colon + 1));
  if (!right || !up || !lux || (colon != std::string::npos && colon < comma))
    throw InputError(
        fmt::format("'{}' is no sun: degrees to the right and up, as in 20,15, or with its "
                    "illuminance in lux, 20,15:80000, would be right (`sun`)",
                    text));
  sun.right_deg = *right;
  sun.up_deg = *up;
  sun.illuminance_lx = *lux;
  return sun;
}

FlareLayers flare_layers(const LitLens& lens, const SensorGeometry& frame,
                         const std::vector<double>& wavelengths_nm, const SourcesFound& found,
                         const FlareOptions& options, const Context& context) {
  GhostLightOptions how;
  how.losses = lens.losses;
  how.clip = lens.clip;
  how.sensor = lens.sensor, how.reflections = options.ghost_reflections;
  how.neglected_share = options.neglected_share;
  FlareLayers layers;
  for (const Sun& sun : options.suns) layers.sources.push_back(sun.at(wavelengths_nm));
  layers.sun_count = layers.sources.size();
  if (layers.sun_count > 0) {
    layers.suns = result_within(context, [&](const ProgressCallback& progress) {
      return straight_light(lens.lens, frame, wavelengths_nm, layers.sources, how, progress);
    });
    layers.suns->provenance =
        fmt::format("petzval {}: {} through {}", version(), suns_text(layers.sun_count), lens.lens.name);
  }
  if (!options.seeks()) return layers;
  layers.sources.insert(layers.sources.end(), found.sources.begin(), found.sources.end());
  if (found.left_out > 0 && (options.ghosts || options.starburst))
    send_note(context, fmt::format("the {} brightest sources are followed; {} more, with {:.2g} of "
                                   "their light, are left out",
                                   found.sources.size(), found.left_out, found.left_out_share));
  if (layers.sources.empty() && (options.ghosts || options.starburst))
    send_note(context,
              "nothing in the scene is bright enough for light that goes astray to be followed; a lower "
              "`ghost_threshold` or "
              "a `sun` would be");
  if (options.starburst) layers.stars = stars_of(lens, frame, wavelengths_nm, layers, how, context);
  if (!options.ghosts) return layers;
  if (const Losses losses = lens.losses.of(lens.lens);
      !losses.fresnel && !losses.air_glass && losses.surfaces.empty())
    send_note(context,
              "ghosts are those of bare glass, which takes nothing from the picture itself unless "
              "`fresnel` counts it");
  layers.ghosts = result_within(context, [&](const ProgressCallback& progress) {
    return ghost_light(lens.lens, frame, wavelengths_nm, layers.sources, how, progress, &layers.report);
  });
  layers.ghosts->provenance = fmt::format(
      "petzval {} ghosts: {} sources through {}, {} ways, {:.1e} of their light neglected", version(),
      layers.sources.size(), lens.lens.name, layers.report.followed, layers.report.neglected_share);
  return layers;
}

Lens scattering_lens(const Lens& lens, const std::optional<Scatter>& surfaces_scatter) {
  require_glass(lens, "scatter needs");
  require_no_bends(lens, "scatter needs");
  require_clean_mirrors(lens);
  if (surfaces_scatter) return with_scatter(lens, *surfaces_scatter);
  if (!states_scatter(lens))
    throw InputError(fmt::format(
        "{} does not say how its surfaces scatter; roughness=1.5 would be right (`scatter`)", lens.name));
  return lens;
}

void add_scatter(const LitLens& lens, const FlareOptions& options, FlareLayers& layers, SpectralImage& light,
                 const Context& context) {
  ScatterLightOptions how;
  how.losses = lens.losses;
  how.clip = lens.clip;
  how.surround = options.scatter_surround;
  const Lens scattering = scattering_lens(lens.lens, options.surfaces_scatter);
  layers.scatter = result_within(context, [&](const ProgressCallback& progress) {
    return scatter_light(scattering, light, layers.sources, how, progress, &layers.scatter_report);
  });
  layers.scatter->provenance = fmt::format("petzval {} scatter: {:.3g} of the light through {}", version(),
                                           layers.scatter_report.scattered_share, lens.lens.name);
  add_layer(*layers.scatter, light);
  light.provenance += fmt::format("; {:.3g} of the light scattered", layers.scatter_report.scattered_share);
}

void add_layers(const FlareLayers& layers, SpectralImage& light) {
  for (const std::optional<SpectralImage>* layer : {&layers.suns, &layers.ghosts, &layers.stars})
    if (*layer) add_layer(**layer, light);
  if (layers.suns) mark_lamps(*layers.suns, light);
  if (layers.suns) light.provenance += fmt::format("; {}", suns_text(layers.sun_count));
  if (layers.stars) light.provenance += fmt::format("; stars of {} sources", layers.sources.size());
  if (layers.ghosts)
    light.provenance +=
        fmt::format("; ghosts of {} sources, {} ways", layers.sources.size(), layers.report.followed);
}

}  // namespace petzval
