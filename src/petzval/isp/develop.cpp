// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/isp/develop.h>
#include <petzval/isp/mosaic_denoise.h>

#include <algorithm>
#include <utility>

namespace petzval {

namespace {

double range(const RawImage& raw) {
  return raw.white_level - raw.black_level;
}

/// Variance of a linear value x is scale · x + offset.
double noise_scale(const RawImage& raw) {
  return raw.noise_slope() / range(raw);
}
double noise_offset(const RawImage& raw) {
  const double step = 1 / range(raw);
  return step * step * (raw.noise_offset() + 1.0 / 12);
}

std::vector<double> neutral_for(const RawImage& raw, const LinearMosaic& mosaic,
                                const DevelopOptions& options) {
  if (raw.channels.size() == 1) return {1};
  if (options.grey_world) return grey_world_neutral(mosaic);
  if (!options.neutral.empty()) return options.neutral;
  return raw.as_shot_neutral.empty() ? grey_world_neutral(mosaic) : raw.as_shot_neutral;
}

/// Channels as they are, red, green and blue if there are so many.
Planes as_they_are(const Planes& planes) {
  const std::size_t last = planes.values.size() - 1;
  return {planes.columns,
          planes.rows,
          {planes.values[0], planes.values[std::min<std::size_t>(1, last)],
           planes.values[std::min<std::size_t>(2, last)]}};
}

}  // namespace

const std::vector<std::string>& develop_step_names() {
  static const std::vector<std::string> names = {"linear",   "defects", "shading", "denoise", "white-balance",
                                                 "demosaic", "colour",  "sharpen", "tone"};
  return names;
}

Planes develop_planes(const RawImage& raw, const DevelopOptions& options, DevelopReport* report,
                      const DevelopStep& step) {
  DevelopReport done;
  const auto tell_mosaic = [&](const char* name, const LinearMosaic& mosaic) {
    if (step) step(name, {mosaic.columns, mosaic.rows, {mosaic.values}});
  };
  LinearMosaic mosaic = linearised(raw);
  tell_mosaic("linear", mosaic);
  if (options.defects && raw.dn_per_e > 0)
    done.defects = correct_defects(mosaic, noise_scale(raw), noise_offset(raw), raw.bad_pixels);
  tell_mosaic("defects", mosaic);
  if (options.flat) correct_shading(mosaic, linearised(*options.flat));
  tell_mosaic("shading", mosaic);
  denoise_mosaic(mosaic, options.denoise_strength, noise_scale(raw), noise_offset(raw));
  tell_mosaic("denoise", mosaic);
  done.neutral = neutral_for(raw, mosaic, options);
  balance_white(mosaic, done.neutral);
  tell_mosaic("white-balance", mosaic);

  done.demosaic = options.demosaic.value_or(usual_demosaic_method(mosaic).name);
  Planes planes = demosaiced(mosaic, done.demosaic);
  mosaic = {};
  if (step) step("demosaic", planes);

  if (planes.values.size() == 1) {
    planes = rendered(std::move(planes), {}, options.space);
  } else if (!options.colours) {
    planes = as_they_are(planes);
  } else {
    const CameraMatrix matrix = options.matrix ? *options.matrix : camera_matrix(raw, done.neutral);
    done.temperature_k = matrix.temperature_k;
    planes = rendered(std::move(planes), matrix, options.space);
  }
  if (step) step("colour", planes);
  if (options.sharpen_amount != 0) sharpen(planes, options.sharpen_amount, options.sharpen_sigma_px);
  if (step) step("sharpen", planes);
  done.exposure_ev = options.automatic_exposure ? automatic_exposure_ev(planes) : options.exposure_ev;
  apply_tone(planes, done.exposure_ev, options.tone);
  if (step) step("tone", planes);
  if (report) *report = done;
  return planes;
}

}  // namespace petzval
