// SPDX-License-Identifier: BSD-3-Clause
// Gaussian point-spread functions that are wider along one axis.
#pragma once

#include <petzval/wave/otf.h>

#include <memory>

namespace petzval {

/// Of a Gaussian PSF with standard deviations along the picture's x and y axes.
/// \throws InputError unless both are positive and finite.
std::unique_ptr<Otf> elliptical_gaussian_otf(double sigma_x_um, double sigma_y_um);

}  // namespace petzval
