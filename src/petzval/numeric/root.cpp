// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/numeric/root.h>

#include <cmath>
#include <utility>

namespace petzval {

double last_above_zero(double inside, double outside, const std::function<double(double)>& f) {
  double above = f(inside), below = f(outside);
  if (below > 0) return outside;
  // The Illinois method, now and then a half: f may fall off a step.
  constexpr int most_steps = 100;
  constexpr double close = 1e-14;
  const double enough = close * above, near = close * std::abs(outside - inside);
  int side = 0;
  for (int step = 0; step < most_steps && std::abs(outside - inside) > near; ++step) {
    const double share = step % 4 == 3 ? 0.5 : above / (above - below);
    const double at = inside + share * (outside - inside), here = f(at);
    if (std::abs(here) <= enough) return at;
    if (here > 0) {
      inside = at, above = here;
      if (std::exchange(side, 1) == 1) below *= 0.5;
    } else {
      outside = at, below = here;
      if (std::exchange(side, -1) == -1) above *= 0.5;
    }
  }
  return inside;
}

}  // namespace petzval
