// SPDX-License-Identifier: BSD-3-Clause
// How good one lens is, as built: spots or MTF over the whole field, after the sensor has been focused.
#pragma once

#include <petzval/analysis/field_tables.h>

#include <string>
#include <vector>

namespace petzval {

/// What a built lens is judged by.
struct Merit {
  enum class Kind {
    rms_spot,  ///< RMS radius of the spot by its light, all wavelengths together [µm]
    mtf        ///< polychromatic diffraction MTF at one frequency, the mean of both directions
  };
  Kind kind = Kind::rms_spot;
  double frequency_cpmm = 0;

  bool more_is_better() const { return kind == Kind::mtf; }
  std::string name() const;  ///< "RMS spot", "MTF at 40/mm"
  const char* unit() const { return kind == Kind::rms_spot ? "um" : ""; }
};

/// A place in the field.
struct FieldPoint {
  double field = 0;        ///< as FieldTableRequest has it
  double azimuth_deg = 0;  ///< anticlockwise from +y as seen from the film
};

/// How a lens is judged.
struct JudgeRequest {
  /// Fields and wavelengths; empty: the lens's own. Its azimuth does not count.
  FieldTableRequest at = {};
  /// Azimuths at which every field but the axis is looked at.
  std::vector<double> azimuths_deg = {0, 90, 180, 270};
  Merit merit = {};
  bool refocus = true;  ///< the sensor moves along the axis to the smallest spots of all points together
};

struct Judgement {
  std::vector<double> at_points;  ///< in the order of points_of()
  double overall = 0;             ///< root mean square of spots, mean of MTF
  double worst = 0;               ///< of all points
  double refocus_mm = 0;          ///< away from the lens
};

/// Axis first if it is a field, then field after field, azimuth after azimuth. \throws InputError for a
/// request without fields or azimuths, or one that is not finite.
std::vector<FieldPoint> points_of(const Lens& lens, const JudgeRequest& request);

/// The rays are a quadrature over the real vignetted pupil of every point, 8 × 48 rays. \throws InputError
/// naming a point at which no ray passes, and as mtf_table().
Judgement judge(const Lens& lens, const JudgeRequest& request);

}  // namespace petzval
