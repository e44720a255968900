// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/band_plan.h>
#include <petzval/imaging/exact_blur.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/pixel_gather.h>
#include <petzval/imaging/product_blur.h>
#include <petzval/sensor/lens_facts.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace petzval {

namespace {

void check_distances(const Scene& scene, const LensDataTable& table) {
  const std::optional<double> table_mm = object_to_sensor_mm(table);
  const auto say = [](std::optional<double> mm) {
    return mm ? fmt::format("{:.6g} m", *mm / mm_per_m) : "infinity";
  };
  std::optional<double> scene_mm = scene.distance_m();
  if (scene_mm) *scene_mm *= mm_per_m;
  constexpr double relative_tolerance = 1e-3;
  const bool agree = scene_mm && table_mm ? std::abs(*scene_mm - *table_mm) <= relative_tolerance * *table_mm
                                          : !scene_mm && !table_mm;
  if (!agree)
    throw InputError(
        fmt::format("the scene is at {}, but the lens data table was made for an object at {} from the "
                    "sensor; give the scene that distance, or build the table for the scene's",
                    say(scene_mm), say(table_mm)));
}

/// \throws InputError if the scene ends before the field does and nothing was said about its surroundings.
void check_coverage(const Scene& scene, const std::vector<BandPlan>& plans, const SensorGeometry& frame,
                    Surround surround, std::vector<std::string>& notes) {
  if (scene.is_panorama()) return;  // it is everywhere
  const SeenExtent seen = seen_extent(plans, frame);
  int margin = 0;
  for (const BandPlan& plan : plans) margin = std::max(margin, plan.margin);
  constexpr double rounding = 1 + 1e-9;
  if (2 * seen.columns <= scene.columns() * rounding && 2 * seen.rows <= scene.rows() * rounding) return;

  const auto full_angle = [&](double samples) {
    return degrees(2 * std::atan(samples * scene.tangent_per_sample()));
  };
  const double wide = full_angle(seen.columns), high = full_angle(seen.rows),
               across = full_angle(seen.radius);
  const auto short_by = [](double needed, double have) { return std::max(0.0, needed - have); };
  const std::string shortfall = fmt::format(
      "the scene covers {:.2f}° × {:.2f}° ({:.2f}° across its corners), the frame with a margin of {} cells "
      "for the "
      "PSF sees {:.2f}° × {:.2f}° ({:.2f}°): it falls short by {:.2f}° horizontally, {:.2f}° vertically and "
      "{:.2f}° "
      "diagonally",
      scene.horizontal_angle_deg(), scene.vertical_angle_deg(), scene.diagonal_angle_deg(), margin, wide,
      high, across, short_by(wide, scene.horizontal_angle_deg()), short_by(high, scene.vertical_angle_deg()),
      short_by(across, scene.diagonal_angle_deg()));
  if (surround == Surround::error)
    throw InputError(shortfall +
                     "; a larger --scene-angle, a smaller sensor, or --surround zero or extend would do");
  notes.push_back(shortfall + (surround == Surround::zero
                                   ? "; beyond it is darkness (--surround zero)"
                                   : "; beyond it its edge goes on (--surround extend)"));
}

void note_dark_corners(const std::vector<BandPlan>& plans, const SensorGeometry& frame,
                       std::vector<std::string>& notes) {
  const double corner_mm = half_diagonal_mm(frame), cell_mm = frame.pitch_um * mm_per_um;
  double last_mm = corner_mm, missing_mm = 0;
  for (const BandPlan& plan : plans) {
    last_mm = std::min(last_mm, plan.map.last_height_mm());
    missing_mm = std::max(missing_mm, corner_mm + (plan.margin - 1) * cell_mm - plan.map.last_height_mm());
  }
  if (last_mm < corner_mm)
    notes.push_back(
        fmt::format("the last chief ray of the lens data table lands {:.4f} mm from the axis: beyond, "
                    "towards the corners at {:.4f} mm, the image is dark",
                    last_mm, corner_mm));
  else if (missing_mm > 0)
    notes.push_back(
        fmt::format("the lens data table ends {:.4f} mm short of the places whose light could just reach "
                    "the corners: no light comes from there",
                    missing_mm));
}

/// How many points of a cell to take in each direction, so that no sample of the scene is skipped in any
/// band.
int points_per_cell(const std::vector<BandPlan>& plans, const SensorGeometry& frame) {
  constexpr int most = 64;
  double samples = 1;
  for (const BandPlan& plan : plans)
    samples = std::max(samples, plan.map.finest_samples_per_mm() * frame.pitch_um * mm_per_um);
  constexpr double rounding = 1e-6;
  return static_cast<int>(std::min<double>(most, std::ceil(samples - rounding)));
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Blurs the bands of one image, one after the other.
class BandBlur {
 public:
  BandBlur(const LensDataTable& table, const ImagingOptions& options, ImagingReport& report)
      : table_(table), options_(options), centres_(table), report_(report) {}

  CellPlane operator()(CellPlane source, double wavelength_nm, int margin, const ProgressCallback& progress) {
    if (options_.method == BlurMethod::none) return source;
    const PsfField psfs(table_, wavelength_nm, source.grid.pitch_um, options_.interpolation, centres_);
    if (options_.method == BlurMethod::exact) return blur_exact(source, psfs, margin, progress);
    if (options_.by_sections()) return sections(source, psfs, margin, options_.section_options(), progress);
    return product(source, psfs, margin, progress);
  }

 private:
  CellPlane sections(const CellPlane& source, const PsfField& psfs, int margin, const SectionOptions& options,
                     const ProgressCallback& progress) {
    report_.transform_size = std::max(report_.transform_size, transform_size(options, psfs.radius()));
    return blur_sections(source, psfs, margin, options, progress);
  }

  CellPlane product(const CellPlane& source, const PsfField& psfs, int margin,
                    const ProgressCallback& progress) {
    const auto start = std::chrono::steady_clock::now();
    plan_ = plan_product(psfs, source.grid, options_.product, plan_);
    const ProductPlan plan = plan_ ? *plan_ : plan_blended(psfs, source.grid, options_.product);
    if (report_.product.tile == 0 || plan.estimated_error > report_.product.estimated_error)
      report_.product = plan;
    if (!plan_) return sections(source, psfs, margin, {plan.tile, 0, true}, progress);
    const ProductBlur blur(psfs, source.grid, plan);
    report_.transform_size = std::max(report_.transform_size, plan.transform);
    report_.kernel_seconds += seconds_since(start);
    return blur.blur(source, margin);
  }

  const LensDataTable& table_;
  const ImagingOptions& options_;
  const LightCentres centres_;
  ImagingReport& report_;
  std::optional<ProductPlan> plan_;  ///< of the last band
};

void finish(ImagingReport& report, const SpectralImage& image, const ImagingOptions& options) {
  const auto [darkest, brightest] = std::minmax_element(image.values().begin(), image.values().end());
  report.darkest = *darkest;
  report.brightest = *brightest;
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
}

}  // namespace

SectionOptions ImagingOptions::section_options() const {
  return {sections.section, sections.transform, method == BlurMethod::blended};
}

int ImagingOptions::cells_per_pixel() const {
  return cells_for(photosite, method == BlurMethod::none ? 1 : 2, supersample);
}

SensorGeometry ImagingOptions::cells_of(const SensorGeometry& sensor) const {
  const int cells = cells_per_pixel();
  const int reach = photosite.is_plain() ? 0 : pixel_taps(photosite, cells, 0).reach;
  return grown(subdivided(sensor, cells), reach);
}

void ImagingOptions::validate() const {
  constexpr int most = 16;
  if (supersample < 1 || supersample > most)
    throw InputError(fmt::format("supersampling of {}: 1 to {} is right", supersample, most));
  pixel_taps(photosite, supersample, 0);
  product.validate();
  if (by_sections()) transform_size({sections.section, 0, method == BlurMethod::blended}, 0);
}

std::optional<double> object_to_sensor_mm(const LensDataTable& table) {
  if (!table.object_distance_mm) return std::nullopt;
  return *table.object_distance_mm + table.vertex_to_sensor_mm;
}

SpectralImage form_image(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                         const ImagingOptions& options, const ProgressCallback& progress,
                         ImagingReport* report) {
  ImagingReport own;
  ImagingReport& says = report != nullptr ? *report : own;
  says = {};

  // Everything that can be refused is refused before the work starts.
  options.validate();
  scene.validate();
  table.validate();
  check_distances(scene, table);
  SpectralImage image(sensor.columns, sensor.rows, scene.wavelengths_nm(), sensor.pitch_um,
                      options.photosite.is_plain() ? PixelAperture::box : PixelAperture::photosite);
  if (!options.photosite.is_plain()) image.photosite = options.photosite.text();
  const SensorGeometry frame = options.cells_of(sensor);
  const std::vector<BandPlan> plans = plan_bands(scene, table, frame, options);
  check_coverage(scene, plans, frame, options.surround, says.notes);
  note_dark_corners(plans, frame, says.notes);
  says.scene_points_per_cell = points_per_cell(plans, frame);

  // Boxes that the light goes through before the taps: its cell's, if that sees a mean, and the receiving
  // one's.
  const int boxes = (says.scene_points_per_cell > 1 ? 1 : 0) + (options.method == BlurMethod::none ? 0 : 1);
  const PixelTaps taps = pixel_taps(options.photosite, options.cells_per_pixel(), boxes);
  says.cells_per_pixel = taps.cells;
  if (taps.cells > options.supersample)
    says.notes.push_back(fmt::format("the photosite ({}) needs {} x {} cells to a pixel",
                                     options.photosite.text(), taps.cells, taps.cells));

  constexpr int freely_weighted = 3;  // cells along a side from which on taps can make good the second box
  if (boxes > 1 && taps.cells < freely_weighted)
    says.notes.push_back(fmt::format(
        "the scene is finer than a cell of 1/{} pixel, which blurs it twice: fine detail comes out "
        "softer than it is; --supersample {} or more applies the pixel aperture once",
        taps.cells, freely_weighted));

  BandBlur blur(table, options, says);
  for (int band = 0; band < scene.bands(); ++band) {
    const BandPlan& plan = plans[static_cast<std::size_t>(band)];
    const auto start = std::chrono::steady_clock::now();
    CellPlane ideal = ideal_irradiance(scene, band, plan.map, grown(frame, plan.margin),
                                       says.scene_points_per_cell, options.surround);
    says.distortion_seconds += seconds_since(start);

    const auto start_of_blur = std::chrono::steady_clock::now();
    const double wavelength_nm = scene.wavelengths_nm()[static_cast<std::size_t>(band)];
    const auto within_band = [&](double fraction, const std::string& what) {
      if (progress) progress((band + fraction) / scene.bands(), what);
    };
    const CellPlane blurred = blur(std::move(ideal), wavelength_nm, plan.margin, within_band);
    says.blur_seconds += seconds_since(start_of_blur);

    const CellPlane pixels = gathered(blurred, taps);
    std::copy(pixels.values.begin(), pixels.values.end(), image.band(band).begin());
    says.margin_cells = std::max(says.margin_cells, plan.margin);
    says.least_captured = std::min(says.least_captured, plan.least_captured);
    if (progress) progress((band + 1.0) / scene.bands(), "image");
  }
  image.lens = lens_facts(table.lens_name, table.first_order);
  image.illuminant = scene.illuminant;
  finish(says, image, options);
  return image;
}

}  // namespace petzval
