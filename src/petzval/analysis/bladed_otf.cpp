// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/bladed_otf.h>
#include <petzval/numeric/quadrature.h>

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
    return {edge(best, low_, s), edge(best, high_, s)};
  }

 private:
  double edge(double inside, double outside, double s) const {
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (inside + outside);
      (at(middle).length() > s ? inside : outside) = middle;
    }
    return inside;
  }

  const std::vector<std::array<double, 2>>& outline_;
  std::size_t along_, across_;
  double low_ = 0, high_ = 0;
};

using Wave = std::function<std::complex<double>(double, double)>;

std::complex<double> overlap(const Chords& chords, const Wave& wave, bool tangential, double shift,
                             int panels, const QuadratureRule& along) {
  const Chord range = chords.longer_than(shift);
  const auto value = [&](double across, double at) {
    return tangential ? wave(across, at) : wave(at, across);
  };
  std::complex<double> sum = 0;
  const double width = range.length() / panels;
  for (int panel = 0; panel < panels && width > 0; ++panel) {
    const QuadratureRule rule =
        gauss_legendre(panel_nodes, range.low + panel * width, range.low + (panel + 1) * width);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double across = rule.nodes[i];
      const Chord chord = chords.at(across);
      const double length = chord.length() - shift;
      if (!(length > 0)) continue;
      std::complex<double> part = 0;
      for (std::size_t k = 0; k < along.nodes.size(); ++k) {
        const double at = chord.low + shift + length * along.nodes[k];
        part += along.weights[k] * value(across, at) * std::conj(value(across, at - shift));
      }
      sum += rule.weights[i] * length * part;
    }
  }
  return sum;
}

}  // namespace

std::complex<double> bladed_otf(const std::vector<std::array<double, 2>>& outline, const Wave& wave,
                                MtfDirection direction, double shift, int nodes, int panels,
                                int whole_nodes) {
  const bool tangential = direction == MtfDirection::tangential;
  const Chords chords(outline, tangential ? 1 : 0);
  const QuadratureRule along = gauss_legendre(nodes);
  return overlap(chords, wave, tangential, shift, panels, along) /
         overlap(chords, wave, tangential, 0, panels, gauss_legendre(whole_nodes)).real();
}

}  // namespace petzval
