// SPDX-License-Identifier: BSD-3-Clause
// A planar spectral scene: what the camera is pointed at.
#pragma once

#include <petzval/colour/spectrum.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// Spectral radiance [W·m⁻²·sr⁻¹·nm⁻¹] on a plane perpendicular to the optical axis, Lambertian. Samples are
/// squares, rows from the top, upright as a person at the camera sees it. The angular width w belongs to the
/// scene: at distance d its width is 2 d tan(w/2), so that the tangent of the object angle is linear in the
/// sample index, for infinite distance too.
class Scene {
 public:
  Scene() = default;
  /// All zero. \throws InputError as SpectralImage, or for an angle outside (0, 180).
  Scene(int columns, int rows, std::vector<double> wavelengths_nm, double horizontal_angle_deg,
        std::optional<double> distance_m);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int bands() const { return static_cast<int>(wavelengths_nm_.size()); }
  const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }
  std::size_t band_size() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }
  std::span<float> band(int index);
  std::span<const float> band(int index) const;

  /// Full horizontal angle; the vertical one follows from square samples.
  double horizontal_angle_deg() const { return horizontal_angle_deg_; }
  double vertical_angle_deg() const;
  double diagonal_angle_deg() const;
  /// tan(object angle) from one sample to the next.
  double tangent_per_sample() const;
  /// From the sensor plane to the scene [m]; absent: at infinity.
  std::optional<double> distance_m() const { return distance_m_; }
  void set_distance_m(std::optional<double> distance_m);
  void set_horizontal_angle_deg(double angle);

  /// Mean CIE 1931 luminance [cd/m²] over all samples (683 lm/W · Σ ȳ L Δλ).
  double mean_luminance_cd_m2() const;
  /// Scales all radiance so that the mean luminance is this. \throws InputError for a black scene.
  void set_mean_luminance_cd_m2(double luminance);
  /// Keeps only the bands nearest to / interpolated at these wavelengths (linear; no extrapolation).
  Scene resampled(std::span<const double> wavelengths_nm) const;
  /// \throws InputError at the first NaN, infinity or negative radiance, naming band, row and column.
  void validate() const;

  std::string name;
  std::optional<Spectrum> illuminant;  ///< spectral irradiance/π [W·m⁻²·sr⁻¹·nm⁻¹] of a perfect white, if known
  std::vector<float> depth_m;          ///< empty, or rows·columns distances

 private:
  int columns_ = 0, rows_ = 0;
  std::vector<double> wavelengths_nm_;
  double horizontal_angle_deg_ = 0;
  std::optional<double> distance_m_;
  std::vector<float> radiance_;
};

}  // namespace petzval
