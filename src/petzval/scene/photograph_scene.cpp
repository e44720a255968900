// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/colour/band_light.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/colour/rgb_to_spectrum.h>
#include <petzval/scene/formats/name_file.h>
#include <petzval/scene/photograph_scene.h>
#include <petzval/scene/scene_light.h>
#include <petzval/scene/wavelength_list.h>

#include <algorithm>
#include <functional>
#include <numeric>

namespace petzval {

namespace {

/// A pixel's reflectance, and by how much it outshines a surface.
struct LiftedPixel {
  SigmoidReflectance reflectance;
  double factor = 1;
};

LiftedPixel lifted(const float* rgb, const ReflectanceTable& table) {
  const LinearRgb colour{rgb[0], rgb[1], rgb[2]};
  const double brightest = std::max({colour.r, colour.g, colour.b});
  if (brightest <= 1) return {table.refined(colour), 1};
  return {table.refined({colour.r / brightest, colour.g / brightest, colour.b / brightest}), brightest};
}

constexpr double first_told_nm = SigmoidReflectance::first_nm,
                 last_told_nm = first_told_nm + SigmoidReflectance::range_nm;

/// Whether surfaces have colours under a light.
bool shows_colours(const Spectrum& illuminant) {
  return is_visible(illuminant) && !is_narrow(illuminant);
}

/// The share of a light's luminance that a surface gives back.
using Brightness = std::function<double(const SigmoidReflectance&)>;

/// Under a light that need not be white.
Brightness brightness_under(const Spectrum& light) {
  constexpr double step_nm = 5;
  std::vector<double> nm;
  for (double at = first_told_nm; at <= last_told_nm; at += step_nm) nm.push_back(at);
  std::vector<double> shares = band_light(light, nm);
  const std::vector<Xyz> weights = Observer::cie_1931().weights(nm);
  for (std::size_t i = 0; i < nm.size(); ++i) shares[i] *= weights[i].y;
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= sum;
  return [nm, shares](const SigmoidReflectance& surface) {
    double seen = 0;
    for (std::size_t i = 0; i < nm.size(); ++i) seen += shares[i] * surface.at(nm[i]);
    return seen;
  };
}

void note_untold_bands(Scene& scene) {
  const std::string untold = runs_of_bands(scene.wavelengths_nm(),
                                           [](double nm) { return nm < first_told_nm || nm > last_told_nm; });
  if (!untold.empty())
    scene.notes.push_back(
        fmt::format("a photograph tells of reflectances from {:g} to {:g} nm; at {} nm they are taken to be "
                    "those of the nearer end",
                    first_told_nm, last_told_nm, untold));
}

/// The bands that colours are fitted in: the scene's own, so that what is seen in them is the photograph,
/// unless they are too few to see colours by.
std::vector<double> bands_of_fit(const std::vector<double>& bands_nm) {
  constexpr double short_end_nm = 420, long_end_nm = 680, widest_gap_nm = 20;
  bool see_colours = bands_nm.front() <= short_end_nm && bands_nm.back() >= long_end_nm;
  for (std::size_t i = 1; i < bands_nm.size(); ++i)
    see_colours = see_colours && bands_nm[i] - bands_nm[i - 1] <= widest_gap_nm;
  return see_colours ? bands_nm : std::vector<double>{};
}

/// Fills a row of all bands with light × reflectance. \returns the sum of its luminous reflectances.
double lift_row(const Photograph& photograph, int row, const Brightness& brightness,
                const ReflectanceTable& table, const std::vector<double>& light, Scene& scene) {
  const auto columns = static_cast<std::size_t>(photograph.columns);
  const float* const rgb = photograph.row(row).data();
  std::vector<LiftedPixel> pixels(columns);
  double luminous = 0;
  for (std::size_t i = 0; i < columns; ++i) {
    const bool repeated = i > 0 && std::equal(rgb + 3 * i, rgb + 3 * i + 3, rgb + 3 * (i - 1));
    pixels[i] = repeated ? pixels[i - 1] : lifted(rgb + 3 * i, table);
    luminous += pixels[i].factor * brightness(pixels[i].reflectance);
  }
  for (std::size_t band = 0; band < light.size(); ++band) {
    const double nm = std::clamp(scene.wavelengths_nm()[band], first_told_nm, last_told_nm);
    float* const out = scene.band(static_cast<int>(band)).data() + static_cast<std::size_t>(row) * columns;
    for (std::size_t i = 0; i < columns; ++i)
      out[i] = static_cast<float>(light[band] * pixels[i].factor * pixels[i].reflectance.at(nm));
  }
  return luminous;
}

}  // namespace

Scene photograph_scene(const Photograph& photograph, const PhotographOptions& options) {
  Scene scene(photograph.columns, photograph.rows,
              options.wavelengths_nm.empty() ? default_bands_nm() : options.wavelengths_nm,
              options.horizontal_angle_deg, options.distance_m);
  const Spectrum illuminant = petzval::illuminant(options.illuminant);
  const std::vector<double>& bands = scene.wavelengths_nm();
  const std::vector<double> light =
      light_in_bands(illuminant, options.illuminant, bands, options.band_width_nm);
  const bool colours = shows_colours(illuminant), visible = is_visible(illuminant);
  const ReflectanceColour colour =
      colours ? ReflectanceColour(illuminant, bands_of_fit(bands)) : ReflectanceColour::d65();
  Brightness brightness = [&](const SigmoidReflectance& surface) {
    return colour.luminous_reflectance(surface);
  };
  if (visible && !colours) brightness = brightness_under(illuminant);
  const ReflectanceTable table(colour);

  std::vector<double> luminous(static_cast<std::size_t>(photograph.rows));
  parallel_for(luminous.size(), [&](std::size_t row) {
    luminous[row] = lift_row(photograph, static_cast<int>(row), brightness, table, light, scene);
  });
  const double mean =
      std::accumulate(luminous.begin(), luminous.end(), 0.0) / static_cast<double>(photograph.pixels());
  if (!(mean > 0)) throw InputError("the photograph is black all over: no light makes it a scene");
  scene.illuminant = illuminant;
  note_untold_bands(scene);
  scene.scale(visible ? options.mean_luminance_cd_m2 / (mean * luminance(illuminant))
                      : invisible_level(illuminant, scene));
  return scene;
}

Scene read_photograph_scene(const std::string& path, const PhotographOptions& options) {
  return naming_file(path,
                     [&] { return photograph_scene(read_photograph(path, options.encoding), options); });
}

}  // namespace petzval
