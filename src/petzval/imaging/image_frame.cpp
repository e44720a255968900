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

PixelTaps image_taps(const ImagingOptions& options, ImagingReport& report) {
  // Boxes that the light goes through before the taps: its cell's, if that sees a mean, and the receiving
  // one's.
  const int boxes = (report.scene_points_per_cell > 1 ? 1 : 0) + (options.method == BlurMethod::none ? 0 : 1);
  const PixelTaps taps = pixel_taps(options.photosite, options.cells_per_pixel(), boxes);
  report.cells_per_pixel = taps.cells;
  if (taps.cells > options.supersample)
    report.notes.push_back(fmt::format("the photosite ({}) needs {} x {} cells to a pixel",
                                       options.photosite.text(), taps.cells, taps.cells));

  constexpr int freely_weighted = 3;  // cells along a side from which on taps can make good the second box
  if (boxes > 1 && taps.cells < freely_weighted)
    report.notes.push_back(fmt::format(
        "the scene is finer than a cell of 1/{} pixel, which blurs it twice: fine detail comes out "
        "softer than it is; `supersample` {} or more applies the pixel aperture once",
        taps.cells, freely_weighted));
  return taps;
}

void note_extremes(const CellPlane& pixels, int band, ImagingReport& report) {
  // Several side by side, as vector registers hold them.
  constexpr std::size_t lanes = 16;
  const auto& values = pixels.values;
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
  report.darkest = band == 0 ? darkest : std::min(report.darkest, darkest);
  report.brightest = band == 0 ? brightest : std::max(report.brightest, brightest);
}

void put_band(const CellPlane& pixels, int band, SpectralImage& image, ImagingReport& report) {
  note_extremes(pixels, band, report);
  image.store_band(band, pixels.values);
  image.release_memory();
}

void note_result(const ImagingOptions& options, ImagingReport& report) {
  constexpr double worth_a_note = 1e-4;  // well above the rounding of the transforms
  if (report.darkest < -worth_a_note * report.brightest)
    report.notes.push_back(
        fmt::format("irradiance goes down to {:.3g}, {:.2g} of the brightest pixel: negative lobes "
                    "of interpolated {}",
                    report.darkest, -report.darkest / report.brightest,
                    options.interpolation == PsfInterpolation::otf ? "OTFs" : "PSFs"));
  if (report.least_captured < 0.99)
    report.notes.push_back(
        fmt::format("the PSF windows of the lens data table hold {:.2f} % of the light and more; "
                    "the rest is taken to fall as the held part does",
                    100 * report.least_captured));
  if (options.method != BlurMethod::none)
    report.notes.push_back(
        fmt::format("light may come in from {} cells around the frame; light that leaves the frame "
                    "is lost",
                    report.margin_cells));
  constexpr int wide_cells = 112;  // beyond it transforms have hardly room for a tile
  if (options.method == BlurMethod::product && report.margin_cells > wide_cells)
    report.notes.push_back(fmt::format(
        "PSFs reach {} cells, more than fast transforms hold: larger pixels or a larger `tolerance` "
        "would be much quicker",
        report.margin_cells));
}

}  // namespace petzval
