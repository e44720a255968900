// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/axis_deposit.h>
#include <petzval/imaging/psf_deposit.h>
#include <petzval/imaging/row_convolution.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace petzval {

Kernel::Kernel(int kernel_radius)
    : radius(kernel_radius), weights(static_cast<std::size_t>(size()) * static_cast<std::size_t>(size())) {}

double Kernel::sum() const {
  // Several sums side by side: one alone waits for its last addition.
  std::array<double, 16> sums{};
  std::size_t i = 0;
  for (; i + sums.size() <= weights.size(); i += sums.size())
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += weights[i + k];
  return std::accumulate(weights.begin() + static_cast<std::ptrdiff_t>(i), weights.end(),
                         std::accumulate(sums.begin(), sums.end(), 0.0));
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
  samples_.resize(size * size + row_padding());
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
}

void deposit(const MergedPsf& psf, const Placement& placement, double spacing_um, Kernel& lattice) {
  const Moments& moments = psf.moments();
  const std::array<double, 2> centre_um{moments.mean[0] / psf.sum(), moments.mean[1] / psf.sum()};
  const double turn = placement.across_axis ? -1 : 1;
  // The lattice's columns run along −s, its rows along t.
  const auto line = [&](double first_um, std::size_t axis, double sign) {
    const double stretch = placement.stretch[axis];
    const double first = centre_um[axis] + stretch * (first_um - centre_um[axis]);
    return PlacedLine{sign * turn * first / spacing_um,
                      sign * turn * stretch * psf.spacing_um() / spacing_um};
  };
  deposit_along_axes(psf.samples().data(), static_cast<std::size_t>(psf.size()), placement.weight,
                     line(psf.first_um() - psf.origin_um(), 1, 1), line(psf.first_um(), 0, -1), lattice);
}

}  // namespace petzval
