// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/focus/focus_judge.h>

#include <cmath>
#include <limits>
#include <utility>

namespace petzval {

FocusJudge::FocusJudge(const PicturesAt& pictures_at, const std::vector<FocusZone>& zones,
                       const FocusMeasureOptions& measure, std::vector<int> scales)
    : pictures_at_(pictures_at), zones_(zones), measure_(measure), scales_(std::move(scales)) {
  if (zones.empty()) throw InputError("autofocus needs at least one zone");
}

double FocusJudge::measure_of(const std::vector<ZonePicture>& pictures, int scale) const {
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < zones_.size(); ++i) {
    sum += zones_[i].area() * focus_measure(scale > 1 ? binned(pictures[i], scale) : pictures[i], measure_);
    area += zones_[i].area();
  }
  const double value = sum / area;
  if (!std::isfinite(value)) throw InputError("a picture holds a value that is not finite");
  return value;
}

double FocusJudge::noise_of(const std::vector<ZonePicture>& pictures) const {
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < zones_.size(); ++i) {
    const double noise = zones_[i].area() * focus_measure_noise(pictures[i], measure_);
    sum += noise * noise, area += zones_[i].area();
  }
  return std::sqrt(sum) / area;
}

double FocusJudge::at(double film_distance_mm, const char* stage) {
  const std::vector<ZonePicture> pictures = pictures_at_(film_distance_mm);
  if (pictures.size() != zones_.size())
    throw InputError(fmt::format("{} pictures for {} zones", pictures.size(), zones_.size()));
  const double value = measure_of(pictures, 1);
  result.evaluations.push_back({film_distance_mm, value, noise_of(pictures), stage});
  if (value > result.measure) result.measure = value, result.film_distance_mm = film_distance_mm;
  binned_.emplace_back();
  for (const int scale : scales_) binned_.back().push_back(measure_of(pictures, scale));
  return value;
}

FocusResult FocusJudge::seen_at(std::size_t i) const {
  FocusResult seen;
  for (std::size_t k = 0; k < result.evaluations.size(); ++k) {
    seen.evaluations.push_back(result.evaluations[k]);
    seen.evaluations.back().measure = binned_[k][i];
    if (binned_[k][i] > seen.measure)
      seen.measure = binned_[k][i], seen.film_distance_mm = result.evaluations[k].film_distance_mm;
  }
  return seen;
}

void check_film_range(double nearest_mm, double farthest_mm) {
  if (!(nearest_mm >= 0 && nearest_mm < farthest_mm) || !std::isfinite(farthest_mm))
    throw InputError(fmt::format("film distances from {} to {} mm are no range", nearest_mm, farthest_mm));
}

void require_contrast(const FocusResult& result) {
  if (!(result.measure > 0))
    throw InputError("no picture has any contrast in the zones; zones with some detail would be right");
}

double focus_cost(double measure) {
  return measure > 0 ? -std::log(measure) : std::numeric_limits<double>::max();
}

}  // namespace petzval
