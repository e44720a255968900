// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/base/wavelength.h>
#include <petzval/colour/band_resampling.h>
#include <petzval/colour/observer.h>
#include <petzval/scene/scene.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace petzval {

namespace {

void check_wavelengths(std::span<const double> wavelengths_nm) {
  if (wavelengths_nm.empty()) throw InputError("a scene needs at least one wavelength");
  double previous = 0;
  for (double wavelength : wavelengths_nm) {
    require_wavelength(wavelength, "a scene's bands");
    if (!(wavelength > previous) || !std::isfinite(wavelength))
      throw InputError(fmt::format("wavelength {} nm after {} nm; positive, increasing ones would be right",
                                   wavelength, previous));
    previous = wavelength;
  }
}

/// The first value that no radiance has: negative, infinite or no number.
std::span<const float>::iterator first_bad(std::span<const float> values) {
  constexpr std::size_t block = 1 << 16;
  constexpr float most = std::numeric_limits<float>::max();
  const auto is_good = [](float value) { return value >= 0 && value <= most; };
  std::vector<char> good((values.size() + block - 1) / block);
  parallel_for(good.size(), [&](std::size_t i) {
    bool all = true;
    for (const float value : values.subspan(i * block, std::min(block, values.size() - i * block)))
      all &= is_good(value);
    good[i] = all;
  });
  const auto bad = static_cast<std::size_t>(std::ranges::find(good, 0) - good.begin());
  return std::find_if_not(values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), bad * block)),
                          values.end(), is_good);
}

void check_angle(double degrees) {
  if (!(degrees > 0 && degrees < 180))
    throw InputError(fmt::format("a scene {} degrees wide; above 0 and below 180 would be right", degrees));
}

void check_distance(std::optional<double> distance_m) {
  if (distance_m && !(*distance_m > 0 && std::isfinite(*distance_m)))
    throw InputError(
        fmt::format("a scene at {} m; a positive distance or none (infinity) would be right", *distance_m));
}

/// Weighted sums of bands, of the samples from `first` on.
template <typename Terms>
void sum_terms(const Scene& scene, const Terms& terms, std::size_t first, std::span<float> out) {
  std::vector<double> sums(out.size(), 0.0);
  for (const auto& [from, weight] : terms) {
    const std::span<const float> values = scene.band(static_cast<int>(from)).subspan(first, out.size());
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += weight * static_cast<double>(values[i]);
  }
  std::transform(sums.begin(), sums.end(), out.begin(), [](double sum) { return static_cast<float>(sum); });
}

double gib(double values) {
  return values * sizeof(float) / (1024.0 * 1024 * 1024);
}

}  // namespace

std::vector<double> default_bands_nm() {
  std::vector<double> wavelengths;
  for (int nm = 400; nm <= 700; nm += 10) wavelengths.push_back(nm);
  return wavelengths;
}

Scene::Scene(Empty, int columns, int rows, std::vector<double> wavelengths_nm, double horizontal_angle_deg,
             std::optional<double> distance_m)
    : columns_(columns), rows_(rows), wavelengths_nm_(std::move(wavelengths_nm)) {
  if (columns < 1 || rows < 1)
    throw InputError(fmt::format("a scene of {} x {} samples; at least 1 x 1 would be right", columns, rows));
  check_wavelengths(wavelengths_nm_);
  if (band_size() > max_values / wavelengths_nm_.size())
    throw InputError(fmt::format(
        "a scene of {} x {} samples in {} bands would take {:.1f} GiB; up to {:.0f} GiB fit", columns, rows,
        bands(), gib(static_cast<double>(band_size()) * bands()), gib(static_cast<double>(max_values))));

  set_horizontal_angle_deg(horizontal_angle_deg);
  set_distance_m(distance_m);
}

Scene::Scene(int columns, int rows, std::vector<double> wavelengths_nm, double horizontal_angle_deg,
             std::optional<double> distance_m)
    : Scene(Empty{}, columns, rows, std::move(wavelengths_nm), horizontal_angle_deg, distance_m) {
  radiance_ = LargeFloats(band_size() * wavelengths_nm_.size());
}

Scene::Scene(int columns, int rows, std::vector<double> wavelengths_nm, double horizontal_angle_deg,
             std::optional<double> distance_m, LargeFloats radiance)
    : Scene(Empty{}, columns, rows, std::move(wavelengths_nm), horizontal_angle_deg, distance_m) {
  if (radiance.size() != band_size() * wavelengths_nm_.size())
    throw InputError(fmt::format("{} values for {} x {} samples in {} bands", radiance.size(), columns, rows,
                                 wavelengths_nm_.size()));
  radiance_ = std::move(radiance);
}

std::span<float> Scene::band(int index) {
  drawing_.reset();
  return radiance_.all().subspan(static_cast<std::size_t>(index) * band_size(), band_size());
}

std::span<const float> Scene::band(int index) const {
  return radiance_.all().subspan(static_cast<std::size_t>(index) * band_size(), band_size());
}

void Scene::make_panorama(PanoramaView view) {
  if (columns_ != 2 * rows_)
    throw InputError(
        fmt::format("a panorama of {} x {} samples; twice as many columns as rows (360 x 180 degrees) "
                    "would be right",
                    columns_, rows_));
  if (distance_m_) throw InputError("a panorama is at infinity; `scene.distance_m` inf would be right");
  if (!std::isfinite(view.yaw_deg) || !std::isfinite(view.pitch_deg))
    throw InputError("a view of a panorama must be a finite angle");
  view_ = view;
  forget_drawing();
}

