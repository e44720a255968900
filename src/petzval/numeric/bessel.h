// SPDX-License-Identifier: BSD-3-Clause
// Bessel functions of the first kind.
#pragma once

namespace petzval {

/// J0(x) and J1(x), to about 1e-15, for any finite x.
double bessel_j0(double x);
double bessel_j1(double x);
/// 2 J1(x)/x, which is 1 at x = 0: the transform of a disc.
double jinc(double x);

}  // namespace petzval
