// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/scene_sources.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace petzval {

namespace {

constexpr double farthest_deg = 80;

/// Where the samples of a scene are, as the first vertex of the lens sees them.
class SampleView {
 public:
  SampleView(const Scene& scene, double track_mm) : scene_(scene) {
    if (!scene.distance_m()) return;
    const double distance_mm = *scene.distance_m() * mm_per_m;
    if (!(distance_mm > track_mm))
      throw InputError(
          fmt::format("the scene is {:g} mm from the sensor, within the lens; more than {:g} mm "
                      "would be right",
                      distance_mm, track_mm));
    vertex_mm_ = distance_mm - track_mm;
    scale_ = distance_mm / vertex_mm_;
  }

  /// Unit, in the axes of the photographer: right, up, ahead.
  std::array<double, 3> towards(int column, int row) const {
    const double across = column + 0.5 - scene_.columns() / 2.0, up = scene_.rows() / 2.0 - row - 0.5;
    if (!scene_.is_panorama()) {
      const double step = scene_.tangent_per_sample() * scale_;
      const double length = std::hypot(across * step, up * step, 1);
      return {across * step / length, up * step / length, 1 / length};
    }
    const double longitude = across * 2 * pi / scene_.columns(), latitude = up * pi / scene_.rows();
    const double yaw = radians(scene_.view().yaw_deg), pitch = radians(scene_.view().pitch_deg);
    // Turned back by the yaw, then tilted back.
    const double x = std::cos(latitude) * std::sin(longitude - yaw), y = std::sin(latitude),
                 z = std::cos(latitude) * std::cos(longitude - yaw);
    return {x, y * std::cos(pitch) - z * std::sin(pitch), y * std::sin(pitch) + z * std::cos(pitch)};
  }
  /// What a sample's radiance is multiplied with to be irradiance at the first vertex, across its light [sr].
  double solid_angle(int row, double cosine) const {
    if (scene_.is_panorama()) {
      const double latitude = (scene_.rows() / 2.0 - row - 0.5) * pi / scene_.rows();
      return 2 * pi / scene_.columns() * pi / scene_.rows() * std::cos(latitude);
    }
    const double step = scene_.tangent_per_sample() * scale_;
    return step * step * cosine * cosine * cosine;
  }
  std::optional<double> distance_mm() const {
    return scene_.distance_m() ? std::optional(vertex_mm_) : std::nullopt;
  }

 private:
  const Scene& scene_;
  double vertex_mm_ = 0, scale_ = 1;
};

std::vector<float> mean_of_bands(const Scene& scene) {
  std::vector<float> mean(scene.band_size());
  for (int band = 0; band < scene.bands(); ++band) {
    const std::span<const float> values = scene.band(band);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += values[i] / static_cast<float>(scene.bands());
    scene.release_memory();
  }
  return mean;
}

/// Samples that touch, each list in the order in which they are found.
std::vector<std::vector<std::size_t>> bright_patches(const Scene& scene, double threshold) {
  const std::vector<float> mean = mean_of_bands(scene);
  const double level =
      threshold * std::accumulate(mean.begin(), mean.end(), 0.0) / static_cast<double>(mean.size());
  const int columns = scene.columns(), rows = scene.rows();
  std::vector<bool> seen(mean.size());
  std::vector<std::vector<std::size_t>> patches;
  for (std::size_t start = 0; start < mean.size(); ++start) {
    if (seen[start] || !(mean[start] > level)) continue;
    std::vector<std::size_t> patch{start};
    seen[start] = true;
    for (std::size_t next = 0; next < patch.size(); ++next) {
      const int row = static_cast<int>(patch[next] / static_cast<std::size_t>(columns)),
                column = static_cast<int>(patch[next] % static_cast<std::size_t>(columns));
      for (int r = std::max(0, row - 1); r <= std::min(rows - 1, row + 1); ++r)
        for (int step = -1; step <= 1; ++step) {
          int c = column + step;
          if (scene.is_panorama()) c = (c + columns) % columns;
          if (c < 0 || c >= columns) continue;
          const std::size_t at =
              static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c);
          if (seen[at] || !(mean[at] > level)) continue;
          seen[at] = true;
          patch.push_back(at);
        }
    }
    patches.push_back(std::move(patch));
  }
  return patches;
}

double total(const BrightSource& source) {
  return std::accumulate(source.irradiance.begin(), source.irradiance.end(), 0.0);
}

}  // namespace

void SourceSearch::validate() const {
  if (!(threshold > 0 && std::isfinite(threshold)))
    throw InputError(fmt::format("`ghost_threshold` is {:g}; more than 0 would be right", threshold));
  if (most < 1) throw InputError(fmt::format("{} sources; 1 or more would be right", most));
}

SourcesFound brightest(std::vector<BrightSource> sources, int most) {
  std::ranges::stable_sort(sources, [](const auto& a, const auto& b) { return total(a) > total(b); });
  SourcesFound found;
  double all = 0, left_out = 0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const double light = total(sources[i]);
    all += light;
    if (i >= static_cast<std::size_t>(most)) ++found.left_out, left_out += light;
  }
  found.left_out_share = all > 0 ? left_out / all : 0;
  sources.resize(std::min(sources.size(), static_cast<std::size_t>(most)));
  found.sources = std::move(sources);
  return found;
}

SourcesFound find_sources(const Scene& scene, double track_mm, const SourceSearch& search) {
  search.validate();
  if (!scene.depth_m.empty())
    throw InputError(
        "ghosts of a scene with depth are not followed; a scene on a plane or a panorama would be right");
  const SampleView view(scene, track_mm);
  const auto columns = static_cast<std::size_t>(scene.columns());
  std::vector<BrightSource> sources;
  for (const std::vector<std::size_t>& patch : bright_patches(scene, search.threshold)) {
    BrightSource source;
    source.distance_mm = view.distance_mm();
    source.irradiance.assign(static_cast<std::size_t>(scene.bands()), 0);
    std::array<double, 3> middle{};
    double solid_angle = 0;
    for (const std::size_t at : patch) {
      const int row = static_cast<int>(at / columns), column = static_cast<int>(at % columns);
      const std::array<double, 3> towards = view.towards(column, row);
      if (!(towards[2] > std::cos(radians(farthest_deg)))) continue;
      const double share = view.solid_angle(row, towards[2]);
      double light = 0;
      for (int band = 0; band < scene.bands(); ++band) {
        const double each = share * double(scene.band(band)[at]);
        source.irradiance[static_cast<std::size_t>(band)] += each;
        light += each;
      }
      solid_angle += share;
      for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] += light * towards[axis];
    }
    if (!(middle[2] > 0)) continue;
    source.right = middle[0] / middle[2];
    source.up = middle[1] / middle[2];
    source.radius_rad = std::min(std::sqrt(solid_angle / pi), radians(44));
    source.name = fmt::format("{:.1f}, {:.1f} degrees", degrees(std::atan(source.right)),
                              degrees(std::atan(source.up)));
    sources.push_back(std::move(source));
  }
  return brightest(std::move(sources), search.most);
}

}  // namespace petzval
