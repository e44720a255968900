// SPDX-License-Identifier: BSD-3-Clause
// Exact pictures of polygons.
#pragma once

#include <petzval/base/grid.h>
#include <petzval/target/polygon.h>
#include <petzval/wave/otf.h>
#include <petzval/wave/photosite.h>

#include <cstddef>
#include <vector>

namespace petzval {

struct TargetOptions {
  int columns = 0, rows = 0;
  double pitch_um = 0;
  Photosite photosite;
  /// Memory for the largest buffer. Less of it only costs time.
  std::size_t working_bytes = std::size_t{640} << 20;
};

/// Relative irradiance.
using TargetImage = Grid<double>;

/// scene ⊗ PSF ⊗ photosite at every pixel centre, without sampling of the scene: the transform of every
/// polygon by Gauss' theorem along its outline, up to the cut-off of the OTF; times OTF and photosite;
/// aliases folded onto the pixel grid; one inverse transform. The tail of the PSF reaches beyond the frame
/// and the scene beyond the transform's period: FarKernel. Error below 1e-6 of the contrast.
///
/// \throws InputError as validate(TargetScene) and Photosite::validate, for sizes below 1 or above 2^28
/// pixels, or an OTF so wide (cut-off above 64 cycles/pixel) or a blur so large that no period holds it.
TargetImage render_target(const TargetScene& scene, const Otf& otf, const TargetOptions& options);

/// What the whole chain passes at a frequency [cycles/pixel]: OTF times photosite. On an edge with its normal
/// at angle θ from the x axis the true SFR is |transfer(f cos θ, f sin θ)|.
std::complex<double> transfer(const Otf& otf, const TargetOptions& options, double fx_cpp, double fy_cpp);

}  // namespace petzval