double Scene::tangent_per_sample() const {
  if (is_panorama()) return 2 * std::numbers::pi / columns_;
  return 2 * std::tan(radians(horizontal_angle_deg_) / 2) / columns_;
}

double Scene::vertical_angle_deg() const {
  if (is_panorama()) return 180;
  return degrees(2 * std::atan(tangent_per_sample() * rows_ / 2));
}

double Scene::diagonal_angle_deg() const {
  if (is_panorama()) return 360;
  return degrees(2 * std::atan(tangent_per_sample() * std::hypot(columns_, rows_) / 2));
}

void Scene::set_distance_m(std::optional<double> distance_m) {
  check_distance(distance_m);
  if (is_panorama() && distance_m) throw InputError("a panorama is at infinity; no other distance is right");
  distance_m_ = distance_m;
}

void Scene::set_horizontal_angle_deg(double angle) {
  check_angle(angle);
  if (is_panorama()) throw InputError("a panorama is 360 degrees wide; no other angle is right");
  horizontal_angle_deg_ = angle;
}

std::vector<double> Scene::mean_radiance() const {
  std::vector<double> means;
  for (int index = 0; index < bands(); ++index) {
    double sum = 0;
    for (float value : band(index)) sum += value;
    release_memory();
    means.push_back(sum / static_cast<double>(band_size()));
  }
  return means;
}

double Scene::mean_luminance_cd_m2() const {
  const std::vector<double> means = mean_radiance();
  const std::vector<Xyz> weights = Observer::cie_1931().weights(wavelengths_nm_);
  double luminance = 0;
  for (std::size_t i = 0; i < means.size(); ++i) luminance += lumens_per_watt * means[i] * weights[i].y;
  return luminance;
}

void Scene::set_mean_luminance_cd_m2(double luminance) {
  if (!(luminance > 0 && std::isfinite(luminance)))
    throw InputError(fmt::format("a mean luminance of {} cd/m²; a positive one would be right", luminance));
  const double now = mean_luminance_cd_m2();
  if (!(now > 0 && std::isfinite(now)))
    throw InputError(
        fmt::format("the scene's mean luminance is {} cd/m² (bands from {} to {} nm): no factor makes it {}",
                    now, wavelengths_nm_.front(), wavelengths_nm_.back(), luminance));
  scale(luminance / now);
}

void Scene::scale(double factor) {
  if (!(factor > 0 && std::isfinite(factor)))
    throw InputError(fmt::format("radiance times {}: a positive factor would be right", factor));
  scale_bands(std::vector<double>(wavelengths_nm_.size(), factor));
  if (illuminant) illuminant = illuminant->scaled(factor);
}

void Scene::scale_bands(std::span<const double> factors) {
  std::optional<SceneDrawing> drawing = std::move(drawing_);
  for_each_band([&](std::size_t index, std::span<float> values) {
    for (float& value : values) value = static_cast<float>(value * factors[index]);
  });
  if (drawing) drawing->scale(factors);
  drawing_ = std::move(drawing);
}

Scene Scene::resampled(std::span<const double> wavelengths_nm) const {
  check_wavelengths(wavelengths_nm);
  const BandResampling resampling(wavelengths_nm_, wavelengths_nm);
  Scene result(columns_, rows_, {wavelengths_nm.begin(), wavelengths_nm.end()}, horizontal_angle_deg_,
               distance_m_);
  result.view_ = view_;
  result.name = name;
  result.illuminant = illuminant;
  if (illuminant && illuminant->front_nm() <= wavelengths_nm.front() &&
      illuminant->back_nm() >= wavelengths_nm.back())
    result.illuminant = petzval::resampled(*illuminant, wavelengths_nm);  // as the radiance of a white is
  result.depth_m = depth_m;
  result.depth_from = depth_from;
  result.notes = notes;
  parallel_for(resampling.bands(), [&](std::size_t index) {
    const std::span<float> out = result.band(static_cast<int>(index));
    constexpr std::size_t block = 1 << 16;
    for (std::size_t first = 0; first < out.size(); first += block)
      sum_terms(*this, resampling.terms(index), first,
                out.subspan(first, std::min(block, out.size() - first)));
    release_memory();
    result.release_memory();
  });
  return result;
}

void Scene::validate() const {
  for (int index = 0; index < bands(); ++index) {
    const std::span<const float> values = band(index);
    const auto bad = first_bad(values);
    if (bad == values.end()) {
      release_memory();
      continue;
    }
    const std::size_t at = static_cast<std::size_t>(bad - values.begin());
    const std::size_t width = static_cast<std::size_t>(columns_);
    throw InputError(
        fmt::format("radiance {} in the band of {} nm at row {}, column {}; finite and not negative would "
                    "be right",
                    *bad, wavelengths_nm_[static_cast<std::size_t>(index)], at / width, at % width));
  }
  validate_depth();
}

void Scene::validate_depth() const {
  if (depth_m.empty()) return;
  if (is_panorama())
    throw InputError(
        "a panorama is at infinity; a depth map belongs to a plane scene (`scene.depth` none leaves it out)");
  if (depth_m.size() != band_size())
    throw InputError(fmt::format("{} depths for {} x {} samples; one a sample would be right", depth_m.size(),
                                 columns_, rows_));
  const auto bad = std::find_if(depth_m.begin(), depth_m.end(), [](float v) { return !(v >= 0); });
  if (bad == depth_m.end()) return;
  const auto at = static_cast<std::size_t>(bad - depth_m.begin()), width = static_cast<std::size_t>(columns_);
  throw InputError(
      fmt::format("a depth of {} m at row {}, column {}; a positive one, or infinity (0 too stands for "
                  "\"nothing there\"), would be right",
                  *bad, at / width, at % width));
}

}  // namespace petzval
