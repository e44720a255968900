// SPDX-License-Identifier: BSD-3-Clause
// Wavefronts as maps over the stop and as sums of Zernike polynomials.
#pragma once

#include <petzval/analysis/field_tables.h>
#include <petzval/wave/zernike.h>

#include <vector>

namespace petzval {

struct WavefrontZernikeRow {
  double field = 0, wavelength_nm = 0;
  double real_image_height_mm = 0;
  std::vector<double> coefficients;  ///< [waves], [0] is that of Z_1
  double rms_residual_waves = 0;     ///< what the terms leave, area-weighted over the stop
};

/// W (wavefront.h) over the stop, whose radius is the unit circle of the polynomials whatever a field's
/// vignetting leaves of it, fitted with the area on the stop as weight. Rows in the order fields ×
/// wavelengths. \throws InputError naming a field at which no ray passes, or as fit_zernike().
std::vector<WavefrontZernikeRow> zernike_table(const Lens& lens, const FieldTableRequest& request,
                                               ZernikeOrder order, int terms);

/// W on a square grid over the stop.
struct WavefrontMap {
  double field = 0, wavelength_nm = 0;
  int size = 0;
  /// [waves], row-major, the first row at y = −1: sample [i][k] is the ray through (x, y) = (2k/(size − 1) −
  /// 1, 2i/(size − 1) − 1) stop radii, NaN where no ray passes.
  std::vector<double> waves;
};

/// Maps of size × size samples. Rows in the order fields × wavelengths. \throws InputError for a size outside
/// 3 to 1025, or naming a field at which no ray passes.
std::vector<WavefrontMap> wavefront_maps(const Lens& lens, const FieldTableRequest& request, int size);

}  // namespace petzval
