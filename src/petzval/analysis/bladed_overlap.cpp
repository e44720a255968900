// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/bladed_overlap.h>
#include <petzval/numeric/root.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Panels across the chords, of so many nodes each: a kink inside a panel costs the square of its width.
constexpr int panel_nodes = 8;

struct Chord {
  double low = 0, high = 0;
  double length() const { return high - low; }
};

/// A convex outline cut by lines along one of the two directions.
class Chords {
 public:
  /// \param along  index of the coordinate along the chords.
  Chords(const std::vector<std::array<double, 2>>& outline, std::size_t along)
      : outline_(outline), along_(along), across_(1 - along) {
    low_ = high_ = outline.front()[across_];
    for (const auto& point : outline) {
      low_ = std::min(low_, point[across_]);
      high_ = std::max(high_, point[across_]);
    }
  }

  Chord at(double across) const {
    Chord chord{1e300, -1e300};
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const auto &a = outline_[i], &b = outline_[(i + 1) % outline_.size()];
      if ((a[across_] <= across) == (b[across_] <= across)) continue;
      const double share = (across - a[across_]) / (b[across_] - a[across_]);
      const double where = a[along_] + share * (b[along_] - a[along_]);
      chord = {std::min(chord.low, where), std::max(chord.high, where)};
    }
    return chord.low <= chord.high ? chord : Chord{};
  }

  /// Across which the chords are longer than s: an interval, for lengths of a convex outline are concave.
  Chord longer_than(double s) const {
    double best = low_, longest = 0;
    constexpr int steps = 256;
    for (int i = 1; i < steps; ++i) {
      const double here = low_ + (high_ - low_) * i / steps;
      if (const double length = at(here).length(); length > longest) {
        best = here;
        longest = length;
      }
    }
    if (longest <= s) return {};
    const auto spare = [&](double across) { return at(across).length() - s; };
    return {last_above_zero(best, low_, spare), last_above_zero(best, high_, spare)};
  }

 private:
  const std::vector<std::array<double, 2>>& outline_;
  std::size_t along_, across_;
  double low_ = 0, high_ = 0;
};

}  // namespace

std::complex<double> bladed_overlap(const std::vector<std::array<double, 2>>& outline,
                                    const OverlapAlong& along, MtfDirection direction, double shift,
                                    const QuadratureRule& rule, int panels) {
  const Chords chords(outline, direction == MtfDirection::tangential ? 1 : 0);
  const Chord range = chords.longer_than(shift);
  std::complex<double> sum = 0;
  const double width = range.length() / panels;
  for (int panel = 0; panel < panels && width > 0; ++panel) {
    const QuadratureRule across =
        gauss_legendre(panel_nodes, range.low + panel * width, range.low + (panel + 1) * width);
    for (std::size_t i = 0; i < across.nodes.size(); ++i) {
      const Chord chord = chords.at(across.nodes[i]);
      const double length = chord.length() - shift;
      if (length > 0)
        sum +=
            across.weights[i] * along(direction, {across.nodes[i], chord.low + shift, length, shift}, rule);
    }
  }
  return sum;
}

}  // namespace petzval
