// SPDX-License-Identifier: BSD-3-Clause
// From light on the sensor to electrons per second in its pixels.
#pragma once

#include <petzval/image/spectral_image.h>
#include <petzval/sensor/sensor.h>

#include <optional>
#include <span>
#include <vector>

namespace petzval {

/// Mean photoelectrons per second of every pixel of a frame, before any noise.
struct PhotoCurrent {
  int columns = 0, rows = 0;
  /// The place on the sensor of the frame's first pixel: smaller frames are read from the middle.
  int first_column = 0, first_row = 0;
  std::vector<float> e_per_s;  ///< row by row
};

struct PhotoCurrentOptions {
  bool crosstalk = true, microlens = true;
  /// From the sensor, negative in front of it; absent: as the image says.
  std::optional<double> exit_pupil_mm;
};

/// What each band of an image adds to the current of a pixel [(e/s) / (W·m⁻²·nm⁻¹)]: pitch²/(hc) · ∫ hat · η
/// λ dλ, so that light that is linear between its bands meets a quantum efficiency that is linear between its
/// samples without an error of quadrature. A single band stands for 1 nm, as everywhere.
std::vector<double> electron_weights(const Spectrum& quantum_efficiency,
                                     std::span<const double> wavelengths_nm, double pitch_um);

/// Light through the colour filters. A frame smaller than the sensor is taken from its middle, on the same
/// phase of the mosaic. \throws InputError if the image is larger than the sensor, or its pitch or pixel
/// aperture are not the sensor's; for a sensor with a microlens, if the exit pupil is not known; for NaN.
PhotoCurrent photo_current(const SpectralImage& image, const Sensor& sensor,
                           const PhotoCurrentOptions& options = {});

/// Mean current [e/s] of the pixels of each channel.
std::vector<double> channel_means(const PhotoCurrent& current, const SensorElectronics& electronics);

/// Electrons per second in a pixel of each channel under this spectral irradiance [W·m⁻²·nm⁻¹] all over the
/// sensor, crosstalk between its channels included.
std::vector<double> channel_currents(const Sensor& sensor, const Spectrum& irradiance);

}  // namespace petzval
