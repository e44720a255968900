// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/wavelength.h>
#include <petzval/image/spectral_image.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

void check_wavelengths(const std::vector<double>& wavelengths_nm) {
  if (wavelengths_nm.empty()) throw InputError("an image needs at least one wavelength");
  for (std::size_t i = 0; i < wavelengths_nm.size(); ++i) {
    require_wavelength(wavelengths_nm[i], "an image's bands");
    if (i > 0 && wavelengths_nm[i] <= wavelengths_nm[i - 1])
      throw InputError(fmt::format("the wavelengths of an image must increase, but {} nm comes after {} nm",
                                   wavelengths_nm[i], wavelengths_nm[i - 1]));
  }
}

}  // namespace

SpectralImage::SpectralImage(int columns, int rows, std::vector<double> wavelengths_nm, double pitch_um,
                             PixelAperture aperture)
    : columns_(columns),
      rows_(rows),
      wavelengths_nm_(std::move(wavelengths_nm)),
      pitch_um_(pitch_um),
      aperture_(aperture) {
  check(columns, rows, wavelengths_nm_, pitch_um);
  values_ = LargeFloats(band_size() * wavelengths_nm_.size());
}

void SpectralImage::check(int columns, int rows, const std::vector<double>& wavelengths_nm, double pitch_um) {
  if (columns < 1 || rows < 1)
    throw InputError(fmt::format("an image of {} x {} pixels; both sizes must be at least 1", columns, rows));
  check_wavelengths(wavelengths_nm);
  if (!(pitch_um > 0) || std::isinf(pitch_um))
    throw InputError(fmt::format("a pixel pitch of {} um; it must be positive", pitch_um));
  if (wavelengths_nm.size() >
      max_values / (static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)))
    throw InputError(fmt::format("an image of {} x {} pixels and {} bands is more than {} values", columns,
                                 rows, wavelengths_nm.size(), max_values));
}

std::span<float> SpectralImage::band(int index) {
  return values_.all().subspan(static_cast<std::size_t>(index) * band_size(), band_size());
}

std::span<const float> SpectralImage::band(int index) const {
  return values_.all().subspan(static_cast<std::size_t>(index) * band_size(), band_size());
}

void SpectralImage::store_band(int index, std::span<const float> plane) {
  if (index < 0 || index >= bands() || plane.size() != band_size())
    throw InputError(fmt::format("{} values for band {} of an image of {} bands of {}", plane.size(), index,
                                 bands(), band_size()));
  values_.store(static_cast<std::size_t>(index) * band_size(), plane);
}

void SpectralImage::give_up_band(int index) {
  if (index < 0 || index >= bands())
    throw InputError(fmt::format("band {} of an image of {} bands", index, bands()));
  values_.give_up(static_cast<std::size_t>(index) * band_size(), band_size());
}

float& SpectralImage::at(int band_index, int row, int column) {
  return band(band_index)[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                          static_cast<std::size_t>(column)];
}

float SpectralImage::at(int band_index, int row, int column) const {
  return band(band_index)[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                          static_cast<std::size_t>(column)];
}

void SpectralImage::validate() const {
  const auto columns = static_cast<std::size_t>(columns_);
  for (int index = 0; index < bands(); ++index) {
    const std::span<const float> values = band(index);
    const auto bad =
        std::find_if(values.begin(), values.end(), [](float value) { return !std::isfinite(value); });
    if (bad != values.end()) {
      const auto at = static_cast<std::size_t>(bad - values.begin());
      throw InputError(fmt::format("the irradiance at {} nm, row {}, column {} is {}; it must be finite",
                                   wavelengths_nm_[static_cast<std::size_t>(index)], at / columns,
                                   at % columns, *bad));
    }
    release_memory();
  }
}

}  // namespace petzval
