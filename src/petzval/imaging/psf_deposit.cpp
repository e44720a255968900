// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/axis_deposit.h>
#include <petzval/imaging/psf_deposit.h>
#include <petzval/imaging/sample_scatter.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace petzval {

namespace {

using Vector = std::array<double, 2>;  ///< picture column, row [cells]

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
  const int radius = kernel.radius, size = kernel.size(), side = size + 2;
  // With one cell more all around, whose light then goes to the rim.
  std::vector<double> wide(static_cast<std::size_t>(side * side));
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) {
      const double share = shares.at(i, j);
      if (share == 0) continue;
      for (int row = 0; row < size; ++row) {
        const double* from = kernel.weights.data() + row * size;
        double* to = wide.data() + (row + 1 + i) * side + 1 + j;
        for (int column = 0; column < size; ++column) to[column] += share * from[column];
      }
    }
  Kernel result(radius);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      result.at(std::clamp(row - 1 - radius, -radius, radius),
                std::clamp(column - 1 - radius, -radius, radius)) +=
          wide[static_cast<std::size_t>(row * side + column)];
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
  for (int row = -radius; row <= radius; ++row) {
    double light = 0, first = 0, second = 0;
    for (int column = -radius; column <= radius; ++column) {
      const double weight = at(row, column);
      light += weight;
      first += column * weight;
      second += column * column * weight;
    }
    total += light;
    sums.mean[0] += first;
    sums.mean[1] += row * light;
    sums.uu += second;
    sums.uv += row * first;
    sums.vv += row * row * light;
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
  samples_.resize(size * size);
  std::vector<double> sums(size);
  for (std::size_t i = 0; i < samples; ++i) {
    const float* values = psf.values.data() + i * samples;
    float* row = samples_.data() + (i + skipped) / step * size;
    if (merged == 1) {
      std::copy_n(values, samples, row);
      continue;
    }
    std::size_t block = skipped / step, left = step - skipped % step;
    for (std::size_t j = 0; j < samples; ++j) {
      sums[block] += double(values[j]);
      if (--left == 0) {
        ++block;
        left = step;
      }
    }
    if ((i + skipped) % step + 1 == step || i + 1 == samples) {
      std::transform(sums.begin(), sums.end(), row, [](double sum) { return static_cast<float>(sum); });
      std::fill(sums.begin(), sums.end(), 0.0);
    }
  }
  find_light();
}

MergedPsf::MergedPsf(const Kernel& fine, double spacing_um)
    : size_(fine.size()), spacing_um_(spacing_um), origin_um_(0), first_um_(-fine.radius * spacing_um) {
  light_.sum = fine.sum();
  // Rows run along t, columns along −s.
  for (int row = -fine.radius; row <= fine.radius; ++row)
    for (int column = fine.radius; column >= -fine.radius; --column)
      samples_.push_back(static_cast<float>(fine.at(row, column)));
  find_light();
}

void MergedPsf::find_light() {
  const auto size = static_cast<std::size_t>(size_);
  for (std::size_t i = 0; i < size; ++i) {
    const std::span<const float> samples(row(i), size);
    const auto has_light = [](float value) { return value != 0; };
    const auto first = std::find_if(samples.begin(), samples.end(), has_light);
    const auto last = std::find_if(samples.rbegin(), samples.rend(), has_light);
    const bool dark = first == samples.end();
    lit_.push_back(dark ? LitSamples{}
                        : LitSamples{static_cast<std::size_t>(first - samples.begin()),
                                     static_cast<std::size_t>(samples.rend() - last)});
  }
}

