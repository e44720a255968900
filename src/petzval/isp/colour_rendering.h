// SPDX-License-Identifier: BSD-3-Clause
// From the channels of a sensor to the primaries of a display.
#pragma once

#include <petzval/colour/display.h>
#include <petzval/isp/demosaic.h>
#include <petzval/sensor/raw_image.h>

#include <string>
#include <vector>

namespace petzval {

enum class DisplaySpace {
  srgb,        ///< IEC 61966-2-1
  display_p3,  ///< SMPTE EG 432-1 primaries, white D65, the transfer curve of sRGB
  rec2100_pq   ///< ITU-R BT.2100: primaries of BT.2020, white D65, perceptual quantisation; 1 is
               ///< hdr_white_cd_m2
};

/// \throws InputError for another name than "srgb", "display-p3" and "rec2100-pq".
DisplaySpace display_space(const std::string& name);
/// Linear light of the display's primaries from XYZ with its white (D65) at Y = 1.
ColourMatrix display_from_xyz(DisplaySpace space);
/// An ICC profile (ICC.1:2010, version 4.2) of the space, its bytes: matrix and curve.
std::string icc_profile(DisplaySpace space);

/// XYZ of the connection space (D50, white at Y = 1) from white-balanced channels, 3 × channels.
struct CameraMatrix {
  std::vector<double> pcs_from_balanced;
  double temperature_k = 0;  ///< of the light that it is for
};

/// From the calibrations of a raw image for its white balance: the correlated colour temperature of the
/// neutral is found by going back and forth between colour matrix and temperature (DNG 1.4, chapter 6), the
/// matrices are interpolated in its inverse. Without forward matrices the inverse of the colour matrix,
/// adapted by Bradford, takes their place. \throws InputError if there is no calibration.
CameraMatrix camera_matrix(const RawImage& raw, const std::vector<double>& neutral);

/// The neutral that light of this colour has. \throws InputError if there is no calibration.
std::vector<double> neutral_of_white(const RawImage& raw, Xyz white);

/// Correlated colour temperature [K] (McCamy, Color Res. Appl. 17 (1992) 142), held to 2000 … 25000.
double correlated_temperature_k(Chromaticity chromaticity);

/// Linear RGB of the display from white-balanced planes: three planes. One channel becomes three equal ones.
Planes rendered(Planes balanced, const CameraMatrix& matrix, DisplaySpace space);

}  // namespace petzval
