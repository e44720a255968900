// SPDX-License-Identifier: BSD-3-Clause
// Third-order (Seidel) aberrations, surface by surface.
#pragma once

#include <petzval/lens/lens.h>

#include <vector>

namespace petzval {

/// Coefficients of the wavefront aberration [mm]: spherical aberration W040 = S1/8, coma W131 = S2/2,
/// astigmatism W222 = S3/2, field curvature W220 = (S3 + S4)/4 with the Petzval term S4, distortion W311 =
/// S5/2; axial (CL) and lateral (CT) colour between the lens's first and last wavelength, W020 = CL/2 and
/// W111 = CT.
struct SeidelTerms {
  double s1 = 0, s2 = 0, s3 = 0, s4 = 0, s5 = 0, cl = 0, ct = 0;

  SeidelTerms& operator+=(const SeidelTerms& other);
};

struct SeidelSums {
  std::vector<SeidelTerms> surfaces;
  SeidelTerms sum;
  double lagrange_invariant_mm = 0;  ///< H = n (ū y − u ȳ), positive
  double wavelength_nm = 0;          ///< of the paraxial rays: the lens's reference wavelength
  double largest_field = 0;          ///< object field of the chief ray [deg or mm]
};

/// From the paraxial marginal ray to the stop's edge and the chief ray of the largest field in the lens file,
/// rising. Conic constants and r⁴ terms add their part at their surface; the r² term belongs to the
/// curvature; other powers of r are not of third order and have none.
/// Method: Welford, Aberrations of Optical Systems (1986), sections 8.3 (sums), 8.4 (aspheres), 10.2
/// (colour), with S5 in a form without division by A.
/// \throws InputError for a largest field at 90° or beyond, which no paraxial ray has, and as first_order().
SeidelSums seidel_sums(const Lens& lens);

}  // namespace petzval
