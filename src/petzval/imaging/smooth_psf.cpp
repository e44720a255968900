// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/imaging/row_convolution.h>
#include <petzval/imaging/smooth_psf.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/imaging/smooth_psf.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef PETZVAL_IMAGING_SMOOTH_PSF_ONCE
#define PETZVAL_IMAGING_SMOOTH_PSF_ONCE
namespace petzval {

/// A B-spline on a lattice, and the row of places on it where it is wanted [lattice steps].
struct SplineRow {
  const float* coefficients;  ///< of the middle of the lattice
  int stride;
  float column, row;            ///< of the first place, from the middle
  float column_step, row_step;  ///< to the next
  float bound;                  ///< of both; places beyond, which fill the last vector, are taken there
};

}  // namespace petzval
#endif

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 16>;
using Integers = hn::RebindToSigned<Floats>;
using Vector = hn::Vec<Floats>;

/// The four cubic B-splines that reach a place at a fraction of a step beyond a knot.
struct Splines {
  Vector of_knot[4];
};

HWY_ATTR HWY_INLINE Splines splines_at(Vector fraction) {
  const Floats f;
  const auto set = [&](float value) { return hn::Set(f, value); };
  const Vector rest = hn::Sub(set(1), fraction), sixth = set(1.0F / 6);
  const auto cubed = [](Vector x) { return hn::Mul(hn::Mul(x, x), x); };
  const auto inner = [&](Vector x) {  // (4 − 6x² + 3x³)/6
    return hn::MulAdd(hn::Mul(x, x), hn::MulSub(set(0.5F), x, set(1)), set(2.0F / 3));
  };
  return {{hn::Mul(cubed(rest), sixth), inner(fraction), inner(rest), hn::Mul(cubed(fraction), sixth)}};
}

/// \param values  room for whole vectors.
HWY_ATTR void take(const SplineRow& places, std::size_t count, float* values) {
  const Floats f;
  const Integers integers;
  const std::size_t lanes = hn::Lanes(f);
  for (std::size_t at = 0; at < count; at += lanes) {
    const Vector k = hn::Add(hn::Iota(f, 0), hn::Set(f, static_cast<float>(at)));
    const auto at_step = [&](float first, float step) {
      const Vector place = hn::MulAdd(k, hn::Set(f, step), hn::Set(f, first));
      return hn::Clamp(place, hn::Set(f, -places.bound), hn::Set(f, places.bound));
    };
    const Vector column = at_step(places.column, places.column_step),
                 row = at_step(places.row, places.row_step);
    const Vector left = hn::Floor(column), above = hn::Floor(row);
    const Splines across = splines_at(hn::Sub(column, left)), down = splines_at(hn::Sub(row, above));
    const auto index = hn::Add(hn::Mul(hn::ConvertTo(integers, above), hn::Set(integers, places.stride)),
                               hn::ConvertTo(integers, left));
    Vector sum = hn::Zero(f);
    for (int i = 0; i < 4; ++i) {
      const float* knots = places.coefficients + (i - 1) * places.stride - 1;
      Vector of_row = hn::Mul(across.of_knot[0], hn::GatherIndex(f, knots, index));
      for (int j = 1; j < 4; ++j)
        of_row = hn::MulAdd(across.of_knot[j], hn::GatherIndex(f, knots + j, index), of_row);
      sum = hn::MulAdd(down.of_knot[i], of_row, sum);
    }
    hn::StoreU(sum, f, values + at);
  }
}

