// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/band_plan.h>
#include <petzval/imaging/cell_choice.h>
#include <petzval/imaging/light_centre.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace petzval {

namespace {

/// How much larger an error may be than spectra along rows and columns say. They are means over where edges
/// lie on the cells, but edges may all lie alike: those of a checkerboard, which has hardly a wave aslant,
/// and those that meet in the middle of a star need all of this.
constexpr double caution_of_cells = 1.41;
/// What the blur may take of a tolerance, and cells at least and at most, as the table leaves it to them.
constexpr double of_blur = 0.5, least_of_cells = 0.5, most_of_cells = 0.85;

/// Samples of a scene along a side of a pixel, on the axis.
double samples_per_pixel(const Scene& scene, const LensDataTable& table, double wavelength_nm,
                         const SensorGeometry& sensor, const RadialFit& fit) {
  const double corner_mm = half_diagonal_mm(sensor), pitch_mm = sensor.pitch_um * mm_per_um;
  const SceneMap map(table, {}, fit, wavelength_nm, scene, corner_mm);
  return map.samples_per_mm_at(pitch_mm, 0) * pitch_mm;
}

/// Of noise as strong as what neighbouring samples differ by, over the scene's mean: in cells of which so
/// many make a sample.
double contrast_of(const SceneDetail& detail, double cells_per_sample) {
  return detail.mean > 0 ? cells_per_sample * std::sqrt(detail.variance_of_neighbours) / detail.mean : 0;
}

}  // namespace

SamplingErrors::SamplingErrors(const SceneDetail& detail, const FrameTransfer& lens, const Photosite& site,
                               int cells)
    : site_(site), cells_(cells), light_(detail.mean * detail.mean), power_(DetailBands::count) {
  std::array<std::vector<PassedWaves>, FrameZones::count> by_zone;
  parallel_for(by_zone.size(), [&](std::size_t zone) { by_zone[zone] = lens.passed(zone, cells); });
  for (std::size_t zone = 0; zone < FrameZones::count; ++zone) {
    const std::vector<PassedWaves>& passed = by_zone[zone];
    for (std::size_t band = 0; band < DetailBands::count; ++band) {
      const double power = detail.power[zone][band];
      const double wanted = site.transform(DetailBands::middle_cpp(band), 0).real();
      power_[band].by_lens += power * passed[band].by_lens;
      power_[band].on_cells += power * passed[band].on_cells;
      power_[band].both += power * passed[band].both;
      light_ += power * wanted * wanted * passed[band].by_lens / 2;  // strips of both kinds have it
    }
  }
}

double SamplingErrors::with(const SourceFilter& source) const {
  const PixelTaps taps = pixel_taps(site_, cells_, {source, true});
  double error = 0;
  for (std::size_t band = 0; band < DetailBands::count; ++band) {
    if (power_[band].by_lens == 0 && power_[band].on_cells == 0) continue;
    const double f = DetailBands::middle_cpp(band);
    error +=
        power_[band].error(taps.transform(f, 0) * source.transform(f / cells_), site_.transform(f, 0).real());
  }
  return light_ > 0 ? std::sqrt(std::max(0.0, error) / light_) : 0;
}

LightPath CellChoice::path(int points) const {
  return {SourceFilter(window ? std::max(parts, points) : 1, threefold), window};
}

CellChoice choose_cells(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                        const ImagingOptions& options, KnownDetail* known) {
  if (options.method == BlurMethod::none) {
    CellChoice as_they_are;
    as_they_are.cells = options.cells_per_pixel();
    as_they_are.window = false;
    return as_they_are;
  }
  const int middle = scene.bands() / 2;
  const double wavelength_nm = scene.wavelengths_nm()[static_cast<std::size_t>(middle)];
  const double samples = samples_per_pixel(scene, table, wavelength_nm, sensor, options.fit);
  const FrameTransfer lens(table, wavelength_nm, sensor);
  KnownDetail nothing;
  const SceneDetail& detail = (known != nullptr ? known : &nothing)->of(scene, middle, samples, sensor);
  // From little work to much.
  struct Filter {
    int parts;
    double threefold;
    /// Of a cell, about: means of the scene, and the rest.
    double work() const { return parts * parts + 6; }
  };
  constexpr std::array<Filter, 7> filters{
      {{1, 0}, {2, 0.25}, {2, 0.5}, {2, 0.75}, {2, 1}, {3, 0.75}, {3, 1}}};
  const auto with = [&](int cells, const Filter& filter, const SamplingErrors& errors) {
    CellChoice choice;
    choice.cells = cells;
    choice.parts = filter.parts;
    choice.threefold = filter.threefold;
    choice.sampling_error = caution_of_cells * errors.with(SourceFilter(filter.parts, filter.threefold));
    choice.contrast = contrast_of(detail, cells / samples);
    return choice;
  };
  const auto best = [&](int cells) {
    const SamplingErrors errors(detail, lens, options.photosite, cells);
    CellChoice best = with(cells, filters[0], errors);
    for (const Filter& filter : filters)
      if (const CellChoice other = with(cells, filter, errors); other.sampling_error < best.sampling_error)
        best = other;
    return best;
  };
  if (options.supersample != 0) return best(options.supersample);
  const double tolerance = options.product.tolerance;
  const double left =
      tolerance * tolerance * (1 - of_blur * of_blur) - std::pow(table.interpolation_error, 2);
  // What a table misses beyond the tolerance, no cells make good.
  const double limit =
      std::clamp(std::sqrt(std::max(0.0, left)), least_of_cells * tolerance, most_of_cells * tolerance);
  std::optional<CellChoice> cheapest;
  double least_work = INFINITY;
  // One cell holds little more than what the tolerance of a preview asks for.
  for (int cells = options.is_preview() ? 1 : 2; cells <= ImagingOptions::most_cells; ++cells) {
    if (cells * cells * filters[0].work() >= least_work) break;
    const SamplingErrors errors(detail, lens, options.photosite, cells);
    for (const Filter& filter : filters) {
      const double work = cells * cells * filter.work();
      if (work >= least_work) break;
      const CellChoice choice = with(cells, filter, errors);
      if (choice.sampling_error > limit) continue;
      cheapest = choice;
      least_work = work;
    }
  }
  return cheapest ? *cheapest : best(ImagingOptions::most_cells);
}

}  // namespace petzval
