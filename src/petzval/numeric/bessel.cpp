// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/numeric/bessel.h>

#include <boost/math/special_functions/bessel.hpp>

namespace petzval {

double bessel_j0(double x) {
  return boost::math::cyl_bessel_j(0, x);
}

double bessel_j1(double x) {
  return boost::math::cyl_bessel_j(1, x);
}

double jinc(double x) {
  // Below this the second term of the series is smaller than rounding.
  return x * x < 1e-15 ? 1 : 2 * bessel_j1(x) / x;
}

}  // namespace petzval
