// SPDX-License-Identifier: BSD-3-Clause
// Description of a sensor.
#pragma once

#include <petzval/colour/spectrum.h>
#include <petzval/sensor/mosaic.h>
#include <petzval/sensor/shutter.h>
#include <petzval/wave/photosite.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// Where the pixels are: columns × rows at a square pitch, centred on the optical axis.
struct SensorGeometry {
  int columns = 0, rows = 0;
  double pitch_um = 0;

  double width_mm() const { return columns * pitch_um * 1e-3; }
  double height_mm() const { return rows * pitch_um * 1e-3; }
  double half_diagonal_mm() const;
  /// Image-space coordinates [mm] of the real (inverted) image at a pixel position (centres at
  /// half-integers).
  double x_mm(double column) const { return (columns / 2.0 - column) * pitch_um * 1e-3; }
  double y_mm(double row) const { return (row - rows / 2.0) * pitch_um * 1e-3; }
};

/// A channel of the colour filter array.
struct SensorChannel {
  std::string name = {};
  /// Electrons per photon that falls on the pixel's area (pitch²): the total quantum efficiency η of EMVA
  /// 1288, with filters, fill factor and microlens; 0 to 1.
  Spectrum quantum_efficiency = {};
};

/// One conversion gain of the pixel, of which there may be several (dual conversion gain).
struct GainMode {
  std::string name = {};
  double full_well_e = 0;   ///< more electrons than these are lost
  double dn_per_e = 0;      ///< EMVA 1288's system gain K, at analog gain 1
  double read_noise_e = 0;  ///< rms, before the analog gain
  double adc_noise_dn = 0;  ///< rms, after the analog gain, without quantisation
  double max_analog_gain = 1;
};

/// What the pixels lose or gain under light that comes in at an angle.
struct Microlens {
  std::vector<double> angles_deg = {},
                      response = {};  ///< relative response against the angle from the best one
  /// The chief ray angle that the shift of the microlenses is made for, against image height.
  std::vector<double> design_heights_mm = {}, design_angles_deg = {};
};

/// Everything that turns light into numbers.
struct SensorElectronics {
  std::vector<SensorChannel> channels = {};
  Mosaic mosaic = {};
  /// Where the electrons of a pixel end up: share of the neighbour at (row, column) − 1 from the centre.
  std::array<std::array<double, 3>, 3> crosstalk{{{0, 0, 0}, {0, 1, 0}, {0, 0, 0}}};
  std::optional<Microlens> microlens = {};

  std::vector<GainMode> gain_modes = {};
  int bits = 12;
  double black_level_dn = 0, white_level_dn = 4095;
  /// Deviation of the output from proportionality, as a share of the signal, at shares of the full well.
  std::vector<double> linearity_fractions = {}, linearity_deviations = {};

  double dark_current_e_per_s = 0, dark_temperature_c = 20, dark_doubling_c = 8;
  double dsnu_e = 0, prnu = 0;  ///< rms over pixels: of the dark signal [e], of the gain (relative)
  double column_pattern_e = 0;  ///< rms over columns of an offset that stays
  double row_noise_e = 0;       ///< rms over rows of an offset drawn anew in each exposure
  double hot_pixels_per_million = 0, hot_current_e_per_s = 0, dead_pixels_per_million = 0;
  /// Full wells at which charge begins to flow into the next pixels of a column, at least 1: what data sheets
  /// of charge-coupled devices give as blooming suppression; 0: all that does not fit is drained.
  double blooming_onset = 0;
  std::uint64_t serial = 1;  ///< what its fixed patterns grow from
  Shutter shutter = {};      ///< global unless the sensor says otherwise

  std::vector<std::string> channel_names() const;
  /// Electrons per second and pixel at a temperature: doubled every dark_doubling_c.
  double dark_current_at(double temperature_c) const;
  /// The signal [e] at which a pixel stops following: full well, or the white level at this gain.
  double saturation_e(const GainMode& mode, double analog_gain) const;
  /// \throws InputError for a name that is not there; an empty name is the first.
  const GainMode& gain_mode(const std::string& name) const;
};

struct Sensor {
  std::string name = {}, source = {};
  SensorGeometry geometry = {};
  /// Where within a pixel light is gathered, and the optical low-pass filter before it, in pitches. Whoever
  /// makes the irradiance applies them, once. The default is a box of one pitch and no filter.
  Photosite photosite = {};
  /// Share of the light that its surface or cover glass reflects back into the lens; absent: not
  /// known.
  std::optional<double> reflectance = {};
  /// From the middle of a microlens to the corner of its pixel [µm]: what the sensor reflects goes into the
  /// orders of this grating; 0: as from a mirror.
  double microlens_sag_um = 0;
  std::optional<SensorElectronics> electronics = {};  ///< absent: a frame for images, no more

  /// \throws InputError unless the sensor says how it turns light into numbers.
  const SensorElectronics& require_electronics() const;
};

/// Reads a sensor.
///
///     const Sensor sensor = read_sensor("third-inch-1280x960");
///     const Sensor frame = read_sensor("640x480@7.5");  // no electronics: light only
///
/// \param text  "768x576@6.25" (columns x rows @ pitch in µm), a path, or the name of a bundled sensor
/// (JSON, "format": "petzval-sensor/1", strict; docs/SENSOR.md).
/// \throws InputError with file and line, saying what would be right; also for a sensor that contradicts
/// itself.
Sensor read_sensor(const std::string& text);
/// The same with some entries of its file altered: "pitch_um=3", "gain_modes[0].read_noise_e=1.5".
/// \throws InputError as that does, naming the setting.
Sensor read_sensor(const std::string& text, const std::vector<std::string>& settings);

}  // namespace petzval
