// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/imaging/formation.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/image_frame.h>
#include <petzval/imaging/lens_corrections.h>
#include <petzval/imaging/psf_tails.h>
#include <petzval/sensor/lens_facts.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace petzval {

/// The picture, or its sharp part and the light that lands far away.
struct ImageSeries::Impl {
  Impl(const Scene& scene, const LensDataTable& table, const SensorGeometry& of_sensor,
       const ImagingOptions& options, bool keeps, FormationMemory* memory = nullptr, bool is_tail = false)
      : sensor(of_sensor),
        split(split_table(table, sensor, options)),
        picture(scene, split ? split->sharp : table, sensor, options, keeps, memory) {
    if (split)
      tails = std::make_unique<Impl>(scene, split->tails,
                                     coarse_frame(sensor, tail_coarseness(options.tail_pixels)),
                                     of_tails(options, tail_strength(*split), is_tail), keeps, memory, true);
  }

  /// \param strength  tail_strength(). \param again  what is split is a tail.
  static ImagingOptions of_tails(ImagingOptions options, double strength, bool again) {
    options.photosite = {};
    options.supersample = 1;  // pixels are narrow beside what lands so far away
    // Far light is smooth, so errors of its kernels do not average out. They are errors of a weak part; of
    // the part itself none may be large, however weak.
    const double smooth = again ? 1 : 0.1;  // tails of tails have it in their tolerance
    constexpr double coarsest = 0.05;
    options.product.tolerance = std::clamp(options.product.tolerance * smooth / strength, 1e-6, coarsest);
    // What the frame needs of the scene is there; a part of a coarse pixel may lie beyond.
    if (options.surround == Surround::error) options.surround = Surround::extend;
    return options;
  }

  void form(std::span<const AimedLight> lights, const TakeBand& take, const ProgressCallback& callback,
            ImagingReport& report, const BandShare& share = {}) {
    // Tails come first, and are about a quarter of the work.
    const double before = split ? 0.25 : 0;
    const auto part = [&](double from, double to) -> ProgressCallback {
      if (!callback) return {};
      return [&callback, from, to](double done, const std::string& what) {
        callback(std::lerp(from, to, done), what);
      };
    };
    const std::vector<std::vector<float>> far =
        split ? far_light(lights, share, part(0, before)) : std::vector<std::vector<float>>();
    std::vector<float> whole;
    std::size_t plane = 0;
    ImagingReport extremes;
    picture.form(
        lights,
        [&](std::span<const float> pixels) {
          if (split) {
            whole.assign(pixels.begin(), pixels.end());
            add_coarse(far[plane], tails->sensor, tail_coarseness(picture.options.tail_pixels),
                       lights[plane % lights.size()].rows, sensor, whole);
            pixels = whole;
          }
          note_extremes(pixels, plane++ == 0, extremes);
          take(pixels);
        },
        part(before, 1), report, share);
    report.brightest = extremes.brightest;
    report.darkest = extremes.darkest;
    if (split) report.tail_pixels = picture.options.tail_pixels;
  }

  /// On coarse pixels, in the order in which the picture's planes come.
  std::vector<std::vector<float>> far_light(std::span<const AimedLight> lights, BandShare share,
                                            const ProgressCallback& callback) {
    std::vector<AimedLight> all_rows(lights.begin(), lights.end());
    for (AimedLight& light : all_rows) light.rows = {};
    if (share.known)  // it has all of its light
      share.known = [](int, std::span<float> pixels) { std::ranges::fill(pixels, 0.0F); };
    std::vector<std::vector<float>> planes;
    ImagingReport unwanted;
    tails->form(
        all_rows, [&](std::span<const float> pixels) { planes.emplace_back(pixels.begin(), pixels.end()); },
        callback, unwanted, share);
    return planes;
  }

  const SensorGeometry sensor;
  const std::optional<TailSplit> split;
  Formation picture;
  std::unique_ptr<Impl> tails;  ///< which may be split again
};

ImageSeries::ImageSeries(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                         const ImagingOptions& options)
    : impl_(std::make_unique<Impl>(scene, table, sensor, options, true)) {}

ImageSeries::~ImageSeries() = default;

std::vector<SpectralImage> ImageSeries::form(std::span<const AimedLight> lights, ImagingReport* report) {
  ImagingReport unwanted;
  const Formation& of = impl_->picture;
  std::vector<SpectralImage> images;
  std::size_t planes = 0;
  const auto put = [&](std::span<const float> pixels) {
    if (images.empty()) images.assign(lights.size(), blank_image(of.scene, of.sensor, of.options));
    images[planes % lights.size()].store_band(static_cast<int>(planes / lights.size()), pixels);
    ++planes;
  };
  impl_->form(lights, put, {}, report != nullptr ? *report : unwanted);
  for (SpectralImage& image : images) {
    image.lens = lens_facts(of.table.lens_name, of.table.first_order);
    add_corrections(*image.lens, of.table, of.sensor);
  }
  return images;
}

SectionOptions ImagingOptions::section_options() const {
  return {sections.section, sections.transform, method == BlurMethod::blended};
}

SensorGeometry ImagingOptions::cells_of(const SensorGeometry& sensor) const {
  const int cells = cells_per_pixel();
  return grown(subdivided(sensor, cells), taps_reach(photosite, cells, method == BlurMethod::none));
}

void ImagingOptions::validate() const {
  if (supersample < 0 || supersample > most_cells)
    throw InputError(
        fmt::format("supersampling of {}: 1 to {} is right, or 0 to choose", supersample, most_cells));
  if (tail_pixels < 0)
    throw InputError(fmt::format("tails from {} pixels on: 0 or more would be right", tail_pixels));
  check_photosite(photosite);
  product.validate();
  if (by_sections()) transform_size({sections.section, 0, method == BlurMethod::blended}, 0);
}

void form_bands(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                const ImagingOptions& options, const TakeBand& take, const ProgressCallback& progress,
                ImagingReport* report, const BandShare& share, FormationMemory* memory) {
  ImagingReport unwanted;
  const AimedLight straight;
  ImageSeries::Impl(scene, table, sensor, options, false, memory)
      .form(std::span(&straight, 1), take, progress, report != nullptr ? *report : unwanted, share);
}

SpectralImage form_image(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                         const ImagingOptions& options, const ProgressCallback& progress,
                         ImagingReport* report, const BandShare& share, FormationMemory* memory) {
  // What does not fit is refused before there is room for an image.
  std::optional<SpectralImage> image;
  int bands = 0;
  const auto put = [&](std::span<const float> pixels) {
    if (!image) image = blank_image(scene, sensor, options);
    image->store_band(bands++, pixels);
    image->release_memory();
  };
  form_bands(scene, table, sensor, options, put, progress, report, share, memory);
  image->lens = lens_facts(table.lens_name, table.first_order);
  add_corrections(*image->lens, table, sensor);
  return std::move(*image);
}

}  // namespace petzval
