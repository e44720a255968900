// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/stop.h>
#include <petzval/colour/band_light.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/colour/rgb_to_spectrum.h>
#include <petzval/scene/formats/name_file.h>
#include <petzval/scene/photograph_scene.h>
#include <petzval/scene/scene_light.h>
#include <petzval/scene/wavelength_list.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <vector>

namespace petzval {

namespace {

/// A colour's reflectance, and by how much it outshines a surface.
struct LiftedColour {
  SigmoidReflectance reflectance;
  double factor = 1;
  double luminous = 0;  ///< factor × luminous reflectance
};

LiftedColour lifted(const std::array<float, 3>& rgb, const ReflectanceTable& table) {
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

/// The colours of some rows. Photographs of 8 bits have few beside their pixels, and a fit takes long: the
/// last one of each hash is kept.
class LiftedColours {
 public:
  /// \param pixels  that will be asked for.
  LiftedColours(const ReflectanceTable& table, const Brightness& brightness, std::size_t pixels)
      : table_(table),
        brightness_(brightness),
        kept_(std::bit_ceil(std::clamp(pixels / pixels_a_place, std::size_t{2}, most_places))) {}

  const LiftedColour& of(const std::array<float, 3>& rgb) {
    Kept& kept = kept_[place(rgb)];
    if (kept.rgb == rgb) return kept.colour;
    kept.rgb = rgb;
    kept.colour = lifted(rgb, table_);
    kept.colour.luminous = kept.colour.factor * brightness_(kept.colour.reflectance);
    return kept.colour;
  }

 private:
  static constexpr std::size_t pixels_a_place = 4, most_places = 1 << 18;
  struct Kept {
    std::array<float, 3> rgb{NAN, NAN, NAN};  // of no colour
    LiftedColour colour;
  };
  std::size_t place(const std::array<float, 3>& rgb) const {
    constexpr std::uint64_t odd = 0x9e3779b97f4a7c15;  // 2^64 over the golden ratio (Knuth's hashing)
    std::uint64_t sum = 0;
    for (const float value : rgb) sum = (sum ^ std::bit_cast<std::uint32_t>(value)) * odd;
    return static_cast<std::size_t>(sum >> (65 - std::bit_width(kept_.size())));
  }

  const ReflectanceTable& table_;
  const Brightness& brightness_;
  std::vector<Kept> kept_;
};

/// Fills a row of all bands with light × reflectance. \returns the sum of its luminous reflectances.
double lift_row(const Photograph& photograph, int row, LiftedColours& colours,
                const std::vector<double>& light, Scene& scene) {
  const auto columns = static_cast<std::size_t>(photograph.columns);
  const float* const rgb = photograph.row(row).data();
  std::vector<LiftedColour> pixels(columns);
  double luminous = 0;
  for (std::size_t i = 0; i < columns; ++i) {
    pixels[i] = colours.of({rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]});
    luminous += pixels[i].luminous;
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
  const std::size_t rows = luminous.size(),
                    parts = std::min(rows, 4 * static_cast<std::size_t>(thread_count()));
  parallel_tasks(parts, [&](std::size_t part) {
    const std::size_t first = part * rows / parts, end = (part + 1) * rows / parts;
    LiftedColours lifted(table, brightness, (end - first) * static_cast<std::size_t>(photograph.columns));
    for (std::size_t row = first; row < end; ++row) {
      check_stop();
      luminous[row] = lift_row(photograph, static_cast<int>(row), lifted, light, scene);
    }
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
