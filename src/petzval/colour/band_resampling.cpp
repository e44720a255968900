// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/band_resampling.h>

#include <algorithm>
#include <map>

namespace petzval {

namespace {

/// Wavelengths that differ by less than this are the same one [nm]: a file's rounding, not another colour.
constexpr double same_wavelength_nm = 1e-6;

/// A wavelength among others: between `lower` and `lower + 1`, `fraction` of the way.
struct Position {
  std::size_t lower = 0;
  double fraction = 0;
};

Position position(std::span<const double> grid_nm, double wavelength_nm) {
  const auto above = std::upper_bound(grid_nm.begin(), grid_nm.end(), wavelength_nm);
  if (above == grid_nm.begin()) return {};
  const auto lower = static_cast<std::size_t>(above - grid_nm.begin()) - 1;
  if (above == grid_nm.end()) return {lower, 0};
  return {lower, (wavelength_nm - grid_nm[lower]) / (*above - grid_nm[lower])};
}

void check(std::span<const double> from_nm, std::span<const double> to_nm) {
  for (const double nm : to_nm)
    if (!(nm >= from_nm.front() - same_wavelength_nm && nm <= from_nm.back() + same_wavelength_nm))
      throw InputError(fmt::format("the scene has no radiance at {} nm; its bands reach from {} to {} nm", nm,
                                   from_nm.front(), from_nm.back()));
}

/// All wavelengths of both within the range of `to`; those that are the same, once.
std::vector<double> united(std::span<const double> from_nm, std::span<const double> to_nm) {
  std::vector<double> all(to_nm.begin(), to_nm.end());
  for (const double nm : from_nm) {
    const auto near = std::lower_bound(to_nm.begin(), to_nm.end(), nm - same_wavelength_nm);
    if (nm > to_nm.front() && nm < to_nm.back() && !(*near <= nm + same_wavelength_nm)) all.push_back(nm);
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

BandResampling::BandResampling(std::span<const double> from_nm, std::span<const double> to_nm) {
  check(from_nm, to_nm);
  const std::vector<double> fine = to_nm.size() == 1 ? std::vector<double>{to_nm[0]} : united(from_nm, to_nm);
  const std::vector<double> widths = band_widths_nm(fine), new_widths = band_widths_nm(to_nm);
  std::vector<std::map<std::size_t, double>> sums(to_nm.size());
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const Position old = position(from_nm, fine[i]), to = position(to_nm, fine[i]);
    const auto share = [&](std::size_t new_band, double part) {
      const double weight = part * widths[i] / new_widths[new_band];
      if (weight == 0) return;
      if (old.fraction < 1) sums[new_band][old.lower] += weight * (1 - old.fraction);
      if (old.fraction > 0) sums[new_band][old.lower + 1] += weight * old.fraction;
    };
    share(to.lower, 1 - to.fraction);
    if (to.fraction > 0) share(to.lower + 1, to.fraction);
  }
  for (const auto& sum : sums) {
    rows_.emplace_back();
    for (const auto& [band, weight] : sum) rows_.back().push_back({band, weight});
  }
}

Spectrum resampled(const Spectrum& spectrum, std::span<const double> to_nm) {
  const BandResampling resampling(spectrum.wavelengths_nm(), to_nm);
  std::vector<double> values(to_nm.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i)
    for (const auto& [band, weight] : resampling.terms(i)) values[i] += weight * spectrum.values()[band];
  return {std::vector<double>(to_nm.begin(), to_nm.end()), std::move(values)};
}

}  // namespace petzval
