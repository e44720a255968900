// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/imaging/image_frame.h>

#include <algorithm>
#include <array>

namespace petzval {

SpectralImage blank_image(const Scene& scene, const SensorGeometry& sensor, const ImagingOptions& options) {
  SpectralImage image(sensor.columns, sensor.rows, scene.wavelengths_nm(), sensor.pitch_um,
                      options.photosite.is_plain() ? PixelAperture::box : PixelAperture::photosite);
  if (!options.photosite.is_plain()) image.photosite = options.photosite.text();
  image.illuminant = scene.illuminant;
  return image;
}

void note_extremes(std::span<const float> values, bool first, ImagingReport& report) {
  // Several side by side, as vector registers hold them.
  constexpr std::size_t lanes = 16;
  std::array<float, lanes> low, high;
  low.fill(values.front());
  high.fill(values.front());
  std::size_t at = 0;
  for (; at + lanes <= values.size(); at += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const float value = values[at + lane];
      low[lane] = value < low[lane] ? value : low[lane];
      high[lane] = value > high[lane] ? value : high[lane];
    }
  for (; at < values.size(); ++at) {
    low[0] = std::min(low[0], values[at]);
    high[0] = std::max(high[0], values[at]);
  }
  const double darkest = double(*std::min_element(low.begin(), low.end())),
               brightest = double(*std::max_element(high.begin(), high.end()));
  report.darkest = first ? darkest : std::min(report.darkest, darkest);
  report.brightest = first ? brightest : std::max(report.brightest, brightest);
}

void note_result(ImagingReport& report) {
  if (report.least_captured < 0.99)
    report.notes.push_back(
        fmt::format("the PSF windows of the lens data table hold {:.2f} % of the light and more; "
                    "the rest is taken to fall as the held part does",
                    100 * report.least_captured));
}

}  // namespace petzval
