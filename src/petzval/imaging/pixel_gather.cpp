// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/pixel_gather.h>
#include <petzval/imaging/row_phases.h>
#include <petzval/imaging/row_sums.h>
#include <petzval/imaging/smooth_psf.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace petzval {

namespace {

/// Pixels from a pixel's middle to the last cells that share in it.
constexpr double pixels_reached = 3;
/// Cells beyond a pixel's edge, at least: where a cell is a pixel, fewer could not give back what its light
/// lost.
constexpr int fewest_cells_reached = 4;

/// Frequencies of a kernel's samples that look like another, in units of the cells' own.
constexpr std::array<int, 4> aliases{-2, -1, 1, 2};

/// The weights along one axis that are the best for an aperture, from the middle outwards.
class AxisWeights {
 public:
  AxisWeights(int cells, int size, const LightPath& path) : cells_(cells), size_(size) {
    const int count = static_cast<int>(most_cycles_a_cell * cells / step_cpp);
    const auto unknowns = static_cast<Eigen::Index>(half());
    normal_ = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::VectorXd row(unknowns);
    for (int i = 0; i < count; ++i) {
      const double f = (i + 0.5) * step_cpp, source = path.source.transform(f / cells);
      for (Eigen::Index k = 0; k < unknowns; ++k) row[k] = wave(k, f);
      const double of_edges = 1 / (f * f + longest_cpp * longest_cpp);
      const auto through = [&](double at) { return source * nominal_mtf(at) * path.of_window(at / cells); };
      double squares = 0;
      for (const int alias : aliases)
        if (path.window) squares += std::pow(through(f - alias * cells), 2);
      normal_ += of_edges * (squares + std::pow(through(f), 2)) * row * row.transpose();
      frequencies_.push_back(f);
      rows_.push_back(of_edges * through(f) * nominal_mtf(f) * row);
    }
  }

  /// \param aperture  its transform over frequency [cycles/pixel], real. \param tiles  whether it fills the
  /// pixel: then every cell gives all its light to pixels.
  template <typename Aperture>
  std::vector<double> best(const Aperture& aperture, bool tiles) const {
    const auto unknowns = static_cast<Eigen::Index>(half());
    Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
    for (std::size_t i = 0; i < frequencies_.size(); ++i) right += aperture(frequencies_[i]) * rows_[i];
    // Lagrange multipliers for what must hold exactly.
    const Eigen::Index laws = tiles ? (cells_ + 1) / 2 : 1;
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(unknowns + laws, unknowns + laws);
    Eigen::VectorXd all = Eigen::VectorXd::Zero(unknowns + laws);
    system.topLeftCorner(unknowns, unknowns) = normal_;
    all.head(unknowns) = right;
    for (Eigen::Index law = 0; law < laws; ++law) {
      for (Eigen::Index k = 0; k < unknowns; ++k)
        system(unknowns + law, k) = system(k, unknowns + law) = wave(k, double(law));
      if (law == 0) all[unknowns] = aperture(0.0);
    }
    const Eigen::VectorXd found = system.completeOrthogonalDecomposition().solve(all);
    std::vector<double> weights(static_cast<std::size_t>(size_));
    for (int k = 0; k < half(); ++k)
      weights[static_cast<std::size_t>(size_ / 2 + k)] =
          weights[static_cast<std::size_t>((size_ - 1) / 2 - k)] = found[k];
    return weights;
  }

 private:
  static constexpr double most_cycles_a_cell = 3, step_cpp = 0.02, longest_cpp = 0.03;
  static double nominal_mtf(double f_cpp) { return std::exp(-std::abs(f_cpp)); }
  int half() const { return (size_ + 1) / 2; }
  /// What the k-th weight and its mirror image pass.
  double wave(Eigen::Index k, double f_cpp) const {
    const bool middle = size_ % 2 != 0 && k == 0;
    const double place = (double(k) + (size_ % 2 != 0 ? 0.0 : 0.5)) / cells_;
    return (middle ? 1 : 2) * std::cos(2 * pi * f_cpp * place);
  }

  int cells_, size_;
  Eigen::MatrixXd normal_;
  std::vector<double> frequencies_;
  std::vector<Eigen::VectorXd> rows_;
};

/// A part of a photosite that is a product of what it passes along either axis.
struct Strip {
  double share = 1;        ///< of the area
  double width, height;    ///< of its rectangles [pitches]
  double from_middle = 0;  ///< of two rectangles, one above and one below the middle
};

std::vector<Strip> strips_of(const Photosite& site) {
  if (site.shape == Photosite::Shape::rectangle) return {{1, site.width, site.height}};
  constexpr int count = 8;
  std::vector<Strip> strips;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const double low = double(i) / count, high = double(i + 1) / count;
    const auto area = [](double v) { return (v * std::sqrt(1 - v * v) + std::asin(v)) / 2; };
    const double share = area(high) - area(low);
    const double height = site.height / (2 * count);
    strips.push_back({share, site.width * share * count, height, (i + 0.5) * height});
    sum += share;
  }
  for (Strip& strip : strips) strip.share /= sum;
  return strips;
}

