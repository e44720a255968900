// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/psf_deposit.h>
#include <petzval/numeric/fft.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace petzval {

namespace {

using Vector = std::array<double, 2>;  ///< picture column, row [cells]

/// The cells of a kernel with one more all around, so that a sample on the rim needs no test, and one for
/// rounding. What begins in a cell is kept in its four parts until the end: here, right, below, right below.
struct Canvas {
  int width;
  AlignedVector<double> parts;
  explicit Canvas(int radius) : width(2 * radius + 4), parts(static_cast<std::size_t>(4 * width * width)) {}
  double* cell(int row, int column) { return parts.data() + 4 * (row * width + column); }
  double sum(int row, int column) {
    return cell(row, column)[0] + cell(row, column - 1)[1] + cell(row - 1, column)[2] +
           cell(row - 1, column - 1)[3];
  }
};

/// The shadow of a sample on one axis of cells of side 1. Between samples light is linear: each is a pyramid
/// over twice the spacing, turned with the lattice; its shadow is that of two boxes of one side and two of
/// the other, one after the other, and no longer than a cell.
class Shadow {
 public:
  explicit Shadow(const Vector& sides)
      : inside_(1 - 2 * (sides[0] + sides[1])), entries_per_length_(entries / (1 - inside_)) {
    double here = 0;
    for (int i = 0; i < entries; ++i) {
      const double next = share_within(double(i + 1) / entries_per_length_, sides);
      pieces_[static_cast<std::size_t>(i)] = {here, next - here};
      here = next;
    }
    pieces_[entries] = {here, 0};
  }

  /// The share of a shadow that reaches beyond the cell in which it begins, `at` of the cell from its start.
  double beyond(double at) const {
    const double over = std::max(0.0, (at - inside_) * entries_per_length_);
    const int i = static_cast<int>(over);
    const Piece& piece = pieces_[static_cast<std::size_t>(i)];
    return piece.value + (over - i) * piece.rise;
  }

 private:
  struct Piece {
    double value, rise;
  };
  static constexpr int entries = 64;  // evenly over the shadow, so that mirrored ones have mirrored shares
  /// The share within `length` of one end: the integral of a spline with knots i·a + j·b.
  static double share_within(double length, const Vector& sides) {
    const double a = std::max(sides[0], sides[1]), b = std::min(sides[0], sides[1]);
    constexpr std::array<double, 3> binomial{1, -2, 1};
    const bool two_boxes = b < 1e-4 * a;
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < (two_boxes ? 1 : 3); ++j) {
        const double left = std::max(0.0, length - double(i) * a - double(j) * b), square = left * left;
        sum += binomial[i] * binomial[j] * (two_boxes ? square : square * square);
      }
    return two_boxes ? sum / (2 * a * a) : sum / (24 * a * a * b * b);
  }

  double inside_;  ///< as far as a shadow may begin and lie within the cell
  double entries_per_length_;
  std::array<Piece, entries + 1> pieces_{};  ///< one more for rounding
};

/// How samples lie on the cells.
struct Lattice {
  Vector first;                ///< where the shadows of the first sample begin
  Vector per_row, per_column;  ///< from sample to sample
};

/// The samples of a row whose shadow begins within [0, end) on both axes.
std::array<std::size_t, 2> samples_inside(const Vector& first, const Vector& step, double end,
                                          std::size_t count) {
  double from = 0, to = double(count);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (step[axis] == 0) {
      if (!(first[axis] >= 0 && first[axis] < end)) return {0, 0};
      continue;
    }
    const double at_zero = -first[axis] / step[axis], at_end = (end - first[axis]) / step[axis];
    from = std::max(from, std::min(at_zero, at_end));
    to = std::min(to, std::max(at_zero, at_end));
  }
  if (!(from < to)) return {0, 0};
  return {static_cast<std::size_t>(std::ceil(from)), static_cast<std::size_t>(std::ceil(to))};
}

/// Of PSFs of one spacing about one origin, by their weights: the samples [from, to) of a row of the largest.
void mix_row(std::span<const WeightedPsf> psfs, std::size_t size, std::size_t row, std::size_t from,
             std::size_t to, std::vector<double>& values) {
  std::fill(values.begin() + std::ptrdiff_t(from), values.begin() + std::ptrdiff_t(to), 0.0);
  for (const WeightedPsf& part : psfs) {
    const auto part_size = static_cast<std::size_t>(part.psf->size());
    const std::size_t before = (size - part_size) / 2;
    if (row < before || row >= before + part_size) continue;
    const double *samples = part.psf->row(row - before), weight = part.weight;
    const std::size_t end = std::min(to, before + part_size);
    for (std::size_t j = std::max(from, before); j < end; ++j) values[j] += weight * samples[j - before];
  }
}

