// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/band_plan.h>
#include <petzval/imaging/cell_choice.h>
#include <petzval/imaging/light_centre.h>
#include <petzval/imaging/pixel_gather.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>

namespace petzval {

namespace {

constexpr int steps_below_samples = 6;  ///< of drawings
constexpr double finest_shown_cpp = 0.5;

/// The MTF of a table's PSFs along both axes, RMS over the frame.
class FrameMtf {
 public:
  FrameMtf(const LensDataTable& table, double wavelength_nm, const SensorGeometry& sensor) : squares_(steps) {
    const std::size_t wavelength = bracketing_wavelengths(table, wavelength_nm).front().first;
    const double corner_mm = half_diagonal_mm(sensor);
    double weights = 0;
    if (table.frame) {
      // Places lie evenly; those beyond the frame by less than a mesh stand for its edge.
      const FramePlaces& frame = *table.frame;
      const double half_x = sensor.width_mm() / 2 + (frame.x_mm[1] - frame.x_mm[0]) / 2,
                   half_y = sensor.height_mm() / 2 + (frame.y_mm[1] - frame.y_mm[0]) / 2;
      for (std::size_t place = 0; place < table.places(); ++place) {
        if (std::abs(frame.x_mm[place % frame.x_mm.size()]) > half_x ||
            std::abs(frame.y_mm[place / frame.x_mm.size()]) > half_y)
          continue;
        const std::size_t entry = table.index(place, wavelength);
        if (table.g_source_sr.at(entry) == 0 || !table.has_psf(entry)) continue;
        add(table.psf.at(entry), sensor.pitch_um, 1);
        ++weights;
      }
      if (weights == 0) add(table.psf.front(), sensor.pitch_um, weights = 1);
    }
    for (std::size_t field = 0; field < table.fields.size(); ++field) {
      const std::size_t entry = table.index(field, wavelength);
      const double height_mm = table.real_image_height_mm.at(entry);
      if (!table.has_psf(entry)) continue;
      // The area of the frame about a height grows with it; the axis stands for the first step. A field
      // stands for those about it that have no PSF.
      const double weight = std::max(height_mm, corner_mm / double(2 * table.fields.size())) *
                            stands_for(table, field, wavelength);
      if (height_mm > corner_mm && weights > 0) break;
      add(table.psf.at(entry), sensor.pitch_um, weight);
      weights += weight;
    }
    for (double& square : squares_) square /= weights;
  }

  double operator()(double f_cpp) const {
    const double at = f_cpp / step_cpp;
    const auto below = static_cast<std::size_t>(at);
    if (below + 1 >= squares_.size()) return 0;
    const double beyond = at - double(below);
    return std::sqrt((1 - beyond) * squares_[below] + beyond * squares_[below + 1]);
  }

 private:
  /// So many fields.
  static double stands_for(const LensDataTable& table, std::size_t field, std::size_t wavelength) {
    const auto without_psf = [&](std::size_t at) {
      return at < table.fields.size() && !table.has_psf(table.index(at, wavelength));
    };
    double fields = 1;
    for (std::size_t at = field + 1; without_psf(at); ++at) fields += 0.5;
    for (std::size_t at = field; at > 0 && without_psf(at - 1); --at) fields += 0.5;
    return fields;
  }

  static constexpr double step_cpp = 0.1;
  static constexpr std::size_t steps = 250;

  void add(const Psf& psf, double pitch_um, double weight) {
    const auto size = static_cast<std::size_t>(psf.size);
    std::vector<double> across(size), down(size);
    double sum = 0;
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = 0; j < size; ++j) {
        const double light = double(psf.values[i * size + j]);
        across[j] += light;
        down[i] += light;
        sum += light;
      }
    if (!(sum > 0)) return;
    const double step = psf.spacing_um / pitch_um;
    for (std::size_t k = 0; k < steps; ++k) {
      const double f = double(k) * step_cpp;
      if (f * step > 0.5) break;  // the samples say no more
      for (const std::vector<double>* light : {&across, &down}) {
        // Horner's rule for the polynomial whose value at a turn is the transform.
        const std::complex<double> turn = std::polar(1.0, 2 * pi * f * step);
        std::complex<double> value = 0;
        for (const double one : *light) value = value * turn + one;
        squares_[k] += weight * std::norm(value) / (2 * sum * sum);
      }
    }
  }

