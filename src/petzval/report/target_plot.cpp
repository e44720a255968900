// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/numeric/fft.h>
#include <petzval/report/heat_map.h>
#include <petzval/report/svg_plot.h>
#include <petzval/report/target_plot.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// A PSF on a square grid about its middle sample, over its largest value, in the frame of the picture.
struct SampledPsf {
  int size = 0;  ///< odd
  double spacing_um = 0;
  std::vector<float> values;

  float at(int row, int column) const {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(size) +
                  static_cast<std::size_t>(column)];
  }
};

/// The transform of the OTF over a period four times as wide as what is shown, so that little wraps into it.
SampledPsf sampled_psf(const Otf& otf) {
  constexpr int largest = 2048, periods = 4;
  const double nyquist_um = 0.5e3 / otf.cutoff_cpmm();
  const double half_um = std::max(12 * nyquist_um, 1.4 * otf.reach_um());
  // Four samples to Nyquist's one for smooth curves; fewer where the blur is wide.
  const double spacing = std::max(nyquist_um / 4, 2 * half_um * periods / largest);
  const int half = static_cast<int>(half_um / spacing), size = 2 * half + 1;
  const int period = good_fft_size(periods * size);
  const RealFft2<double> fft(period, period);
  AlignedVector<std::complex<double>> spectrum(fft.spectrum_size());
  AlignedVector<double> image(fft.size());
  const auto count = static_cast<std::size_t>(period),
             columns = static_cast<std::size_t>(fft.spectrum_columns());
  std::vector<double> fy(count);
  const double step = 1e3 / (period * spacing);
  for (int l = 0; l < period; ++l)
    fy[static_cast<std::size_t>(l)] = step * (l <= period / 2 ? l : l - period);
  std::vector<std::complex<double>> line(count);
  for (std::size_t k = 0; k < columns; ++k) {
    otf.evaluate(step * static_cast<double>(k), fy, line);
    for (std::size_t l = 0; l < count; ++l) spectrum[l * columns + k] = line[l];
  }
  fft.inverse(spectrum, image);
  SampledPsf psf{size, spacing, {}};
  const double peak = *std::max_element(image.begin(), image.end());
  const auto wrapped = [&](int i) { return static_cast<std::size_t>((i + period) % period); };
  for (int r = -half; r <= half; ++r)
    for (int c = -half; c <= half; ++c)
      psf.values.push_back(static_cast<float>(image[wrapped(r) * count + wrapped(c)] / peak));
  return psf;
}

Plot psf_picture(const SampledPsf& psf) {
  constexpr double gamma = 4;
  const double edge = 0.5 * psf.size * psf.spacing_um;
  HeatMapOptions options;
  options.black = 0, options.white = 1, options.gamma = gamma;
  Plot plot;
  plot.title = "PSF of the optics, its fourth root";
  plot.width_px = 440;
  plot.equal_aspect = true;
  plot.x = {"to the right in the picture", "um", PlotScale::linear, -edge, edge};
  plot.y = {"upwards", "um", PlotScale::linear, -edge, edge};
  plot.images.push_back({heat_map_png(psf.values, psf.size, psf.size, options), -edge, edge, -edge, edge});
  return plot;
}

Plot psf_sections(const SampledPsf& psf) {
  constexpr double floor = 1e-6;
  Plot plot;
  plot.title = "PSF along two lines through its middle";
  plot.x = {"distance", "um"};
  plot.y = {"light over the greatest", "", PlotScale::logarithmic, floor, 1.0};
  std::vector<double> at, across, along;
  const int half = psf.size / 2;
  for (int i = -half; i <= half; ++i) {
    at.push_back(i * psf.spacing_um);
    across.push_back(std::max<double>(psf.at(half, half + i), floor));
    along.push_back(std::max<double>(psf.at(half - i, half), floor));
  }
  plot.line("to the right", at, across);
  plot.line("upwards", at, along).stroke = PlotStroke::dashed;
  return plot;
}

Plot mtf(const Otf& otf, const TargetOptions& options) {
  Plot plot;
  plot.title = "MTF";
  plot.x = {"spatial frequency", "cycles/pixel", PlotScale::linear, 0.0, 1.0};
  plot.y = {"modulation", "", PlotScale::linear, 0.0, 1.0};
  const auto curve = [&](const std::string& label, PlotStroke stroke, auto&& value) {
    std::vector<double> x, y;
    constexpr int steps = 400;
    for (int i = 0; i <= steps; ++i) {
      x.push_back(static_cast<double>(i) / steps);
      y.push_back(std::abs(value(x.back())));
    }
    plot.line(label, x, y).stroke = stroke;
  };
  const double cpmm = 1e3 / options.pitch_um, diagonal = std::sqrt(0.5);
  curve("whole chain, upright edges", PlotStroke::solid,
        [&](double f) { return transfer(otf, options, f, 0); });
  curve("whole chain, level edges", PlotStroke::dashed,
        [&](double f) { return transfer(otf, options, 0, f); });
  curve("whole chain, edges at 45 deg", PlotStroke::dashed,
        [&](double f) { return transfer(otf, options, f * diagonal, f * diagonal); });
  curve("optics alone, upright edges", PlotStroke::dotted, [&](double f) { return otf.at(f * cpmm, 0); });
  plot.guides.push_back({PlotGuide::At::x, 0.5, "Nyquist"});
  return plot;
}

}  // namespace

std::string target_plot_svg(const Otf& otf, const TargetOptions& options, const std::string& title) {
  const SampledPsf psf = sampled_psf(otf);
  return plot_grid_svg({psf_picture(psf), psf_sections(psf), mtf(otf, options)}, 2, title);
}

}  // namespace petzval
