// SPDX-License-Identifier: BSD-3-Clause
// What a lens does for a sensor at a distance: the numbers by which lenses are chosen.
#pragma once

#include <petzval/base/context.h>
#include <petzval/lens/first_order.h>
#include <petzval/report/table.h>
#include <petzval/simulate/camera.h>
#include <petzval/simulate/depth_of_field.h>
#include <petzval/simulate/frame_view.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// MTF of all wavelengths together, and light, at a height of the real image. NaN where no light arrives.
struct PlaceOnSensor {
  double real_image_height_mm = 0;
  double half_nyquist_tangential = std::numeric_limits<double>::quiet_NaN();
  double half_nyquist_sagittal = std::numeric_limits<double>::quiet_NaN();
  double nyquist_tangential = std::numeric_limits<double>::quiet_NaN();
  double nyquist_sagittal = std::numeric_limits<double>::quiet_NaN();
  double relative_illumination = 0;
};

struct LensOnSensor {
  std::string lens;
  double scale = 1;                                       ///< of match_lenses(): what the lens was scaled by
  double efl_mm = 0, f_number = 0, working_f_number = 0;  ///< the first two infinite where it is afocal
  double magnification = 0;  ///< paraxial, on the sensor where it stands; 0 at infinity
  FrameView view;            ///< what the sensor sees
  double per_pixel = 0;      ///< in the middle of the object: mm, or degrees at infinity
  double image_circle_mm = 0, sensor_diagonal_mm = 0;  ///< of the lens's own fields; of the sensor
  double nyquist_cpmm = 0;
  /// By geometry: blur of at most one pixel. By MTF: at half of Nyquist in the middle at least 0.8 of that in
  /// focus; absent where there is no such MTF.
  DepthOfField geometric;
  std::optional<DepthOfField> by_mtf;
  double hyperfocal_m = 0;            ///< f²/(N c) + f, c one pixel
  std::vector<PlaceOnSensor> places;  ///< middle, half way, corner
};

/// Two groups of lenses with a common focus, as telecentric lenses are, have next to no power: more than a
/// thousand times their track of focal length.
bool is_afocal(const FirstOrder& data);

/// The camera's lens, with its aperture, before its sensor, and an object at a distance from the sensor plane
/// (absent: at infinity). Its focus, unless it is a distance or sought, is where the mean MTF at half of
/// Nyquist over middle, half way and corner is best. \param wavelengths_nm  alike in weight; empty: the
/// lens's. \throws InputError for a camera without sensor, and as focusing and mtf_table().
LensOnSensor lens_on_sensor(const Camera& camera, std::optional<double> distance_m,
                            const std::vector<double>& wavelengths_nm = {}, const Context& context = {});

/// For people: a row a quantity, a column a lens.
Table lens_on_sensor_table(const std::vector<LensOnSensor>& lenses);

struct LensMatchRequest {
  Sensor sensor;
  double distance_m = 0, width_mm = 0;  ///< of the object, and how much of its width is to be seen
  std::optional<double> f_number = {};
  std::vector<double> wavelengths_nm = {450, 550, 650};
  bool scaled = false;  ///< lenses may be scaled to fit
};

/// The bundled lenses whose fields reach the corners of the sensor, that open as wide as was asked for and
/// see the width to 5 % (any scale: to 0.1 %), the one with the best MTF in the corner first: the lesser of
/// both directions, at half of Nyquist.
std::vector<LensOnSensor> match_lenses(const LensMatchRequest& request, const Context& context = {});

}  // namespace petzval
