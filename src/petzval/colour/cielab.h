// SPDX-License-Identifier: BSD-3-Clause
// CIELAB and the differences of colours in it.
#pragma once

#include <petzval/colour/observer.h>

namespace petzval {

/// CIE 1976 L*a*b*.
struct Lab {
  double l = 0, a = 0, b = 0;
};

/// Of a colour under a white on the same scale (CIE 15:2004, 8.2.1). \throws InputError unless all three
/// values of the white are positive.
Lab cielab(Xyz colour, Xyz white);
/// The colour again. \throws InputError as cielab.
Xyz xyz_of(Lab colour, Xyz white);

/// CIE 1976 colour difference ΔE*ab: the distance.
double delta_e_ab(Lab a, Lab b);
/// CIEDE2000 colour difference with k_L = k_C = k_H = 1 (CIE 142-2001; as Sharma, Wu & Dalal, Color Res.
/// Appl. 30 (2005) 21, write it).
double delta_e_2000(Lab a, Lab b);

}  // namespace petzval