const MergedPsf& largest(std::span<const WeightedPsf> psfs) {
  return *std::max_element(psfs.begin(), psfs.end(), [](const WeightedPsf& a, const WeightedPsf& b) {
            return a.psf->size() < b.psf->size();
          })->psf;
}

/// Adds all samples, each with shadows of 1/parts of its own.
void add_samples(std::span<const WeightedPsf> psfs, double share, int parts, const Lattice& lattice,
                 Canvas& canvas) {
  // Named for the lambda below: clang 14 does not let it see the parts of a structured binding.
  const Vector &first = lattice.first, &per_row = lattice.per_row, &per_column = lattice.per_column;
  const auto shadow = [&](std::size_t axis) {
    return Shadow({std::abs(per_row[axis]) / parts, std::abs(per_column[axis]) / parts});
  };
  const Shadow across = shadow(0), down = shadow(1);
  const auto size = static_cast<std::size_t>(largest(psfs).size());
  std::vector<double> values(size);
  const double end = canvas.width - 2;  // a shadow that begins before it may reach one cell on
  for (std::size_t i = 0; i < size; ++i) {
    const Vector start{first[0] + double(i) * per_row[0], first[1] + double(i) * per_row[1]};
    const auto [from, to] = samples_inside(start, per_column, end, size);
    mix_row(psfs, size, i, from, std::max(from, to), values);
    for (std::size_t j = from; j < to; ++j) {
      const double u = start[0] + double(j) * per_column[0], v = start[1] + double(j) * per_column[1];
      const int column = static_cast<int>(u), row = static_cast<int>(v);
      const double value = share * values[j];
      const double right = across.beyond(u - column), below = down.beyond(v - row);
      const double lower = value * below, upper = value - lower;
      double* cell = canvas.cell(row, column);
      cell[0] += upper - upper * right;
      cell[1] += upper * right;
      cell[2] += lower - lower * right;
      cell[3] += lower * right;
    }
  }
}

/// What every weight of a kernel keeps and hands to the cells about it.
struct Shares {
  double mean_u, mean_v, uu, uv, vv;

  double at(int row, int column) const {
    const double diagonal = std::abs(uv);
    if (row != 0 && column != 0) return (row == column) == (uv > 0) ? diagonal / 2 : 0;
    if (column != 0) return (uu - diagonal + column * mean_u) / 2;
    if (row != 0) return (vv - diagonal + row * mean_v) / 2;
    return 1 - uu - vv + diagonal;
  }
};

/// Handing on shares of mean d and second moments q adds d to the mean m, and 2md + q to the second moments.
Shares shares_towards(const Moments& own, const Moments& wanted) {
  Shares shares{};
  shares.mean_u = wanted.mean[0] - own.mean[0];
  shares.mean_v = wanted.mean[1] - own.mean[1];
  shares.uv = wanted.uv - own.uv - own.mean[0] * shares.mean_v - own.mean[1] * shares.mean_u;
  shares.uu = wanted.uu - own.uu - 2 * own.mean[0] * shares.mean_u;
  shares.vv = wanted.vv - own.vv - 2 * own.mean[1] * shares.mean_v;
  return shares;
}

/// The shares nearest to those wanted that are not negative: the mean as it is, the spread as near as may be.
Shares without_negative(Shares shares) {
  const double shift = std::abs(shares.mean_u) + std::abs(shares.mean_v);
  const double most_uv = std::max(0.0, 1 - shift);  // more than all cannot be handed on
  shares.uv = std::clamp(shares.uv, -most_uv, most_uv);
  const double least_uu = std::abs(shares.uv) + std::abs(shares.mean_u);
  const double least_vv = std::abs(shares.uv) + std::abs(shares.mean_v);
  const double more_u = std::max(0.0, shares.uu - least_uu), more_v = std::max(0.0, shares.vv - least_vv);
  const double room = most_uv - std::abs(shares.uv);
  const double part = more_u + more_v > room ? room / (more_u + more_v) : 1;
  shares.uu = least_uu + part * more_u;
  shares.vv = least_vv + part * more_v;
  return shares;
}