  std::vector<double> squares_;
};

/// Samples of a scene along a side of a pixel, on the axis.
double samples_per_pixel(const Scene& scene, const LensDataTable& table, double wavelength_nm,
                         const SensorGeometry& sensor, const RadialFit& fit) {
  const double corner_mm = half_diagonal_mm(sensor), pitch_mm = sensor.pitch_um * mm_per_um;
  const SceneMap map(table, {}, fit, wavelength_nm, scene, corner_mm);
  return map.samples_per_mm_at(pitch_mm, 0) * pitch_mm;
}

/// Of noise that has no other detail than that between neighbouring samples, over its mean: in cells of which
/// so many make a sample.
double contrast_of(const DetailSpectrum& detail, double cells_per_sample) {
  // Of the variance of white noise, three quarters lie within squares of two samples a side.
  constexpr double of_white = 0.75;
  const std::size_t finest = detail.drawn ? steps_below_samples : 0;
  if (detail.variances.size() <= finest || !(detail.mean > 0)) return 0;
  return cells_per_sample * std::sqrt(detail.variances[finest] / of_white) / detail.mean;
}

/// DetailSpectrum of squares that begin with this row and column.
DetailSpectrum detail_from(std::size_t first, const Scene& scene, int band) {
  std::size_t stride = static_cast<std::size_t>(scene.columns());
  std::size_t columns = stride - first, rows = static_cast<std::size_t>(scene.rows()) - first;
  std::vector<float> finer;  // means of the squares before
  const std::span<const float> light = scene.band(band);
  const float* values = light.data() + std::min(first * (stride + 1), light.size());
  DetailSpectrum detail;
  while (columns >= 2 && rows >= 2) {
    const std::size_t across = columns / 2, down = rows / 2;
    std::vector<float> means(across * down);
    std::vector<double> squares(down), sums(down);
    parallel_for(down, [&](std::size_t row) {
      const float *upper = values + 2 * row * stride, *lower = upper + stride;
      for (std::size_t column = 0; column < across; ++column) {
        const std::array<double, 4> four{double(upper[2 * column]), double(upper[2 * column + 1]),
                                         double(lower[2 * column]), double(lower[2 * column + 1])};
        const double mean = (four[0] + four[1] + four[2] + four[3]) / 4;
        for (const double one : four) squares[row] += (one - mean) * (one - mean) / 4;
        sums[row] += mean;
        means[row * across + column] = static_cast<float>(mean);
      }
    });
    double variance = 0, sum = 0;
    for (std::size_t row = 0; row < down; ++row) {
      variance += squares[row];
      sum += sums[row];
    }
    detail.variances.push_back(variance / double(across * down));
    detail.mean = sum / double(across * down);
    finer = std::move(means);
    values = finer.data();
    columns = stride = across;
    rows = down;
  }
  return detail;
}

}  // namespace

DetailSpectrum detail_of(const Scene& scene, int band) {
  DetailSpectrum detail = detail_from(0, scene, band);
  // Edges of charts often lie between squares of every size; squares that begin a sample later hold them.
  const DetailSpectrum beside = detail_from(1, scene, band);
  for (std::size_t i = 0; i < beside.variances.size(); ++i)
    detail.variances[i] = (detail.variances[i] + beside.variances[i]) / 2;
  if (scene.drawing() == nullptr || detail.variances.empty()) return detail;
  detail.drawn = true;
  for (int step = 0; step < steps_below_samples; ++step) {
    detail.variances.insert(detail.variances.begin(), detail.variances.front() / 2);
    detail.finest_side /= 2;
  }
  return detail;
}

SamplingError sampling_error(const DetailSpectrum& detail, double samples_per_pixel, const Photosite& site,
                             int cells, const LightPath& path, const std::function<double(double)>& mtf) {
  const PixelTaps taps = pixel_taps(site, cells, path);
  // Where in its octave the detail of a square's side lies [cycles a side], evenly.
  constexpr std::array<double, 4> places{0.28, 0.34, 0.40, 0.46};
  // The power of an edge falls with the square of frequency, so that squares also hold what is coarser than
  // their octave: one step in L has a mean variance of h/(6L) in squares of side 2h, but its power 1/(2π²f²L)
  // adds up to h/(π²L) from f = 1/(4h) to 1/(2h).
  const double of_octave = detail.drawn ? 6 / (pi * pi) : 1;
  const auto power_at = [&](double place) { return detail.drawn ? 1 / (place * place) : 1; };
  double power = 0;
  for (const double place : places) power += power_at(place);
  double error = 0, finer = 0, light = detail.mean * detail.mean;
  const double finest_cpp = std::max(finest_shown_cpp, samples_per_pixel / 2);
  double side = detail.finest_side;  // of the smallest square [samples]
  for (const double variance : detail.variances) {
    for (const double place : places) {
      const double cycles = place / side, f = cycles * samples_per_pixel;
      const auto add = [&](double contrast, double at) {
        const double share = variance * of_octave * power_at(place) / power * contrast * contrast;
        (detail.drawn && at > finest_cpp ? finer : error) +=
            share * std::pow(taps_error(taps, site, path, at, mtf), 2);
        light += share * std::pow(site.transform(at, 0).real() * mtf(at), 2);
      };
      if (detail.drawn) {
        add(1, f);
        continue;
      }
      // Straight lines between samples: less of this, and some of its images beyond the samples' own
      // frequency.
      for (const double of_sample : {cycles, 1 - cycles})
        add(std::pow(sinc(of_sample), 2), of_sample / cycles * f);
    }
    side *= 2;
  }
  if (!(light > 0)) return {};
  return {std::sqrt((error + finer) / light), std::sqrt(finer / light)};
}

CellChoice choose_cells(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                        const ImagingOptions& options) {
  const int asked = options.supersample;
  if (options.method == BlurMethod::none) return {options.cells_per_pixel(), {}, 0};
  const int middle = scene.bands() / 2;
  const double wavelength_nm = scene.wavelengths_nm()[static_cast<std::size_t>(middle)];
  const FrameMtf mtf(table, wavelength_nm, sensor);
  const DetailSpectrum detail = detail_of(scene, middle);
  const double samples = samples_per_pixel(scene, table, wavelength_nm, sensor, options.fit);
  const LightPath path{SourceFilter(2), true};
  const auto with = [&](int cells) {
    return CellChoice{cells, sampling_error(detail, samples, options.photosite, cells, path, mtf),
                      contrast_of(detail, cells / samples)};
  };
  if (asked != 0) return with(asked);
  // One cell holds little more than what the tolerance of a preview asks for.
  CellChoice choice = with(options.is_preview() ? 1 : 2);
  while (choice.cells < ImagingOptions::most_cells && !choice.sampling.is_within(options.product.tolerance))
    choice = with(choice.cells + 1);
  return choice;
}

}  // namespace petzval