namespace {

const MergedPsf& largest(std::span<const WeightedPsf> psfs) {
  return *std::max_element(psfs.begin(), psfs.end(), [](const WeightedPsf& a, const WeightedPsf& b) {
            return a.psf->size() < b.psf->size();
          })->psf;
}

/// How the lattice of a PSF, stretched, lies on cells. The origin of the PSF is that of the places.
PlacedLattice lattice_on_cells(const MergedPsf& psf, const Placement& placement, const Vector& centre_um,
                               const Vector& direction, double cell_um) {
  // Picture columns run along −x', rows along +y'; e_t = direction, e_s = (direction_y, −direction_x).
  const Vector e_s{-direction[1], -direction[0]}, e_t{-direction[0], direction[1]};
  const Vector& stretch = placement.stretch;
  const double spacing = psf.spacing_um() / cell_um;
  const double s_first = psf.first_um(), t_first = s_first - psf.origin_um();
  const double s = (centre_um[0] + stretch[0] * (s_first - centre_um[0])) / cell_um;
  const double t = (centre_um[1] + stretch[1] * (t_first - centre_um[1])) / cell_um;
  const auto along = [](double length, const Vector& e) { return Vector{length * e[0], length * e[1]}; };
  return {{s * e_s[0] + t * e_t[0], s * e_s[1] + t * e_t[1]},
          along(spacing * stretch[1], e_t),
          along(spacing * stretch[0], e_s)};
}

/// \param lattice  that of the largest, from the middle of the kernel.
void scatter(std::span<const WeightedPsf> psfs, const PlacedLattice& lattice, Kernel& kernel) {
  // Blobs wider than a cell are cut into parts that are not; into as many at any angle, lest kernels jump
  // where one more is needed.
  const auto length = [](const Vector& step) { return std::hypot(step[0], step[1]); };
  const double longest = std::max(length(lattice.per_row), length(lattice.per_column));
  const int parts = std::max(1, static_cast<int>(std::ceil(2 * blob_radius(longest) - 1e-9)));
  std::vector<SampleSquare> squares;
  for (const WeightedPsf& part : psfs)
    squares.push_back(part.psf->square(part.weight / (double(parts) * parts)));
  const int radius = kernel.radius;
  Canvas canvas(2 * radius + 4);
  for (int a = 0; a < parts; ++a)
    for (int b = 0; b < parts; ++b) {
      const double i = (a + 0.5) / parts - 0.5, j = (b + 0.5) / parts - 0.5;
      PlacedLattice moved = lattice;
      for (std::size_t axis = 0; axis < 2; ++axis)
        moved.first[axis] += radius + 1.5 + i * lattice.per_row[axis] + j * lattice.per_column[axis];
      scatter_samples(squares, moved, canvas);
    }
  for (int row = -radius; row <= radius; ++row)
    for (int column = -radius; column <= radius; ++column)
      kernel.at(row, column) += canvas.sum(row + radius + 1, column + radius + 1);
}

}  // namespace

void deposit(const MergedPsf& psf, const Placement& placement, const std::array<double, 2>& direction,
             double cell_um, Kernel& kernel) {
  const Moments& moments = psf.moments();
  const Vector centre_um{moments.mean[0] / psf.sum(), moments.mean[1] / psf.sum()};
  const PlacedLattice lattice = lattice_on_cells(psf, placement, centre_um, direction, cell_um);
  const SampleSquare square = psf.square(placement.weight);
  if (direction[0] == 0)
    deposit_along_axes(square, lattice, kernel);
  else
    scatter(std::array{WeightedPsf{&psf, placement.weight}}, lattice, kernel);
}

void deposit(std::span<const WeightedPsf> psfs, const std::array<double, 2>& direction, double cell_um,
             Kernel& kernel) {
  while (!psfs.empty()) {
    const MergedPsf& first = *psfs[0].psf;
    const auto other = std::find_if(psfs.begin(), psfs.end(), [&](const WeightedPsf& part) {
      return part.psf->spacing_um() != first.spacing_um();
    });
    const auto alike = psfs.first(static_cast<std::size_t>(other - psfs.begin()));
    scatter(alike, lattice_on_cells(largest(alike), {}, {0, 0}, direction, cell_um), kernel);
    psfs = psfs.subspan(alike.size());
  }
}

}  // namespace petzval
