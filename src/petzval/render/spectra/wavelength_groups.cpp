// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/render/spectra/wavelength_groups.h>

namespace petzval::render {

WavelengthGroups::WavelengthGroups(std::vector<double> wavelengths_nm)
    : wavelengths_nm_(std::move(wavelengths_nm)) {
  double last = 0;
  for (const double nm : wavelengths_nm_) {
    if (!(nm > last) || !std::isfinite(nm))
      throw InputError("wavelengths must be positive and strictly increasing");
    last = nm;
  }
  if (wavelengths_nm_.empty()) throw InputError("a picture needs at least one wavelength");
  const int bands = static_cast<int>(wavelengths_nm_.size());
  count_ = (bands + lane_count - 1) / lane_count;
  for (int group = 0; group < count_; ++group) lanes_.push_back((bands - group + count_ - 1) / count_);
}

double WavelengthGroups::wavelength_nm(int group, int lane) const {
  const int at = band(group, lane);
  return wavelengths_nm_[static_cast<std::size_t>(at < 0 ? group : at)];
}

BandSpectrum WavelengthGroups::sampled(const std::function<double(double)>& value) const {
  BandSpectrum result(static_cast<std::size_t>(count_));
  for (int group = 0; group < count_; ++group)
    for (int lane = 0; lane < lane_count; ++lane)
      result[static_cast<std::size_t>(group)][lane] = static_cast<float>(value(wavelength_nm(group, lane)));
  return result;
}

double mean_of(const BandSpectrum& spectrum) {
  double sum = 0;
  for (const Lanes& lanes : spectrum)
    for (const float value : lanes.v) sum += static_cast<double>(value);
  return sum / static_cast<double>(spectrum.size() * lane_count);
}

}  // namespace petzval::render
