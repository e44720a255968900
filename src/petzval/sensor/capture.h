// SPDX-License-Identifier: BSD-3-Clause
// From electrons per second to the numbers of a raw image.
#pragma once

#include <petzval/sensor/photo_current.h>
#include <petzval/sensor/raw_image.h>
#include <petzval/sensor/sensor.h>

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace petzval {

/// What stands between light and numbers; each can be switched off by itself, and the others then stay as
/// they were.
enum class NoiseSource {
  shot,       ///< the Poisson statistics of photo- and dark electrons
  dark,       ///< the dark current
  read,       ///< read noise and noise of the converter
  dsnu,       ///< the fixed pattern of offsets
  prnu,       ///< the fixed pattern of gains
  column,     ///< the fixed offsets of columns
  row,        ///< the offsets of rows, new in each exposure
  defects,    ///< hot and dead pixels
  crosstalk,  ///< electrons that end up in the next pixel
  microlens,  ///< loss at chief ray angles that the microlenses are not made for
  linearity,  ///< the departure from proportionality
  blooming    ///< charge that flows along columns from pixels that are full
};

/// The names above, in order; \throws InputError for another name.
const std::vector<std::string>& noise_source_names();
NoiseSource noise_source(const std::string& name);

struct CaptureOptions {
  std::string gain_mode = {};  ///< of a sensor with several conversion gains; empty: the first
  double analog_gain = 1;
  std::optional<double> temperature_c = {};  ///< absent: the one that the dark current is stated for
  std::uint64_t seed = 1;                    ///< of the noise that is new in each exposure
  std::optional<std::uint64_t> serial = {};  ///< another copy of the sensor, with other fixed patterns
  std::set<NoiseSource> without = {};
  int frames = 1;       ///< exposures that are averaged
  int first_frame = 0;  ///< of those: frames of a clip have noise of their own
  int reading = 0;      ///< of the same electrons: further ones have their own noise of reading and of rows

  bool has(NoiseSource source) const { return !without.contains(source); }
};

/// Exposes the sensor:
///
/// 1. photoelectrons: current × exposure × (1 + PRNU); dark electrons: dark current × exposure, more in hot
/// pixels;
/// 2. their number is Poisson-distributed; on sensors that bloom, what is beyond the onset flows along the
/// column (bloom_column()); above the full well it is cut off;
/// 3. offsets: DSNU, columns, rows; then the departure from linearity; then read noise;
/// 4. the converter: black level + gain × signal, rounded to nearest, cut to 0 … white level. (Model and
/// terms: EMVA
///    Standard 1288, release 4.0, sections 2 and 4.)
///
/// The fixed patterns grow from the sensor's serial number and the place of the pixel, the rest from the
/// seed, the frame and the place. Averaged frames are stored in finer steps (a power of two, as 16 bits
/// allow). Colour calibration and facts of the lens are not filled in. \throws InputError for an analog gain
/// or exposure out of range.
RawImage capture(const PhotoCurrent& current, const Sensor& sensor, double exposure_s,
                 const CaptureOptions& options);

}  // namespace petzval
