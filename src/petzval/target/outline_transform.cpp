// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/target/outline_transform.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace petzval {

namespace {

using Complex = std::complex<double>;

/// Nodes on the outlines: places in turns of the period, with step·n_x ds and step·n_y ds.
struct OutlineNodes {
  PointMasses across;                ///< x, y and step·n_x ds
  std::vector<double> down_y, down;  ///< y and step·n_y ds
  double integral = 0;               ///< ∬ S
};

/// Gauss-Legendre rules for a phase of ±half_range over the interval, made once each.
class Rules {
 public:
  const QuadratureRule& for_phase(double half_range) {
    // Short edges, of which curves have many, converge at once.
    const int n = (half_range < 4 ? 6 : 10) +
                  static_cast<int>(std::ceil(0.5 * half_range + 2.5 * std::cbrt(half_range)));
    const auto found = rules_.find(n);
    return found != rules_.end() ? found->second : rules_.emplace(n, gauss_legendre(n)).first->second;
  }

 private:
  std::map<int, QuadratureRule> rules_;
};

class NodeBuilder {
 public:
  NodeBuilder(const Period& period, double cutoff_cpp) : period_(period), cutoff_(cutoff_cpp) {}

  void add(const Contour& contour, double step) {
    nodes_.integral += step * signed_area(contour);
    for (std::size_t i = 0; i < contour.size(); ++i) {
      const Vertex &a = contour[i], &b = contour[(i + 1) % contour.size()];
      const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
      const int pieces = 1 + static_cast<int>(length / longest_piece_px);
      const QuadratureRule& rule = rules_.for_phase(pi * cutoff_ * length / pieces);
      for (int p = 0; p < pieces; ++p)
        for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
          const double t = (p + rule.nodes[j]) / pieces, weight = step * rule.weights[j] / pieces;
          const double x = (a.x + t * dx - period_.origin.x) / period_.columns;
          const double y = (a.y + t * dy - period_.origin.y) / period_.rows;
          if (dy != 0) nodes_.across.add(x, y, weight * dy);
          if (dx != 0) {
            nodes_.down_y.push_back(y);
            nodes_.down.push_back(-weight * dx);
          }
        }
    }
  }
  OutlineNodes take() { return std::move(nodes_); }

 private:
  static constexpr double longest_piece_px = 100;
  Period period_;
  double cutoff_;
  Rules rules_;
  OutlineNodes nodes_;
};

/// F at f_x = 0, l = −l_max … l_max.
std::vector<Complex> middle_column(const OutlineNodes& nodes, int l_max, int rows) {
  const std::vector<Complex> sums = nonuniform_fft(nodes.down_y, nodes.down, l_max);
  std::vector<Complex> column(2 * static_cast<std::size_t>(l_max) + 1);
  const auto middle = static_cast<std::size_t>(l_max);
  column[middle] = nodes.integral;
  for (std::size_t l = 1; l < sums.size(); ++l) {
    const Complex value = Complex(0, 1) * (rows / (2 * pi * static_cast<double>(l))) * sums[l];
    column[middle + l] = value;
    column[middle - l] = std::conj(value);
  }
  return column;
}

}  // namespace

void transform_outlines(const std::vector<Region>& regions, const Period& period, double cutoff_cpp,
                        std::size_t working_bytes,
                        const std::function<void(int, int, std::span<const Complex>)>& visit) {
  const Vertex low = period.origin, high{low.x + period.columns, low.y + period.rows};
  NodeBuilder builder(period, cutoff_cpp);
  for (const Region& region : regions)
    for (const Contour& contour : region.contours) {
      const Contour inside = clip_to_box(contour, low, high);
      if (!inside.empty()) builder.add(inside, region.step);
    }
  const OutlineNodes nodes = builder.take();
  const int k_max = static_cast<int>(std::ceil(cutoff_cpp * period.columns));
  const int l_max = static_cast<int>(std::ceil(cutoff_cpp * period.rows));
  const std::vector<Complex> middle = middle_column(nodes, l_max, period.rows);
  const NonuniformFft2 fft(k_max, l_max);
  fft.transform(nodes.across, period.columns, working_bytes, [&](int k, std::span<const Complex> sums) {
    if (k == 0) return visit(k, l_max, middle);
    const Complex factor = Complex(0, 1) * (period.columns / (2 * pi * k));
    std::vector<Complex> column(sums.begin(), sums.end());
    for (Complex& value : column) value *= factor;
    visit(k, l_max, column);
  });
}

}  // namespace petzval
