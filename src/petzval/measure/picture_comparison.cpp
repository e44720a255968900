// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/measure/picture_comparison.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

[[noreturn]] void differ(const ComparablePicture& a, const ComparablePicture& b, const std::string& what) {
  throw InputError(fmt::format("{} and {} cannot be compared: {}", a.name, b.name, what));
}

std::string list(const std::vector<double>& wavelengths_nm) {
  return fmt::format("{} from {:g} to {:g} nm", wavelengths_nm.size(), wavelengths_nm.front(),
                     wavelengths_nm.back());
}

void require_alike(const ComparablePicture& a, const ComparablePicture& b) {
  if (a.columns != b.columns || a.rows != b.rows)
    differ(a, b,
           fmt::format("{} × {} pixels and {} × {}: equal sizes are right", a.columns, a.rows, b.columns,
                       b.rows));
  if (a.bands != b.bands)
    differ(a, b, fmt::format("{} bands and {}: equal bands are right", a.bands, b.bands));
  if (a.display != b.display) differ(a, b, "one is a picture for display, the other is not");
  if (!a.units.empty() && !b.units.empty() && a.units != b.units)
    differ(a, b, fmt::format("{} and {}: equal units are right", a.units, b.units));
  if (!a.wavelengths_nm.empty() && !b.wavelengths_nm.empty()) {
    constexpr double rounding_nm = 1e-3;  // spectral EXR files name their channels in decimal
    for (std::size_t band = 0; band < a.bands; ++band)
      if (std::abs(a.wavelengths_nm[band] - b.wavelengths_nm[band]) > rounding_nm)
        differ(a, b,
               fmt::format("bands are {} and {}, the first to differ is {:g} and {:g} nm",
                           list(a.wavelengths_nm), list(b.wavelengths_nm), a.wavelengths_nm[band],
                           b.wavelengths_nm[band]));
  }
  constexpr double relative_rounding = 1e-9;
  if (a.pitch_um > 0 && b.pitch_um > 0 && std::abs(a.pitch_um - b.pitch_um) > relative_rounding * a.pitch_um)
    differ(a, b, fmt::format("pixels of {:g} and {:g} µm: an equal pitch is right", a.pitch_um, b.pitch_um));
}

struct Sums {
  double difference = 0, reference = 0, largest = 0, count = 0;

  void add(const Sums& other) {
    difference += other.difference;
    reference += other.reference;
    largest = std::max(largest, other.largest);
    count += other.count;
  }
  PictureDifference over(double peak) const {
    const auto ratio = [](double part, double whole) { return part == 0 ? 0 : part / whole; };
    PictureDifference result;
    result.relative_l2 = ratio(std::sqrt(difference), std::sqrt(reference));
    result.max_error_over_peak = ratio(largest, peak);
    result.psnr_db = 20 * std::log10(peak / std::sqrt(difference / count));
    if (difference == 0) result.psnr_db = INFINITY;
    result.peak = peak;
    return result;
  }
};

}  // namespace

PictureComparison compare_pictures(const ComparablePicture& picture, const ComparablePicture& reference) {
  require_alike(picture, reference);
  std::vector<Sums> bands(picture.bands);
  Sums all;
  double peak = picture.display ? 1 : 0;
  for (std::size_t band = 0; band < picture.bands; ++band) {
    Sums& sums = bands[band];
    sums.count = double(picture.pixels());
    for (std::size_t pixel = 0; pixel < picture.pixels(); ++pixel) {
      const double r = reference.at(band, pixel), d = picture.at(band, pixel) - r;
      sums.difference += d * d;
      sums.reference += r * r;
      sums.largest = std::max(sums.largest, std::abs(d));
      if (!picture.display) peak = std::max(peak, std::abs(r));
    }
    all.add(sums);
  }
  PictureComparison comparison;
  comparison.all = all.over(peak);
  for (const Sums& sums : bands) comparison.bands.push_back(sums.over(peak));
  return comparison;
}

}  // namespace petzval
