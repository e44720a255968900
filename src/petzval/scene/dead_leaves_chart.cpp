// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/numeric/random.h>
#include <petzval/scene/charts.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace petzval {

namespace {

struct Leaf {
  Point centre;
  double radius;
  float grey;
};

/// Enough leaves, the topmost last, to cover the frame `layers` times over.
std::vector<Leaf> fallen_leaves(double width, double height, double least, double most, std::uint64_t seed) {
  constexpr double layers = 9;  // what is left bare is e^-9 of the frame
  constexpr double darkest = 0.1, lightest = 0.9;
  constexpr std::uint32_t purpose = 0x6c656166;
  RandomStream random(seed, purpose, 0);
  std::vector<Leaf> leaves;
  const double inverse_least = 1 / (least * least), inverse_most = 1 / (most * most);
  const double area = (width + 2 * most) * (height + 2 * most);
  for (double covered = 0; covered < layers * area;) {
    // Radii have the density r^-3 between the two, which alone looks the same at every scale.
    const double r = 1 / std::sqrt(inverse_least - random.uniform() * (inverse_least - inverse_most));
    const double x = random.uniform() * (width + 2 * most) - most,
                 y = random.uniform() * (height + 2 * most) - most;
    const double grey = darkest + random.uniform() * (lightest - darkest);
    leaves.push_back({{x, y}, r, static_cast<float>(grey)});
    covered += 3.14159265358979323846 * r * r;
  }
  return leaves;
}

/// Which part of a sample a disc covers, its edge taken for straight within the sample: a hundredth of a
/// sample for the smallest leaf.
float covered_part(const Leaf& leaf, double x, double y) {
  return static_cast<float>(
      std::clamp(leaf.radius - std::hypot(x - leaf.centre.x, y - leaf.centre.y) + 0.5, 0.0, 1.0));
}

}  // namespace

Scene dead_leaves_chart(const ChartOptions& options, std::uint64_t seed) {
  const double side = std::min(options.columns, options.rows);
  constexpr double finest = 1.5;
  const double most = std::max(2 * finest, side / 4);
  std::vector<float> grey(static_cast<std::size_t>(options.columns) * static_cast<std::size_t>(options.rows),
                          0.5f);
  for (const Leaf& leaf : fallen_leaves(options.columns, options.rows, finest, most, seed)) {
    const auto within = [](double from, int end) {
      return static_cast<int>(std::clamp(from, 0.0, static_cast<double>(end)));
    };
    const int top = within(leaf.centre.y - leaf.radius - 1, options.rows),
              bottom = within(leaf.centre.y + leaf.radius + 2, options.rows),
              left = within(leaf.centre.x - leaf.radius - 1, options.columns),
              right = within(leaf.centre.x + leaf.radius + 2, options.columns);
    for (int row = top; row < bottom; ++row)
      for (int column = left; column < right; ++column) {
        float& sample = grey[static_cast<std::size_t>(row) * static_cast<std::size_t>(options.columns) +
                             static_cast<std::size_t>(column)];
        sample += covered_part(leaf, column + 0.5, row + 0.5) * (leaf.grey - sample);
      }
  }
  ChartCanvas canvas(options);
  canvas.modulate(canvas.flat_paint(1), [&](int row, std::span<double> factors) {
    for (std::size_t x = 0; x < factors.size(); ++x)
      factors[x] = grey[static_cast<std::size_t>(row) * factors.size() + x];
  });
  return std::move(canvas).lit();
}

}  // namespace petzval
