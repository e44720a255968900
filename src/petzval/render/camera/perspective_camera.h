// SPDX-License-Identifier: BSD-3-Clause
// Ideal cameras, for comparison: a pinhole, and a thin lens.
#pragma once

#include <petzval/render/camera/film_camera.h>
#include <petzval/render/spectra/wavelength_groups.h>

namespace petzval::render {

struct PerspectiveOptions {
  int columns = 0, rows = 0;
  double field_of_view_deg = 90;  ///< across the shorter side (pbrt)
  double lens_radius = 0;         ///< scene units; 0: pinhole
  double focal_distance = 1e6;    ///< scene units, along the axis
  /// pbrt's screenwindow; all zero: ±1 along the shorter side.
  std::array<double, 4> screen_window{0, 0, 0, 0};
};

/// Pinhole and thin lens have no film distance, so no irradiance either: the picture holds radiance times 1
/// sr.
class PerspectiveCamera final : public FilmCamera {
 public:
  /// \throws InputError for a field of view outside (0°, 180°) or sizes that are not positive.
  PerspectiveCamera(const PerspectiveOptions& options, WavelengthGroups groups);
  void trace(int group, const FilmSampling& film, std::span<const FilmSample> samples,
             std::span<CameraRay> rays) const override;

 private:
  PerspectiveOptions options_;
  WavelengthGroups groups_;
  double left_, right_, bottom_, top_, slope_;
};

}  // namespace petzval::render
