// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/render/camera/lamp_guide.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

/// Brighter ones alone are looked for where there are more.
constexpr std::size_t most_lamps = 256;
/// A lamp that fills more of the pupil is found without a guide.
constexpr double widest_share = 0.25;
constexpr int cells_across = 64;

}  // namespace

LampGuide::LampGuide(std::span<const Lamp> all, std::span<const Tracer> tracers, const LensPlace& place,
                     const SensorGeometry& film, double margin_mm, const ExitPupilRegions& pupil) {
  std::vector<Lamp> lamps(all.begin(), all.end());
  std::ranges::stable_sort(lamps, std::greater<>(), [](const Lamp& lamp) {
    return lamp.radiance * lamp.radius * lamp.radius / dot(lamp.centre, lamp.centre);
  });
  lamps.resize(std::min(lamps.size(), most_lamps));
  std::vector<std::optional<LampDisk>> disks(lamps.size());
  parallel_tasks(lamps.size(), [&](std::size_t i) { disks[i] = LampDisk::find(lamps[i], tracers, place); });

  left_mm_ = -film.width_mm() / 2 - margin_mm, top_mm_ = -film.height_mm() / 2 - margin_mm;
  cell_mm_ = -2 * left_mm_ / cells_across;
  columns_ = cells_across, rows_ = static_cast<int>(std::ceil(-2 * top_mm_ / cell_mm_));
  cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::size_t i = 0; i < disks.size(); ++i) {
    if (!disks[i]) continue;
    const LampDisk& disk = *disks[i];
    const double pupil_sr = pupil.area_sr(disk.x_mm(), disk.y_mm());
    if (!(disk.area_sr() < widest_share * pupil_sr)) continue;
    const auto index = static_cast<std::uint32_t>(seen_.size());
    bool any = false;
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      const double x = left_mm_ + static_cast<double>(cell % static_cast<std::size_t>(columns_)) * cell_mm_;
      const double y = top_mm_ + static_cast<double>(cell / static_cast<std::size_t>(columns_)) * cell_mm_;
      if (!disk.reaches(std::clamp(disk.x_mm(), x, x + cell_mm_), std::clamp(disk.y_mm(), y, y + cell_mm_)))
        continue;
      cells_[cell].push_back(index);
      any = true;
    }
    if (any) seen_.push_back({disk, lamps[i].radiance * disk.area_sr()});
  }
}

const std::vector<std::uint32_t>& LampGuide::near(double x_mm, double y_mm) const {
  static const std::vector<std::uint32_t> none;
  if (seen_.empty()) return none;
  const int column = static_cast<int>(std::floor((x_mm - left_mm_) / cell_mm_));
  const int row = static_cast<int>(std::floor((y_mm - top_mm_) / cell_mm_));
  if (column < 0 || column >= columns_ || row < 0 || row >= rows_) return none;
  return cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                static_cast<std::size_t>(column)];
}

/// Of all disks that reach a film point.
double LampGuide::weight_at(double x_mm, double y_mm) const {
  double sum = 0;
  for (const std::uint32_t index : near(x_mm, y_mm))
    if (seen_[index].disk.reaches(x_mm, y_mm)) sum += seen_[index].weight;
  return sum;
}

bool LampGuide::concerns(double x_mm, double y_mm) const {
  return std::ranges::any_of(near(x_mm, y_mm),
                             [&](std::uint32_t index) { return seen_[index].disk.reaches(x_mm, y_mm); });
}

LampGuide::Direction LampGuide::sample(double x_mm, double y_mm, double u, double v) const {
  u *= weight_at(x_mm, y_mm);
  const Seen* chosen = nullptr;
  for (const std::uint32_t index : near(x_mm, y_mm)) {
    const Seen& seen = seen_[index];
    if (!seen.disk.reaches(x_mm, y_mm)) continue;
    if (chosen) u -= chosen->weight;
    chosen = &seen;
    if (u < seen.weight) break;
  }
  const double r = std::sqrt(std::clamp(u / chosen->weight, 0.0, 1.0)), phi = 2 * pi * v;
  const auto [alpha, beta] = chosen->disk.direction(x_mm, y_mm, r * std::cos(phi), r * std::sin(phi));
  return {alpha, beta};
}

double LampGuide::density_per_sr(double x_mm, double y_mm, double alpha, double beta) const {
  const double all = weight_at(x_mm, y_mm);
  double density = 0;
  for (const std::uint32_t index : near(x_mm, y_mm)) {
    const Seen& seen = seen_[index];
    if (seen.disk.reaches(x_mm, y_mm))
      density += seen.weight / all * seen.disk.density_per_sr(x_mm, y_mm, alpha, beta);
  }
  return density;
}

}  // namespace petzval::render
