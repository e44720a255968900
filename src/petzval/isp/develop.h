// SPDX-License-Identifier: BSD-3-Clause
// From a raw image to a picture.
#pragma once

#include <petzval/isp/colour_rendering.h>
#include <petzval/isp/filters.h>
#include <petzval/isp/linear_mosaic.h>
#include <petzval/sensor/raw_image.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

struct DevelopOptions {
  const RawImage* flat = nullptr;  ///< of a uniform surface, for the shading; must outlive the call
  bool defects = true;
  /// Response to white; empty: the image's own, or without one as if the scene were grey on average.
  std::vector<double> neutral = {};
  bool grey_world = false;
  std::optional<std::string> demosaic = {};  ///< a demosaic_method(); absent: the usual one of the mosaic
  std::optional<CameraMatrix> matrix = {};   ///< absent: from the image's calibrations
  bool colours = true;                       ///< false: channels 0, 1, 2 are shown as red, green, blue
  double denoise_strength = 0, sharpen_amount = 0, sharpen_sigma_px = 1;
  double exposure_ev = 0;
  /// In place of exposure_ev: so much that the brightest hundredth of the picture comes to be white.
  bool automatic_exposure = false;
  ToneCurve tone = ToneCurve::none;
  DisplaySpace space = DisplaySpace::srgb;
};

/// What was done.
struct DevelopReport {
  std::vector<double> neutral = {};
  double temperature_k = 0;  ///< of the light; 0: not known
  int defects = 0;
  double exposure_ev = 0;
  std::string demosaic = {};
};

/// Told of each step with what it made; the planes of a mosaic are one.
using DevelopStep = std::function<void(const std::string& name, const Planes& planes)>;

/// Black level and linearity → defects → shading → denoising → white balance → demosaic → colour matrix →
/// sharpening → exposure and tone: linear light of the display, 0 to 1 and beyond. Names of the steps:
/// "linear", "defects", "shading", "denoise", "white-balance", "demosaic", "colour", "sharpen", "tone".
/// \throws InputError for options that do not fit the image.
Planes develop_planes(const RawImage& raw, const DevelopOptions& options = {},
                      DevelopReport* report = nullptr, const DevelopStep& step = {});

/// The names above in order.
const std::vector<std::string>& develop_step_names();

}  // namespace petzval