/// Every weight hands shares to the eight about it; at the rim it keeps them.
Kernel handed_on(const Kernel& kernel, const Shares& shares) {
  const int radius = kernel.radius;
  Kernel result(radius);
  std::array<double, 9> share{};
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) share[static_cast<std::size_t>(3 * i + j + 4)] = shares.at(i, j);
  for (int row = -radius; row <= radius; ++row)
    for (int column = -radius; column <= radius; ++column) {
      const double weight = kernel.at(row, column);
      if (weight == 0) continue;
      for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
          result.at(std::clamp(row + i, -radius, radius), std::clamp(column + j, -radius, radius)) +=
              weight * share[static_cast<std::size_t>(3 * i + j + 4)];
    }
  return result;
}

}  // namespace

Kernel::Kernel(int kernel_radius)
    : radius(kernel_radius), weights(static_cast<std::size_t>(size()) * static_cast<std::size_t>(size())) {}

double Kernel::sum() const {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

Moments Kernel::moments() const {
  Moments sums;
  double total = 0;
  for (int row = -radius; row <= radius; ++row)
    for (int column = -radius; column <= radius; ++column) {
      const double weight = at(row, column);
      total += weight;
      sums.mean[0] += column * weight;
      sums.mean[1] += row * weight;
      sums.uu += column * column * weight;
      sums.uv += column * row * weight;
      sums.vv += row * row * weight;
    }
  return {{sums.mean[0] / total, sums.mean[1] / total}, sums.uu / total, sums.uv / total, sums.vv / total};
}

void Kernel::match(const Moments& wanted) {
  constexpr double deepest = 0.05;  // of the highest weight without lobes
  const Shares shares = shares_towards(moments(), wanted);
  const Kernel exact = handed_on(*this, shares);
  const double lowest = *std::min_element(exact.weights.begin(), exact.weights.end());
  // A weight keeps a ninth of itself or more, or a neighbour gets as much: no need to look closer then.
  if (lowest >= -deepest / 9 * *std::max_element(weights.begin(), weights.end())) {
    weights = exact.weights;
    return;
  }
  // As far towards the exact one as lobes allow.
  const Kernel level = handed_on(*this, without_negative(shares));
  const double floor = -deepest * *std::max_element(level.weights.begin(), level.weights.end());
  double part = 1;
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (exact.weights[i] < floor)
      part = std::min(part, (level.weights[i] - floor) / (level.weights[i] - exact.weights[i]));
  part = std::max(0.0, part);  // where level itself has lobes, of fields that lie beyond
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] = part * exact.weights[i] + (1 - part) * level.weights[i];
}

LightMoments light_moments(const Psf& psf, double origin_um) {
  LightMoments light;
  const auto size = static_cast<std::size_t>(psf.size);
  const double of_square = psf.spacing_um * psf.spacing_um / 12;
  for (std::size_t i = 0; i < size; ++i) {
    double sum = 0, first = 0, second = 0;  // of the row, over columns from the middle
    for (std::size_t j = 0; j < size; ++j) {
      const double value = double(psf.values[i * size + j]), s = double(j) - double(size / 2);
      sum += value;
      first += value * s;
      second += value * (s * s);
    }
    first *= psf.spacing_um;
    second *= psf.spacing_um * psf.spacing_um;
    const double t_um = (double(i) - double(size / 2)) * psf.spacing_um - origin_um;
    light.sum += sum;
    light.sums.mean[0] += first;
    light.sums.mean[1] += sum * t_um;
    light.sums.uu += second + sum * of_square;
    light.sums.uv += first * t_um;
    light.sums.vv += sum * (t_um * t_um + of_square);
  }
  return light;
}

MergedPsf::MergedPsf(const Psf& psf, double origin_um, int merged, const LightMoments& light)
    : spacing_um_(merged * psf.spacing_um), origin_um_(origin_um), light_(light) {
  // The middle sample is in the middle of its block, so that a mirrored PSF has mirrored blocks.
  const int middle = psf.size / 2, before = (middle + merged / 2) / merged,
            shift = before * merged + merged / 2 - middle;
  size_ = (psf.size - 1 + shift) / merged + 1;
  first_um_ = -before * spacing_um_;
  const auto size = static_cast<std::size_t>(size_), step = static_cast<std::size_t>(merged);
  const auto samples = static_cast<std::size_t>(psf.size), skipped = static_cast<std::size_t>(shift);
  samples_.assign(size * size, 0.0);
  for (std::size_t i = 0; i < samples; ++i) {
    double* row = samples_.data() + (i + skipped) / step * size;
    const float* values = psf.values.data() + i * samples;
    if (merged == 1) {
      for (std::size_t j = 0; j < samples; ++j) row[j] = double(values[j]);
      continue;
    }
    std::size_t block = skipped / step, left = step - skipped % step;
    for (std::size_t j = 0; j < samples; ++j) {
      row[block] += double(values[j]);
      if (--left == 0) {
        ++block;
        left = step;
      }
    }
  }
}

