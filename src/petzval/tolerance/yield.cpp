// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/tolerance/yield.h>

#include <boost/math/distributions/binomial.hpp>

namespace petzval {

Yield yield_of(std::size_t good, std::size_t all) {
  using Binomial = boost::math::binomial_distribution<double>;
  constexpr double one_side = 0.025;
  const auto n = static_cast<double>(all), k = static_cast<double>(good);
  return {k / n, good == 0 ? 0 : Binomial::find_lower_bound_on_p(n, k, one_side),
          good == all ? 1 : Binomial::find_upper_bound_on_p(n, k, one_side)};
}

}  // namespace petzval