/// PixelTaps::Term as cells are weighed.
struct FloatTerm {
  std::vector<float> down, across;
};

double sum_of_waves(const std::vector<double>& weights, double f_cpp, int cells) {
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    sum += weights[i] * std::cos(2 * pi * f_cpp * (double(i) + 0.5 - double(weights.size()) / 2) / cells);
  return sum;
}

}  // namespace

double LightPath::of_window(double frequency) const {
  return window ? window_transform(frequency) : 1;
}

double PixelTaps::transform(double fx_cpp, double fy_cpp) const {
  double sum = 0;
  for (const Term& term : terms)
    sum += sum_of_waves(term.across, fx_cpp, cells) * sum_of_waves(term.down, fy_cpp, cells);
  return sum;
}

void check_photosite(const Photosite& site) {
  if ((site.shape != Photosite::Shape::rectangle && site.shape != Photosite::Shape::ellipse) ||
      !(site.width <= 1 && site.height <= 1))
    throw InputError(
        fmt::format("a photosite {}: a rectangle or ellipse within the pixel is right", site.text()));
  site.validate();
}

int taps_reach(const Photosite& site, int cells, bool exact) {
  if (exact && site.is_plain()) return 0;
  const double apart = std::max(std::abs(site.separation_x), std::abs(site.separation_y)) / 2;
  return std::max(fewest_cells_reached, static_cast<int>((pixels_reached - 0.5 + apart) * cells));
}

PixelTaps pixel_taps(const Photosite& site, int cells, const LightPath& path) {
  check_photosite(site);
  PixelTaps taps;
  taps.cells = cells;
  taps.reach = taps_reach(site, cells, path.is_exact());
  if (taps.reach == 0) {
    const std::vector<double> even(static_cast<std::size_t>(cells), 1.0 / cells);
    taps.terms = {{even, even}};
    return taps;
  }
  const AxisWeights axis(cells, taps.size(), path);
  taps.terms.clear();
  for (const Strip& strip : strips_of(site)) {
    const auto across = [&](double f) {
      return sinc(strip.width * f) * std::cos(pi * site.separation_x * f);
    };
    const auto down = [&](double f) {
      return strip.share * sinc(strip.height * f) * std::cos(2 * pi * strip.from_middle * f) *
             std::cos(pi * site.separation_y * f);
    };
    taps.terms.push_back({axis.best(down, site.height == 1 && site.shape == Photosite::Shape::rectangle),
                          axis.best(across, site.width == 1 && site.shape == Photosite::Shape::rectangle)});
  }
  return taps;
}

CellPlane gathered(CellPlane plane, const PixelTaps& taps, RowRange wanted) {
  if (taps.size() == 1) return plane;  // of whose dark rows nothing came
  const SensorGeometry inner = grown(plane.grid, -taps.reach);
  CellPlane result =
      CellPlane::unset({inner.columns / taps.cells, inner.rows / taps.cells, inner.pitch_um * taps.cells});
  const auto step = static_cast<std::size_t>(taps.cells);
  std::vector<FloatTerm> terms;
  for (const PixelTaps::Term& term : taps.terms)
    terms.push_back({{term.down.begin(), term.down.end()}, {term.across.begin(), term.across.end()}});
  constexpr std::size_t rows_at_once = 8;
  parallel_for((result.rows() + rows_at_once - 1) / rows_at_once, [&](std::size_t block) {
    std::vector<float> column_sums(plane.columns()), phases;
    const std::size_t end = std::min(result.rows(), (block + 1) * rows_at_once);
    for (std::size_t row = block * rows_at_once; row < end; ++row) {
      const std::span<float> pixels(result.row(row), result.columns());
      std::ranges::fill(pixels, 0.0F);
      if (!wanted.holds(static_cast<int>(row))) continue;
      for (const FloatTerm& term : terms) {
        sum_down(plane.row(row * step), plane.columns(), term.down, column_sums);
        sort_out_phases(column_sums, step, phases);
        add_along(phases, step, term.across, pixels);
      }
    }
  });
  return result;
}

}  // namespace petzval
