// SPDX-License-Identifier: BSD-3-Clause
// A planar spectral scene: what the camera is pointed at.
#pragma once

#include <petzval/base/large_floats.h>
#include <petzval/colour/spectrum.h>
#include <petzval/scene/scene_drawing.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace petzval {

/// The bands of charts and photographs unless others are asked for: 400 to 700 nm every 10 nm.
std::vector<double> default_bands_nm();

/// Where a camera looks within a panorama: turned to the right by `yaw`, then tilted up by `pitch`.
struct PanoramaView {
  double yaw_deg = 0, pitch_deg = 0;
};

/// Where the depths of a scene count from.
enum class DepthFrom {
  sensor,  ///< along the axis, from the sensor plane, as the distances of scenes do
  pupil,   ///< along the axis, from the viewpoint (the lens's entrance pupil): the depth of a pinhole camera
  range    ///< along the line of sight, from the viewpoint
};

/// Spectral radiance [W·m⁻²·sr⁻¹·nm⁻¹] on a plane perpendicular to the optical axis, Lambertian. Samples are
/// squares, rows from the top, upright as a person at the camera sees it. The angular width w belongs to the
/// scene: at distance d its width is 2 d tan(w/2), so that the tangent of the object angle is linear in the
/// sample index, for infinite distance too.
///
/// Or a panorama of all directions, at infinity: equirectangular, so that columns are even steps of longitude
/// from −180° on the left to 180° on the right, rows of latitude from 90° on top to −90°; the middle lies
/// straight ahead.
class Scene {
 public:
  /// The most samples times bands that a scene may have (8 GiB).
  static constexpr std::size_t max_values = std::size_t{1} << 31;

  Scene() = default;
  /// All zero. \throws InputError on sizes below 1, wavelengths that do not increase, more than `max_values`
  /// values, an angle outside (0, 180) or a distance that is not positive.
  Scene(int columns, int rows, std::vector<double> wavelengths_nm, double horizontal_angle_deg,
        std::optional<double> distance_m);
  /// Of this radiance, a plane a wavelength. \throws InputError as above, and for another number of values.
  Scene(int columns, int rows, std::vector<double> wavelengths_nm, double horizontal_angle_deg,
        std::optional<double> distance_m, LargeFloats radiance);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int bands() const { return static_cast<int>(wavelengths_nm_.size()); }
  const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }
  std::size_t band_size() const {
    return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  }
  /// To be written: what is known of the scene beyond its samples, drawing(), is given up.
  std::span<float> band(int index);
  std::span<const float> band(int index) const;
  /// All bands, one after the other.
  std::span<const float> values() const { return radiance_.all(); }
  /// Between bands or rows of a large scene: as SpectralImage::release_memory().
  void release_memory() const { radiance_.release_memory(); }

  /// Makes a panorama of the samples. \throws InputError unless there are twice as many columns as rows, at
  /// infinity, and the view is finite.
  void make_panorama(PanoramaView view = {});
  bool is_panorama() const { return view_.has_value(); }
  /// Of a panorama.
  PanoramaView view() const { return view_.value_or(PanoramaView{}); }

  /// Full horizontal angle; the vertical one follows from square samples. A panorama has 360° × 180°.
  double horizontal_angle_deg() const { return is_panorama() ? 360 : horizontal_angle_deg_; }
  double vertical_angle_deg() const;
  double diagonal_angle_deg() const;
  /// tan(object angle) from one sample to the next; of a panorama the angle, at its middle.
  double tangent_per_sample() const;
  /// From the sensor plane to the scene [m]; absent: at infinity.
  std::optional<double> distance_m() const { return distance_m_; }
  /// \throws InputError unless positive; a panorama stays at infinity.
  void set_distance_m(std::optional<double> distance_m);
  /// \throws InputError unless between 0 and 180, or for a panorama.
  void set_horizontal_angle_deg(double angle);

  /// Mean spectral radiance of each band over all samples [W·m⁻²·sr⁻¹·nm⁻¹].
  std::vector<double> mean_radiance() const;
  /// Mean CIE 1931 luminance [cd/m²] over all samples (683 lm/W · Σ ȳ L Δλ, Observer::weights).
  double mean_luminance_cd_m2() const;
  /// Scales all radiance (and the illuminant) so that the mean luminance is this. \throws InputError for a
  /// scene that is black to the eye.
  void set_mean_luminance_cd_m2(double luminance);
  /// Multiplies all radiance and the illuminant. \throws InputError unless the factor is positive and finite.
  void scale(double factor);
  /// Multiplies the radiance of each band.
  void scale_bands(std::span<const double> factors);
  /// The scene at other wavelengths, its radiance kept (BandResampling). \throws InputError for one outside
  /// the bands.
  Scene resampled(std::span<const double> wavelengths_nm) const;
  /// \throws InputError at the first NaN, infinity or negative radiance, and the first NaN or negative depth,
  /// naming band, row and column; for a depth map of another size, or of a panorama.
  void validate() const;

  /// The figures that the samples show, where they are known: image formation lays them on its cells, so that
  /// edges are as sharp on any sensor. Null: the samples are all there is.
  const SceneDrawing* drawing() const { return drawing_ ? &*drawing_ : nullptr; }
  /// Of the samples as they are.
  void set_drawing(SceneDrawing drawing) { drawing_ = std::move(drawing); }
  void forget_drawing() { drawing_.reset(); }

  std::string name;
  std::optional<Spectrum>
      illuminant;  ///< spectral irradiance/π [W·m⁻²·sr⁻¹·nm⁻¹] of a perfect white, if known
  /// Empty, or rows·columns distances, row-major. Infinity and 0: nothing is there, at any distance.
  std::vector<float> depth_m;
  DepthFrom depth_from = DepthFrom::sensor;
  /// What had to be assumed of a file, or looks like a mistake: a line each, for whoever asked for the scene.
  std::vector<std::string> notes;

  /// Calls work(band, its radiance) for every band, one after the other, and gives the memory of each back.
  template <typename Work>
  void for_each_band(const Work& work) {
    for (int index = 0; index < bands(); ++index) {
      work(static_cast<std::size_t>(index), band(index));
      release_memory();
    }
  }

 private:
  struct Empty {};
  Scene(Empty, int columns, int rows, std::vector<double> wavelengths_nm, double horizontal_angle_deg,
        std::optional<double> distance_m);
  void validate_depth() const;

  int columns_ = 0, rows_ = 0;
  std::vector<double> wavelengths_nm_;
  double horizontal_angle_deg_ = 0;
  std::optional<double> distance_m_;
  std::optional<PanoramaView> view_;  ///< of a panorama
  LargeFloats radiance_;
  std::optional<SceneDrawing> drawing_;
};

}  // namespace petzval
