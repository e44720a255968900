// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/wave/pupil_strips.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

using Complex = std::complex<double>;

/// Zeros of f within (0, 1), between samples, by bisection.
template <typename Function>
void add_roots(std::vector<double>& roots, const Function& f) {
  constexpr int samples = 10, halvings = 45;
  double before_t = 0, before = f(0.0);
  for (int i = 1; i <= samples; ++i) {
    const double t = static_cast<double>(i) / samples, value = f(t);
    if ((before < 0) != (value < 0)) {
      double a = before_t, b = t;
      for (int h = 0; h < halvings; ++h) {
        const double m = 0.5 * (a + b);
        ((f(m) < 0) == (before < 0) ? a : b) = m;
      }
      roots.push_back(0.5 * (a + b));
    }
    before_t = t, before = value;
  }
}

}  // namespace

const QuadratureRule& RuleShelf::for_turns(double turns, int least) {
  const double half_range = pi * turns;
  const int n = least + static_cast<int>(std::ceil(0.5 * half_range + 2.2 * std::cbrt(half_range)));
  const auto found = rules_.find(n);
  return found != rules_.end() ? found->second : rules_.emplace(n, gauss_legendre(n)).first->second;
}

PupilPolynomial::PupilPolynomial(int degree, const std::function<double(double x, double y)>& w)
    : count_(static_cast<std::size_t>(degree) + 1), coefficients_(count_ * count_) {
  const double n = static_cast<double>(count_);
  std::vector<double> place, values;
  for (std::size_t i = 0; i < count_; ++i) place.push_back(std::cos(pi * (static_cast<double>(i) + 0.5) / n));
  for (std::size_t i = 0; i < count_; ++i)
    for (std::size_t j = 0; j < count_; ++j) values.push_back(w(place[i], place[j]));
  const auto basis = [&](std::size_t k, std::size_t i) {
    return (k == 0 ? 1 : 2) / n * std::cos(pi * static_cast<double>(k) * (static_cast<double>(i) + 0.5) / n);
  };
  // One axis after the other.
  std::vector<double> half(count_ * count_);
  for (std::size_t k = 0; k < count_; ++k)
    for (std::size_t j = 0; j < count_; ++j)
      for (std::size_t i = 0; i < count_; ++i) half[k * count_ + j] += basis(k, i) * values[i * count_ + j];
  for (std::size_t k = 0; k < count_; ++k)
    for (std::size_t l = 0; l < count_; ++l)
      for (std::size_t j = 0; j < count_; ++j)
        coefficients_[k * count_ + l] += half[k * count_ + j] * basis(l, j);
}

void PupilPolynomial::row(double y, std::vector<double>& in_x) const {
  in_x.resize(count_);
  for (std::size_t k = 0; k < count_; ++k) {
    double next = 0, after = 0;
    for (std::size_t l = count_; l-- > 1;) {
      const double here = 2 * y * next - after + coefficients_[k * count_ + l];
      after = next;
      next = here;
    }
    in_x[k] = y * next - after + coefficients_[k * count_];
  }
}

double PupilPolynomial::sum(const std::vector<double>& in_x, double x) {
  double next = 0, after = 0;
  for (std::size_t k = in_x.size(); k-- > 1;) {
    const double here = 2 * x * next - after + in_x[k];
    after = next;
    next = here;
  }
  return x * next - after + in_x[0];
}

PupilStrips::PupilStrips(const ApertureShape& shape, double angle_rad, PupilPolynomial w, double steepest,
                         double most_curved)
    : obstruction_(shape.obstruction),
      steepest_(steepest),
      most_curved_(most_curved),
      w_(std::move(w)),
      pieces_(outline_of(shape, angle_rad)) {
  std::vector<double> heights;
  for (const OutlinePiece& piece : pieces_) heights.insert(heights.end(), {piece.low, piece.high});
  for (const double y : {-obstruction_, obstruction_})
    if (obstruction_ > 0) heights.push_back(y);
  std::sort(heights.begin(), heights.end());
  for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
    Band band{heights[i], heights[i + 1], nullptr, nullptr, false};
    // Corners at the same height up to rounding make no band of their own.
    if (band.high - band.low < 1e-13) continue;
    const double middle = 0.5 * (band.low + band.high);
    for (const OutlinePiece& piece : pieces_)
      if (piece.low < middle && piece.high > middle) (piece.is_right ? band.right : band.left) = &piece;
    if (!band.left || !band.right) continue;
    band.is_even = !band.left->is_arc && !band.right->is_arc && std::abs(middle) >= obstruction_;
    bands_.push_back(band);
  }
}

double PupilStrips::Band::height(double t) const {
  return low + (high - low) * (is_even ? t : 0.5 * (1 - std::cos(pi * t)));
}

double PupilStrips::Band::slope(double t) const {
  return (high - low) * (is_even ? 1 : 0.5 * pi * std::sin(pi * t));
}

PupilStrips::Stretches PupilStrips::stretches(const Band& band, double y, double s) const {
  Stretches result;
  const double from = band.left->at(y) + s, to = band.right->at(y) - s;
  if (!(to > from)) return result;
  const double square = obstruction_ * obstruction_ - y * y;
  if (!(square > 0)) {
    result.ends[result.count++] = {from, to};
    return result;
  }
  const double c = std::sqrt(square);
  double at = from;
  for (const auto& [a, b] : {std::pair{-s - c, -s + c}, {s - c, s + c}}) {
    if (a > at && at < to) result.ends[result.count++] = {at, std::min(a, to)};
    at = std::max(at, b);
  }
  if (at < to) result.ends[result.count++] = {at, to};
  return result;
}

