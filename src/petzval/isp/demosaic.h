// SPDX-License-Identifier: BSD-3-Clause
// From one channel a pixel to all of them.
#pragma once

#include <petzval/isp/linear_mosaic.h>

#include <string>
#include <vector>

namespace petzval {

/// A picture of full planes: one for each channel.
struct Planes {
  int columns = 0, rows = 0;
  std::vector<std::vector<float>> values;  ///< [channel][row × columns + column]
};

enum class Demosaic {
  bilinear,  ///< mean of the nearest of each channel, weighted by a triangle; any mosaic
  malvar,    ///< Malvar, He & Cutler, ICASSP 2004: bilinear with Laplacian corrections, 5 × 5, linear; Bayer
  gradient,  ///< Pekkucuksen & Altunbasak, ICIP 2010: colour differences, weighted by their gradients in four
             ///< directions; Bayer
  general    ///< bilinear, and the detail of the pixel's own channel handed to the others; any mosaic
};

/// \throws InputError for another name.
Demosaic demosaic_method(const std::string& name);
/// True for red, green, blue in one of the four orders with green on a diagonal.
bool is_bayer(const LinearMosaic& mosaic);

/// Interpolates every channel at every pixel. Measured values are kept by all methods. Beyond the edges the
/// picture is mirrored. The same bytes for any number of threads. \throws InputError for a method that wants
/// another mosaic.
Planes demosaiced(const LinearMosaic& mosaic, Demosaic method);

}  // namespace petzval
