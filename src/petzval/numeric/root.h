// SPDX-License-Identifier: BSD-3-Clause
// Zeros of functions of one variable.
#pragma once

#include <functional>

namespace petzval {

/// The x between `inside`, where f is above 0, and `outside` at which f comes down to 0, if it does so but
/// once on the way; else `outside`.
double last_above_zero(double inside, double outside, const std::function<double(double)>& f);

}  // namespace petzval