std::vector<double> PupilStrips::breaks(const Band& band, double s) const {
  std::vector<double> ends{0, 1};
  if (s == 0) return ends;
  add_roots(ends, [&](double t) {
    const double y = band.height(t);
    return band.right->at(y) - band.left->at(y) - 2 * s;
  });
  const double e = obstruction_;
  if (std::abs(band.low + band.high) < 2 * e)
    // Where the rims of the two obstructions meet each other and, on either side, the shape's.
    for (const int which : {0, 1, 2, 3, 4})
      add_roots(ends, [&](double t) {
        const double y = band.height(t), c = std::sqrt(std::max(0.0, e * e - y * y));
        if (which == 0) return c - s;
        const double rim = which <= 2 ? band.right->at(y) : -band.left->at(y);
        return rim - 2 * s + (which % 2 == 0 ? c : -c);
      });
  std::sort(ends.begin(), ends.end());
  return ends;
}

Complex PupilStrips::overlap(double s, RuleShelf& rules) const {
  constexpr int least = 7, least_curved = 12;
  const double turns_each = w_.is_zero() ? 0 : std::min(2 * steepest_, 2 * s * most_curved_);
  std::vector<double> in_x;
  Complex sum = 0;
  for (const Band& band : bands_) {
    const std::vector<double> ends = breaks(band, s);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const double from_t = ends[i], span = ends[i + 1] - from_t;
      if (span < 1e-14 || stretches(band, band.height(from_t + 0.5 * span), s).count == 0) continue;
      const double rise = band.height(ends[i + 1]) - band.height(from_t);
      const QuadratureRule& across = rules.for_turns(
          turns_each * rise, (band.is_even ? least : least_curved) + static_cast<int>(6 * rise));
      for (std::size_t j = 0; j < across.nodes.size(); ++j) {
        const double t = from_t + span * across.nodes[j], y = band.height(t);
        const double weight = across.weights[j] * span * band.slope(t);
        if (!w_.is_zero()) w_.row(y, in_x);
        const Stretches parts = stretches(band, y, s);
        for (std::size_t p = 0; p < parts.count; ++p) {
          const auto [from, to] = parts.ends[p];
          const double length = to - from;
          if (w_.is_zero()) {
            sum += weight * length;
            continue;
          }
          const QuadratureRule& along = rules.for_turns(turns_each * length, least);
          for (std::size_t k = 0; k < along.nodes.size(); ++k) {
            const double x = from + length * along.nodes[k];
            const double phase =
                2 * pi * (PupilPolynomial::sum(in_x, x + s) - PupilPolynomial::sum(in_x, x - s));
            sum += weight * length * along.weights[k] * Complex(std::cos(phase), std::sin(phase));
          }
        }
      }
    }
  }
  return sum;
}

Complex PupilStrips::amplitude(double r, RuleShelf& rules) const {
  constexpr int least_across = 20, least_along = 14;
  const double turns_across = w_.is_zero() ? 0 : steepest_, turns_along = turns_across + 0.5 * std::abs(r);
  std::vector<double> in_x;
  Complex sum = 0;
  for (const Band& band : bands_) {
    // The ends of strips move with the height, and with them the phase of the plane wave.
    const QuadratureRule& across =
        rules.for_turns((turns_across + std::abs(r)) * (band.high - band.low), least_across);
    for (std::size_t j = 0; j < across.nodes.size(); ++j) {
      const double y = band.height(across.nodes[j]);
      const double weight = across.weights[j] * band.slope(across.nodes[j]);
      if (!w_.is_zero()) w_.row(y, in_x);
      const Stretches parts = stretches(band, y, 0);
      for (std::size_t p = 0; p < parts.count; ++p) {
        const auto [from, to] = parts.ends[p];
        const double length = to - from;
        const QuadratureRule& along = rules.for_turns(turns_along * length, least_along);
        for (std::size_t k = 0; k < along.nodes.size(); ++k) {
          const double x = from + length * along.nodes[k];
          const double w = w_.is_zero() ? 0 : PupilPolynomial::sum(in_x, x);
          sum += weight * length * along.weights[k] * std::polar(1.0, -2 * pi * w - pi * r * x);
        }
      }
    }
  }
  return sum;
}

double PupilStrips::largest_shift() const {
  // The width of a convex shape is concave in the height: its greatest value lies within one band; by the
  // golden section.
  double widest = 0;
  for (const Band& band : bands_) {
    const auto width = [&](double y) { return band.right->at(y) - band.left->at(y); };
    double a = band.low, b = band.high;
    constexpr double share = 0.6180339887498949;
    constexpr int rounds = 60;
    for (int i = 0; i < rounds; ++i) {
      const double c = b - share * (b - a), d = a + share * (b - a);
      if (width(c) < width(d))
        a = c;
      else
        b = d;
    }
    widest = std::max({widest, width(0.5 * (a + b)), width(band.low), width(band.high)});
  }
  return 0.5 * widest;
}

}  // namespace petzval
