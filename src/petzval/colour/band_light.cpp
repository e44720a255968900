// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/band_light.h>
#include <petzval/colour/band_resampling.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double narrow_nm = 100, narrow_share = 0.9;
/// Bands as far as this from the middle of a narrow light are meant for it: a line drifts by as much.
constexpr double near_nm = 10;
/// A light ends at once: from its last sample to zero within this.
constexpr double end_nm = 1e-4;

struct Interval {
  double from = 0, to = 0;
};

/// The wavelength below which this share of the light lies.
double quantile_nm(const Spectrum& light, double share) {
  const std::vector<double>&nm = light.wavelengths_nm(), &power = light.values();
  double left = share * light.integral(light.front_nm(), light.back_nm());
  for (std::size_t i = 1; i < nm.size(); ++i) {
    const double step = nm[i] - nm[i - 1], area = 0.5 * step * (power[i - 1] + power[i]);
    if (area < left || area <= 0) {
      left -= area;
      continue;
    }
    // power₀ x + (power₁ − power₀) x²/(2 step) = left, solved without cancellation.
    const double slope = (power[i] - power[i - 1]) / step;
    const double root = std::sqrt(std::max(0.0, power[i - 1] * power[i - 1] + 2 * slope * left));
    return nm[i - 1] + (left > 0 ? 2 * left / (power[i - 1] + root) : 0);
  }
  return light.back_nm();
}

/// The middle 90 % of the light.
Interval middle(const Spectrum& light) {
  return {quantile_nm(light, 0.5 * (1 - narrow_share)), quantile_nm(light, 0.5 * (1 + narrow_share))};
}

/// The light with the darkness about it, at least as far as the bands reach.
Spectrum with_darkness(const Spectrum& light, std::span<const double> bands_nm) {
  std::vector<double> nm, values;
  const auto add = [&](double at, double value) { nm.push_back(at), values.push_back(value); };
  const double first = light.front_nm() - end_nm, last = light.back_nm() + end_nm;
  if (bands_nm.front() < first) add(bands_nm.front(), 0);
  if (first > 0) add(first, 0);
  for (std::size_t i = 0; i < light.values().size(); ++i) add(light.wavelengths_nm()[i], light.values()[i]);
  add(last, 0);
  if (bands_nm.back() > last) add(bands_nm.back(), 0);
  return Spectrum(std::move(nm), std::move(values));
}

std::vector<double> through_filters(const Spectrum& light, std::span<const double> bands_nm,
                                    double width_nm) {
  if (!(width_nm > 0 && std::isfinite(width_nm)))
    throw InputError(fmt::format("`scene.band_width_nm` {}: a width above 0 would be right", width_nm));
  const std::vector<double> widths = band_widths_nm(bands_nm);
  std::vector<double> result;
  for (std::size_t i = 0; i < bands_nm.size(); ++i)
    result.push_back(light.integral(bands_nm[i] - width_nm / 2, bands_nm[i] + width_nm / 2) / widths[i]);
  return result;
}

/// The narrow light that lies beyond the bands goes to the first and the last of them.
void add_ends(const Spectrum& light, std::span<const double> bands_nm, std::vector<double>& shares) {
  const std::vector<double> widths = band_widths_nm(bands_nm);
  shares.front() += light.integral(light.front_nm(), bands_nm.front()) / widths.front();
  shares.back() += light.integral(bands_nm.back(), light.back_nm()) / widths.back();
}

}  // namespace

bool is_narrow(const Spectrum& light) {
  if (light.values().size() < 2) return false;
  const Interval most = middle(light);
  return most.to - most.from <= narrow_nm;
}

std::vector<double> band_light(const Spectrum& light, std::span<const double> bands_nm,
                               std::optional<double> width_nm) {
  if (width_nm) return through_filters(light, bands_nm, *width_nm);
  const Interval most = middle(light);
  const bool wholly =
      is_narrow(light) && bands_nm.back() >= most.from - near_nm && bands_nm.front() <= most.to + near_nm;
  if (bands_nm.size() == 1)
    return {wholly ? light.integral(light.front_nm(), light.back_nm()) : light.at(bands_nm[0])};
  std::vector<double> shares = resampled(with_darkness(light, bands_nm), bands_nm).values();
  if (wholly) add_ends(light, bands_nm, shares);
  return shares;
}

}  // namespace petzval
