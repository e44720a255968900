// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/colour/band_light.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/scene/chart_canvas.h>
#include <petzval/scene/scene_light.h>
#include <petzval/scene/shape_cuts.h>
#include <petzval/scene/wavelength_list.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

namespace petzval {

namespace {

constexpr int shortest_seen_nm = 370, longest_seen_nm = 780;
constexpr double visible_middle_nm = 555;

/// What each nanometre of an illuminant adds to luminance.
Spectrum seen_light(const Spectrum& illuminant) {
  std::vector<double> wavelengths;
  for (int nm = shortest_seen_nm; nm <= longest_seen_nm; ++nm) wavelengths.push_back(nm);
  const std::vector<Xyz> weights = Observer::cie_1931().weights(wavelengths);
  std::vector<double> values = band_light(illuminant, wavelengths);
  for (std::size_t i = 0; i < wavelengths.size(); ++i) values[i] *= weights[i].y;
  return Spectrum(std::move(wavelengths), std::move(values));
}

/// Leaves of each figure what later ones do not cover.
void part_figures(SceneDrawing& drawing) {
  std::vector<const Shape*> shapes;
  for (const SceneDrawing::Figure& figure : drawing.figures) shapes.push_back(figure.shape.get());
  std::vector<Shape> parts = uncovered_parts(shapes);
  for (std::size_t i = 0; i < parts.size(); ++i)
    drawing.figures[i].shape = std::make_shared<const Shape>(std::move(parts[i]));
  std::erase_if(drawing.figures, [](const SceneDrawing::Figure& figure) { return figure.shape->empty(); });
}

double sum(const std::vector<double>& values) {
  double total = 0;
  for (double value : values) total += value;
  return total;
}

}  // namespace

ChartCanvas::ChartCanvas(const ChartOptions& options)
    : options_(options),
      illuminant_(petzval::illuminant(options.illuminant)),
      seen_(seen_light(illuminant_)),
      scene_(options.columns, options.rows,
             options.wavelengths_nm.empty() ? default_bands_nm() : options.wavelengths_nm,
             options.horizontal_angle_deg, options.distance_m) {
  if (!(options.mean_luminance_cd_m2 > 0 && std::isfinite(options.mean_luminance_cd_m2)))
    throw InputError(fmt::format("a mean luminance of {} cd/m²; a positive one would be right",
                                 options.mean_luminance_cd_m2));
  light_ = light_in_bands(illuminant_, options.illuminant, scene_.wavelengths_nm(), options.band_width_nm);
  luminous_reflectance_.resize(scene_.band_size());
}

Paint ChartCanvas::paint(const Spectrum& reflectance) const {
  Paint result;
  for (double nm : scene_.wavelengths_nm())
    result.reflectance.push_back(static_cast<float>(std::max(0.0, reflectance.at_extended(nm))));
  double luminance = 0;
  for (std::size_t i = 0; i < seen_.values().size(); ++i)
    luminance += seen_.values()[i] * std::max(0.0, reflectance.at_extended(seen_.wavelengths_nm()[i]));
  const double white = sum(seen_.values());
  // Of light that no eye sees: not 0, or the chart would be black.
  result.luminous_reflectance =
      static_cast<float>(white > 0 ? luminance / white : reflectance.at_extended(visible_middle_nm));
  if (reflectance.values().size() > 1) result.known_nm = {reflectance.front_nm(), reflectance.back_nm()};
  return result;
}

Paint ChartCanvas::flat_paint(double reflectance) const {
  return paint(Spectrum({555.0}, {reflectance}));
}

void ChartCanvas::use(const Paint& paint) {
  known_nm_ = {std::max(known_nm_.from, paint.known_nm.from), std::min(known_nm_.to, paint.known_nm.to)};
}

void ChartCanvas::fill(const Paint& paint) {
  set_ground(paint, [](int, std::span<double> factors) { std::fill(factors.begin(), factors.end(), 1.0); });
}

void ChartCanvas::modulate(const Paint& paint,
                           const std::function<void(int row, std::span<double> factors)>& factor) {
  auto texture = std::make_shared<std::vector<float>>(scene_.band_size());
  set_ground(paint, [&](int row, std::span<double> factors) {
    factor(row, factors);
    std::transform(factors.begin(), factors.end(), texture->begin() + std::ptrdiff_t(row) * columns(),
                   [](double value) { return static_cast<float>(value); });
  });
  drawing_.texture = std::move(texture);
}

void ChartCanvas::draw(const Shape& shape, const Paint& paint) {
  if (shape.empty()) return;
  use(paint);
  mix(shape, paint);
  drawing_.figures.push_back({std::make_shared<const Shape>(shape), paint.reflectance});
}

void ChartCanvas::mix(const Shape& shape, const Paint& paint) {
  const std::size_t width = static_cast<std::size_t>(columns());
  const ShapesInPicture::Valued one{&shape};
  const ShapesInPicture in_picture(std::span(&one, 1), columns(), rows());
  parallel_for(static_cast<std::size_t>(rows()), [&](std::size_t row) {
    thread_local std::vector<double> coverage;
    coverage.resize(width);
    const auto [from, end] = in_picture.coverage(static_cast<int>(row), coverage);
    const auto mix_plane = [&, first = from, last = end](std::span<float> plane, float value) {
      for (std::size_t column = first; column < last; ++column) {
        float& pixel = plane[row * width + column];
        pixel = static_cast<float>(pixel + coverage[column] * (value - pixel));
      }
    };
    for (int band = 0; band < scene_.bands(); ++band)
      mix_plane(scene_.band(band), paint.reflectance[static_cast<std::size_t>(band)]);
    mix_plane(luminous_reflectance_, paint.luminous_reflectance);
  });
}

void ChartCanvas::set_ground(const Paint& paint,
                             const std::function<void(int row, std::span<double> factors)>& factor) {
  use(paint);
  const std::size_t width = static_cast<std::size_t>(columns());
  parallel_for(static_cast<std::size_t>(rows()), [&](std::size_t row) {
    std::vector<double> factors(width);
    factor(static_cast<int>(row), factors);
    const auto set = [&](std::span<float> plane, float value) {
      for (std::size_t x = 0; x < width; ++x) plane[row * width + x] = static_cast<float>(value * factors[x]);
    };
    for (int band = 0; band < scene_.bands(); ++band)
      set(scene_.band(band), paint.reflectance[static_cast<std::size_t>(band)]);
    set(luminous_reflectance_, paint.luminous_reflectance);
  });
  drawing_ = {paint.reflectance, {}, {}};
}

void ChartCanvas::note_unmeasured_bands() {
  const std::string unmeasured = runs_of_bands(scene_.wavelengths_nm(), [&](double nm) {
    return (nm < known_nm_.from || nm > known_nm_.to) && illuminant_.at(nm) > 0;
  });
  if (!unmeasured.empty())
    scene_.notes.push_back(
        fmt::format("the chart's reflectances were measured from {:g} to {:g} nm; at {} nm they are taken to "
                    "be those of the nearer end",
                    known_nm_.from, known_nm_.to, unmeasured));
}

Scene ChartCanvas::lit() && {
  double mean = 0;
  for (float value : luminous_reflectance_) mean += value;
  mean /= static_cast<double>(luminous_reflectance_.size());
  if (!(mean > 0)) throw InputError("the chart is black at this size; more samples would show it");
  const double luminance = lumens_per_watt * sum(seen_.values()) * mean;
  const double level = is_visible(illuminant_) ? options_.mean_luminance_cd_m2 / luminance
                                               : invisible_level(illuminant_, scene_);

  parallel_for(static_cast<std::size_t>(scene_.bands()), [&](std::size_t band) {
    const double light = level * light_[band];
    for (float& value : scene_.band(static_cast<int>(band))) value = static_cast<float>(value * light);
  });
  scene_.illuminant = illuminant_.scaled(level);
  note_unmeasured_bands();
  if (!drawing_.figures.empty() && drawing_.ground.size() == light_.size()) {
    std::vector<double> factors = light_;
    for (double& factor : factors) factor *= level;
    part_figures(drawing_);
    drawing_.scale(factors);
    scene_.set_drawing(std::move(drawing_));
  }
  return std::move(scene_);
}

}  // namespace petzval