HWY_ATTR std::size_t width() {
  return hn::Lanes(Floats());
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(take);
HWY_EXPORT(width);

namespace {

/// The weights −reach … reach that turn samples into coefficients of a spline which is seen through a
/// Gaussian of a variance, moved by a shift [steps of the lattice].
std::vector<float> window_weights(double variance, double shift, int reach) {
  constexpr int frequencies = 64;  // up to that of half the lattice's
  std::vector<double> weights(2 * static_cast<std::size_t>(reach) + 1);
  for (int k = 0; k < frequencies; ++k) {
    const double frequency = (k + 0.5) / (2 * frequencies), turn = 2 * pi * frequency;
    const double of_spline = (2 + std::cos(turn)) / 3;
    const double passed = std::exp(-turn * turn * variance / 2) / of_spline / frequencies;
    // cos(turn (n − shift)) from one n to the next, by a turn of a complex number.
    std::complex<double> wave = std::polar(passed, turn * (-reach - shift));
    const std::complex<double> step = std::polar(1.0, turn);
    for (double& weight : weights) {
      weight += wave.real();
      wave *= step;
    }
  }
  return {weights.begin(), weights.end()};
}

/// What a window must still do along an axis so that light of a variance has the wanted one and that of the
/// window [cells²].
double remaining_variance(double wanted, double own) {
  constexpr double whole = window_cells * window_cells, least = whole / 4;
  return std::max(least, wanted - own + whole);
}

}  // namespace

double window_transform(double frequency) {
  return std::exp(-2 * std::pow(pi * window_cells * frequency, 2));
}

SmoothPsf::SmoothPsf(const Kernel& samples, double spacing_cells, const Moments& wanted) {
  const Moments own = samples.moments();  // [steps]
  const auto variance = [](double square, double mean) { return square - mean * mean; };
  const double step_squared = spacing_cells * spacing_cells;
  const auto weights = [&](double wanted_square, double own_square, std::size_t axis, int reach,
                           double& square) {
    const double own_variance = step_squared * variance(own_square, own.mean[axis]);
    const double remaining = remaining_variance(variance(wanted_square, wanted.mean[axis]), own_variance);
    square = wanted.mean[axis] * wanted.mean[axis] + own_variance + remaining;
    return window_weights(remaining / step_squared, wanted.mean[axis] / spacing_cells - own.mean[axis],
                          reach);
  };
  constexpr int of_spline = 4;  // steps by which a spline's coefficients reach beyond
  const int reach = static_cast<int>(std::ceil(window_reach / spacing_cells)) + of_spline;
  moments_ = wanted;
  const std::vector<float> across = weights(wanted.uu, own.uu, 0, reach, moments_.uu),
                           down = weights(wanted.vv, own.vv, 1, reach, moments_.vv);
  half_ = samples.radius + reach;
  const auto from = static_cast<std::size_t>(samples.size()), to = static_cast<std::size_t>(2 * half_ + 1);
  const double scale = 1 / samples.sum();
  const std::size_t padding = row_padding();
  // A row of samples with room for the window on either side, then all of them filtered along the rows.
  std::vector<float> row(from + 4 * static_cast<std::size_t>(reach) + padding), rows(from * to + padding);
  for (std::size_t i = 0; i < from; ++i) {
    const double* in = samples.weights.data() + i * from;
    std::transform(in, in + from, row.data() + 2 * reach,
                   [&](double value) { return static_cast<float>(scale * value); });
    const RowTerm term{row.data() + 2 * reach, across.data()};
    convolve_rows({&term, 1}, reach, to, rows.data() + i * to);
  }
  coefficients_.resize(to * to + padding);
  std::vector<RowTerm> terms;
  for (std::size_t i = 0; i < to; ++i) {
    terms.clear();
    for (std::size_t k = 0; k < down.size(); ++k)
      if (i >= k && i - k < from) terms.push_back({rows.data() + (i - k) * to, &down[k]});
    convolve_rows(terms, 0, to, coefficients_.data() + i * to);
  }
  coefficients_.resize(to * to);
}

namespace {

/// Σ weight · coefficients about one middle, with room for the splines at the edge.
struct Mixture {
  int half = 0;
  std::vector<float> coefficients;

  int size() const { return 2 * half + 1; }
  void mix(std::span<const WeightedPsf> psfs) {
    constexpr int room = 3;
    half = 0;
    for (const WeightedPsf& part : psfs) half = std::max(half, part.psf->half() + room);
    coefficients.resize(static_cast<std::size_t>(size()) * static_cast<std::size_t>(size()));
    // Row by row, so that a row stays in the nearest cache until all parts are added.
    for (int row = -half; row <= half; ++row) {
      float* out = coefficients.data() + static_cast<std::ptrdiff_t>(row + half) * size();
      std::fill_n(out, size(), 0.0F);
      for (const WeightedPsf& part : psfs) {
        const int of_part = part.psf->half();
        if (std::abs(row) > of_part) continue;
        const auto weight = static_cast<float>(part.weight);
        const float* in = part.psf->coefficients().data() +
                          static_cast<std::ptrdiff_t>(row + of_part) * (2 * of_part + 1) + of_part;
        for (int j = -of_part; j <= of_part; ++j) out[j + half] += weight * in[j];
      }
    }
  }
};

/// How a place of the wanted light, from its middle, is one of the mixture's: place · scale + shift.
struct Adjustment {
  double scale, shift;

  Adjustment(double wanted_mean, double wanted_square, double own_mean, double own_square) {
    const double wanted_variance = wanted_square - wanted_mean * wanted_mean + window_cells * window_cells;
    scale = std::sqrt((own_square - own_mean * own_mean) / wanted_variance);
    shift = own_mean - scale * wanted_mean;
  }
};

/// The numbers q of a row for which |start + q step| is below a bound.
void narrow(double start, double step, double bound, double& first, double& last) {
  if (std::abs(step) < 1e-12) {
    if (std::abs(start) >= bound) last = first - 1;
    return;
  }
  const double a = (-bound - start) / step, b = (bound - start) / step;
  first = std::max(first, std::min(a, b));
  last = std::min(last, std::max(a, b));
}

}  // namespace

void sample_mixture(std::span<const WeightedPsf> psfs, double spacing_cells, const Moments& wanted,
                    const std::array<double, 2>& direction, Kernel& kernel) {
  thread_local Mixture mixture;
  thread_local std::vector<float> values;
  mixture.mix(psfs);
  Moments own;
  for (const WeightedPsf& part : psfs) {
    const Moments& moments = part.psf->moments();
    for (std::size_t axis = 0; axis < 2; ++axis) own.mean[axis] += part.weight * moments.mean[axis];
    own.uu += part.weight * moments.uu;
    own.vv += part.weight * moments.vv;
  }
  const Adjustment across(wanted.mean[0], wanted.uu, own.mean[0], own.uu),
      down(wanted.mean[1], wanted.vv, own.mean[1], own.vv);
  const auto sample_row = HWY_DYNAMIC_DISPATCH(take);
  const std::size_t lanes = HWY_DYNAMIC_DISPATCH(width)();
  values.resize(static_cast<std::size_t>(kernel.size()) + lanes);
  // Picture columns run along −x', rows along +y'; the lattice's rows along e_t, its columns along −e_s.
  const auto [a, b] = direction;
  const auto steps = [&](double cells) { return cells / spacing_cells; };
  const double column_step = steps(across.scale * b), column_down = steps(across.scale * a),
               row_step = -steps(down.scale * a), row_down = steps(down.scale * b);
  const double column_shift = steps(across.shift), row_shift = steps(down.shift);
  const float* middle =
      mixture.coefficients.data() + static_cast<std::ptrdiff_t>(mixture.half) * (mixture.size() + 1);
  const double bound = mixture.half - 2;
  for (int row = -kernel.radius; row <= kernel.radius; ++row) {
    double first = -kernel.radius, last = kernel.radius;
    const double column_start = row * column_down + column_shift, row_start = row * row_down + row_shift;
    narrow(column_start, column_step, bound, first, last);
    narrow(row_start, row_step, bound, first, last);
    if (!(first <= last)) continue;  // numbers too large for an int among them
    const int from = static_cast<int>(std::ceil(first)), to = static_cast<int>(std::floor(last));
    if (from > to) continue;
    const auto count = static_cast<std::size_t>(to - from + 1);
    const SplineRow places{middle,
                           mixture.size(),
                           static_cast<float>(column_start + from * column_step),
                           static_cast<float>(row_start + from * row_step),
                           static_cast<float>(column_step),
                           static_cast<float>(row_step),
                           static_cast<float>(bound)};
    sample_row(places, count, values.data());
    for (std::size_t i = 0; i < count; ++i) kernel.at(row, from + static_cast<int>(i)) = double(values[i]);
  }
}

}  // namespace petzval
#endif
