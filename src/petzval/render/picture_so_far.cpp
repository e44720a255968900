// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/render/picture_so_far.h>

#include <algorithm>
#include <limits>

namespace petzval::render {

namespace {

/// Pixels of which the light that comes straight from lamps is the greater part.
std::vector<std::uint8_t> lamps_of(const Film& film) {
  const std::size_t pixels = film.window.size();
  std::vector<double> light(pixels, 0.0);
  for (std::size_t i = 0; i < film.light.size(); ++i) light[i % pixels] += film.light[i].value();
  std::vector<std::uint8_t> lamps(pixels);
  std::ranges::transform(film.lamps, light, lamps.begin(),
                         [](const ExactSum& lamp, double all) { return lamp.value() > all / 2 ? 1 : 0; });
  return std::ranges::count(lamps, 1) > 0 ? lamps : std::vector<std::uint8_t>();
}

/// Samples a pixel of a group that are in a film.
int samples_of(const Film& film, const Passes& passes, int group) {
  return passes.taken(group, film.end_pass()) - passes.taken(group, film.first_pass);
}

/// The light of the scene, as it falls on what is seen: each band has as many rays as its group.
std::optional<Spectrum> illuminant_of(const Film& film, const WavelengthGroups& groups,
                                      const Passes& passes) {
  std::vector<double> light;
  for (int band = 0; band < static_cast<int>(film.arriving.size()); ++band)
    light.push_back(film.arriving[static_cast<std::size_t>(band)].value() /
                    std::max(1, samples_of(film, passes, band % groups.count())));
  const double most = *std::ranges::max_element(light);
  if (light.size() < 2 || !(most > 0)) return {};
  for (double& value : light) value /= most;
  return Spectrum(groups.wavelengths_nm(), light);
}

FirstSurfaces first_surfaces(const Film& film, int groups, int samples_per_pixel) {
  const std::size_t pixels = film.window.size();
  const auto nothing = std::numeric_limits<float>::infinity();
  FirstSurfaces first;
  first.depth.assign(pixels, nothing), first.normal.assign(3 * pixels, 0), first.share.assign(pixels, 0);
  first.albedo.assign(film.albedo.size(), 0);
  for (std::size_t i = 0; i < pixels; ++i) {
    double met = 0;
    for (std::size_t at = i; at < film.met.size(); at += pixels) met += film.met[at].value();
    if (!(met > 0)) continue;
    first.share[i] = static_cast<float>(met / samples_per_pixel);
    first.depth[i] = static_cast<float>(film.depth[i].value() / met);
    const Vector3 normal = normalised(
        {film.normal[i].value(), film.normal[pixels + i].value(), film.normal[2 * pixels + i].value()});
    first.normal[3 * i] = static_cast<float>(normal.x);
    first.normal[3 * i + 1] = static_cast<float>(normal.y);
    first.normal[3 * i + 2] = static_cast<float>(normal.z);
    for (std::size_t band = 0; band * pixels < film.albedo.size(); ++band) {
      // Of the rays that carried this band.
      const double carried = film.met[band % static_cast<std::size_t>(groups) * pixels + i].value();
      if (carried > 0)
        first.albedo[band * pixels + i] =
            static_cast<float>(film.albedo[band * pixels + i].value() / carried);
    }
  }
  return first;
}

}  // namespace

Rendering picture_so_far(const Film& film, const WavelengthGroups& groups, const SensorGeometry& sensor,
                         const Photosite& photosite, const Passes& passes) {
  Rendering result;
  result.irradiance =
      SpectralImage(film.window.columns(), film.window.rows(), groups.wavelengths_nm(), sensor.pitch_um,
                    photosite.is_plain() ? PixelAperture::box : PixelAperture::photosite);
  if (!photosite.is_plain()) result.irradiance.photosite = photosite.text();
  result.irradiance.lamps = lamps_of(film);
  result.irradiance.illuminant = illuminant_of(film, groups, passes);
  const std::size_t pixels = film.window.size();
  const auto put = [&](SpectralImage& image, const ExactSum* sums) {
    for (int band = 0; band < image.bands(); ++band) {
      const std::span<float> plane = image.band(band);
      const double samples = std::max(1, samples_of(film, passes, band % groups.count()));
      for (std::size_t i = 0; i < pixels; ++i) plane[i] = static_cast<float>((sums++)->value() / samples);
    }
  };
  put(result.irradiance, film.light.data());
  for (std::size_t source = 0; source < film.sources(); ++source) {
    SpectralImage& image = result.light_groups.emplace_back(result.irradiance);
    put(image, film.of_sources.data() + source * film.light.size());
  }
  result.samples_per_pixel = passes.taken(film.end_pass()) - passes.taken(film.first_pass);
  result.rays = film.rays, result.passed = film.passed;
  if (film.has_first_surfaces())
    result.first_surfaces = first_surfaces(film, groups.count(), result.samples_per_pixel);
  return result;
}

Rendering cropped(Rendering picture, const PixelWindow& window, const PixelWindow& part) {
  if (part == window) return picture;
  const auto crop = [&](const auto& values, std::size_t each) {
    std::decay_t<decltype(values)> result;
    const std::size_t planes = values.size() / (window.size() * each);
    for (std::size_t plane = 0; plane < planes; ++plane)
      for (int row = part.top; row < part.bottom; ++row) {
        const auto begin =
            values.begin() +
            static_cast<std::ptrdiff_t>((plane * window.size() + window.index(part.left, row)) * each);
        result.insert(result.end(), begin, begin + static_cast<std::ptrdiff_t>(each) * part.columns());
      }
    return result;
  };
  const auto crop_image = [&](SpectralImage& all) {
    SpectralImage image(part.columns(), part.rows(), all.wavelengths_nm(), all.pitch_um(),
                        all.pixel_aperture());
    image.photosite = all.photosite, image.illuminant = all.illuminant;
    image.lamps = crop(all.lamps, 1);
    for (int band = 0; band < all.bands(); ++band) {
      const std::span<const float> plane = all.band(band);
      image.store_band(band, crop(std::vector<float>(plane.begin(), plane.end()), 1));
    }
    all = std::move(image);
  };
  crop_image(picture.irradiance);
  for (SpectralImage& each : picture.light_groups) crop_image(each);
  if (std::optional<FirstSurfaces>& first = picture.first_surfaces)
    first = FirstSurfaces{crop(first->depth, 1), crop(first->normal, 3), crop(first->albedo, 1),
                          crop(first->share, 1)};
  return picture;
}

void add_strays(std::span<const TileResult> results, std::size_t groups, bool half, Film& film) {
  // Groups of wavelengths have no band in common.
  parallel_for(groups, [&](std::size_t group) {
    for (const TileResult& tile : results)
      if (tile.done && !tile.strays.empty())
        for (const Stray& stray : tile.strays[group]) film.at(stray.at) += stray.light;
  });
  for (const TileResult& tile : results) {
    if (tile.done)
      for (const Stray& stray : tile.outside) film.outside[stray.at] += stray.light;
    if (half)
      for (const std::vector<Stray>& strays : tile.strays)
        for (const Stray& stray : strays)
          if (stray.at < film.light.size()) film.half[stray.at % film.half.size()] += stray.light;
    for (std::size_t band = 0; band < tile.arriving.size(); ++band)
      film.arriving[band] += tile.arriving[band];
    film.rays += tile.rays, film.passed += tile.passed;
  }
}

std::optional<Rendering> picture_of_stopped_pass(const std::vector<PixelWindow>& tiles,
                                                 const std::vector<TileResult>& results, Film& film,
                                                 const WavelengthGroups& groups, const SensorGeometry& sensor,
                                                 const Photosite& photosite, const Passes& passes) {
  const bool first = film.passes == 0;
  if (first && std::ranges::none_of(results, &TileResult::done)) return {};
  add_strays(results, static_cast<std::size_t>(groups.count()), false, film);
  if (first) film.passes = 1;
  Rendering picture = picture_so_far(film, groups, sensor, photosite, passes);
  picture.complete = false;
  if (first) return picture;
  for (int band = 0; band < picture.irradiance.bands(); ++band) {
    const int group = band % groups.count();
    const int before = std::max(1, samples_of(film, passes, group));
    const int now = passes.taken(group, film.end_pass() + 1) - passes.taken(group, film.first_pass);
    const float share = static_cast<float>(before) / static_cast<float>(std::max(1, now));
    const auto scale = [&](SpectralImage& image) {
      const std::span<float> plane = image.band(band);
      for (std::size_t i = 0; i < tiles.size(); ++i)
        if (results[i].done)
          for (int row = tiles[i].top; row < tiles[i].bottom; ++row)
            for (int column = tiles[i].left; column < tiles[i].right; ++column)
              plane[film.window.index(column, row)] *= share;
    };
    scale(picture.irradiance);
    for (SpectralImage& each : picture.light_groups) scale(each);
  }
  return picture;
}

}  // namespace petzval::render
