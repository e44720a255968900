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

/// A way to interpolate: an entry of demosaic_methods(), from which options, help and reports have its name.
struct DemosaicMethod {
  std::string name;
  std::string summary;  ///< one line, with its source
  bool bayer_only;      ///< red, green and blue in a Bayer mosaic alone
  Planes (*interpolate)(const LinearMosaic& mosaic);
};

const std::vector<DemosaicMethod>& demosaic_methods();
/// \throws InputError for another name, with those that there are.
const DemosaicMethod& demosaic_method(const std::string& name);
/// What is taken for a mosaic if nobody says otherwise.
const DemosaicMethod& usual_demosaic_method(const LinearMosaic& mosaic);
/// True for red, green, blue in one of the four orders with green on a diagonal.
bool is_bayer(const LinearMosaic& mosaic);

/// Interpolates every channel at every pixel. Measured values are kept by all methods. Beyond the edges the
/// picture is mirrored. The same bytes for any number of threads. \throws InputError for a method that wants
/// another mosaic.
Planes demosaiced(const LinearMosaic& mosaic, const std::string& method);

}  // namespace petzval