MergedPsf::MergedPsf(const Kernel& fine, double spacing_um)
    : size_(fine.size()), spacing_um_(spacing_um), origin_um_(0), first_um_(-fine.radius * spacing_um) {
  light_.sum = fine.sum();
  // Rows run along t, columns along −s.
  for (int row = -fine.radius; row <= fine.radius; ++row)
    for (int column = fine.radius; column >= -fine.radius; --column) samples_.push_back(fine.at(row, column));
}

namespace {

/// \param psfs  of one spacing about one origin, of odd sizes where these differ. \param stretch  of the
/// lattice about {s, t} = `centre` [µm]. \param any_angle  whether the kernels of other directions must go on
/// from this one without a jump.
void deposit_mixture(std::span<const WeightedPsf> psfs, const Vector& stretch, const Vector& centre,
                     const Vector& direction, double cell_um, bool any_angle, Kernel& kernel) {
  // Picture columns run along −x', rows along +y'; e_t = direction, e_s = (direction_y, −direction_x).
  const Vector e_s{-direction[1], -direction[0]}, e_t{-direction[0], direction[1]};
  const MergedPsf& whole = largest(psfs);
  const double spacing = whole.spacing_um() / cell_um;
  const double s_first = whole.first_um(), t_first = s_first - whole.origin_um();
  const double s = (centre[0] + stretch[0] * (s_first - centre[0])) / cell_um;
  const double t = (centre[1] + stretch[1] * (t_first - centre[1])) / cell_um;
  const Vector per_row{spacing * stretch[1] * e_t[0], spacing * stretch[1] * e_t[1]};
  const Vector per_column{spacing * stretch[0] * e_s[0], spacing * stretch[0] * e_s[1]};

  // Samples with shadows longer than a cell are cut into parts with shorter ones; into as many at any angle,
  // lest kernels jump where one more is needed.
  const double longest =
      2 * (any_angle ? std::numbers::sqrt2 : 1) * spacing * std::max(stretch[0], stretch[1]);
  const int parts = std::max(1, static_cast<int>(std::ceil(longest - 1e-9)));
  const Vector shadow{2 * (std::abs(per_row[0]) + std::abs(per_column[0])),
                      2 * (std::abs(per_row[1]) + std::abs(per_column[1]))};
  const double share = 1 / (double(parts) * parts), middle = kernel.radius + 1.5;
  Canvas canvas(kernel.radius);
  for (int a = 0; a < parts; ++a)
    for (int b = 0; b < parts; ++b) {
      const double i = (a + 0.5) / parts - 0.5, j = (b + 0.5) / parts - 0.5;
      const auto corner = [&](std::size_t axis) {
        return middle + s * e_s[axis] + t * e_t[axis] + i * per_row[axis] + j * per_column[axis] -
               shadow[axis] / (2 * parts);
      };
      add_samples(psfs, share, parts, {{corner(0), corner(1)}, per_row, per_column}, canvas);
    }

  const int radius = kernel.radius;
  for (int row = -radius; row <= radius; ++row)
    for (int column = -radius; column <= radius; ++column)
      kernel.at(row, column) += canvas.sum(row + radius + 1, column + radius + 1);
}

}  // namespace

void deposit(const MergedPsf& psf, const Placement& placement, const std::array<double, 2>& direction,
             double cell_um, Kernel& kernel) {
  const Moments& moments = psf.moments();
  const std::array<WeightedPsf, 1> alone{{{&psf, placement.weight}}};
  deposit_mixture(alone, placement.stretch, {moments.mean[0] / psf.sum(), moments.mean[1] / psf.sum()},
                  direction, cell_um, direction[0] != 0 && direction[1] != 0, kernel);
}

void deposit(std::span<const WeightedPsf> psfs, const std::array<double, 2>& direction, double cell_um,
             Kernel& kernel) {
  while (!psfs.empty()) {
    const MergedPsf& first = *psfs[0].psf;
    const auto other = std::find_if(psfs.begin(), psfs.end(), [&](const WeightedPsf& part) {
      return part.psf->spacing_um() != first.spacing_um();
    });
    const auto alike = static_cast<std::size_t>(other - psfs.begin());
    deposit_mixture(psfs.first(alike), {1, 1}, {0, 0}, direction, cell_um, true, kernel);
    psfs = psfs.subspan(alike);
  }
}

}  // namespace petzval
