// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/spot_moments.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double SpotMoments::*means[] = {&SpotMoments::x,          &SpotMoments::y,   &SpotMoments::slope_x,
                                          &SpotMoments::slope_y,    &SpotMoments::r_r, &SpotMoments::r_slope,
                                          &SpotMoments::slope_slope};

double covariance(const SpotMoments& at) {
  return at.r_slope - at.y * at.slope_y - at.x * at.slope_x;
}
double slope_variance(const SpotMoments& at) {
  return at.slope_slope - at.slope_y * at.slope_y - at.slope_x * at.slope_x;
}

}  // namespace

double SpotMoments::variance(double shift_mm) const {
  const double here = r_r - y * y - x * x;
  return std::max(0.0, here + shift_mm * (2 * covariance(*this) + shift_mm * slope_variance(*this)));
}

SpotMoments spot_moments(const std::vector<PupilRay>& rays, const ChiefRay& chief, RayWeight weight) {
  SpotMoments moments;
  double total = 0;
  for (const PupilRay& ray : rays) {
    const double gamma = std::sqrt(1 - ray.alpha * ray.alpha - ray.beta * ray.beta);
    const double w = weight == RayWeight::light ? ray.entrance_measure : ray.stop_area_mm2;
    const double x = ray.x_mm + chief.image_x_mm, y = ray.y_mm + chief.image_height_mm;
    const double slope_x = ray.alpha / gamma, slope_y = ray.beta / gamma;
    total += w;
    if (!ray.mirrored) moments.x += w * x;
    if (!ray.mirrored) moments.slope_x += w * slope_x;
    moments.y += w * y;
    moments.slope_y += w * slope_y;
    moments.r_r += w * (x * x + y * y);
    moments.r_slope += w * (x * slope_x + y * slope_y);
    moments.slope_slope += w * (slope_x * slope_x + slope_y * slope_y);
  }
  for (const auto mean : means) moments.*mean /= total;
  return moments;
}

SpotMoments mixed(std::span<const SpotMoments> spots, const std::vector<double>& shares) {
  SpotMoments all;
  for (std::size_t i = 0; i < spots.size(); ++i)
    for (const auto mean : means) all.*mean += shares[i] * spots[i].*mean;
  return all;
}

double best_shift_mm(std::span<const SpotMoments> spots) {
  double covariances = 0, variances = 0;
  for (const SpotMoments& spot : spots) {
    covariances += covariance(spot);
    variances += slope_variance(spot);
  }
  return -covariances / variances;
}

}  // namespace petzval
