// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/wave/cell_light.h>

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/wave/cell_light.cpp"
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

#ifndef PETZVAL_WAVE_CELL_SHARES
#define PETZVAL_WAVE_CELL_SHARES
namespace petzval {
namespace {

/// What one sample gives to one cell.
struct CellShare {
  std::size_t sample, cell;
  float share;
};

/// What a sample gives to the cell beside it, if it is the last of its own: its interval holds
/// f + (f₊ − 2f + f₋)/24, to fourth order in the spacing.
constexpr float to_neighbour = 1.0F / 24;

/// By sample; what would go beyond the ends stays.
std::vector<CellShare> shares_of_samples(std::size_t samples, std::size_t cell) {
  std::vector<CellShare> shares;
  for (std::size_t sample = 0; sample < samples; ++sample) {
    const std::size_t own = sample / cell;
    float kept = 1;
    const auto give = [&](std::size_t to) {
      if (to == own) return;
      shares.push_back({sample, to, to_neighbour});
      kept -= to_neighbour;
    };
    if (cell > 1 && sample > 0) give((sample - 1) / cell);
    if (cell > 1 && sample + 1 < samples) give((sample + 1) / cell);
    shares.push_back({sample, own, kept});
  }
  return shares;
}

/// The same where cell 0 lies about s = 0, so that what is left of it mirrors its right.
std::vector<CellShare> shares_of_columns(std::size_t columns, std::size_t cell) {
  std::vector<CellShare> shares = shares_of_samples(columns, cell);
  if (cell > 1 && cell < columns)
    for (CellShare& share : shares) {
      if (share.sample == 0) share.share -= to_neighbour;
      if (share.sample == cell && share.cell == 0) share.share += to_neighbour;
    }
  return shares;
}

}  // namespace
}  // namespace petzval
#endif

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using LightLanes = hn::CappedTag<float, WaveSamples::margin>;

/// Real and imaginary part of finer samples, Σ weights[j] from[j·stride]; of phase 0 the wave's own.
struct FinerWave {
  hn::Vec<LightLanes> re, im;

  HWY_ATTR HWY_INLINE FinerWave(const FinerSamples& finer, std::size_t phase, const float* from_re,
                                const float* from_im, std::size_t stride) {
    const LightLanes d;
    const auto reach = static_cast<std::size_t>(finer.reach);
    if (phase == 0) {
      const std::size_t own = static_cast<std::size_t>(finer.before()) * stride;
      re = hn::LoadU(d, from_re + own), im = hn::LoadU(d, from_im + own);
      return;
    }
    const float* weight = &finer.weights[(phase - 1) * 2 * reach];
    auto odd_re = hn::Zero(d), odd_im = odd_re;
    re = im = odd_re;
    for (std::size_t j = 0; j < reach; ++j, weight += 2, from_re += 2 * stride, from_im += 2 * stride) {
      const auto even = hn::Set(d, weight[0]), odd = hn::Set(d, weight[1]);
      re = hn::MulAdd(even, hn::LoadU(d, from_re), re);
      im = hn::MulAdd(even, hn::LoadU(d, from_im), im);
      odd_re = hn::MulAdd(odd, hn::LoadU(d, from_re + stride), odd_re);
      odd_im = hn::MulAdd(odd, hn::LoadU(d, from_im + stride), odd_im);
    }
    re = hn::Add(re, odd_re), im = hn::Add(im, odd_im);
  }
};

/// The samples are gathered into the columns of cells, a vector of rows at a time, then these rows are shared
/// out to the rows of cells.
HWY_ATTR void cell_light(const WaveSamples& wave, const CellGrid& grid, double* cells) {
  const LightLanes d;
  const std::size_t lanes = hn::Lanes(d);
  const auto columns = static_cast<std::size_t>(grid.columns), rows = static_cast<std::size_t>(grid.rows);
  const auto cell = static_cast<std::size_t>(grid.cell), cell_columns = columns / cell;
  const auto wave_columns = static_cast<std::size_t>(grid.along_s.needed(grid.columns));
  const auto factor_s = static_cast<std::size_t>(grid.along_s.factor),
             factor_t = static_cast<std::size_t>(grid.along_t.factor);
  const std::vector<CellShare> column_shares = shares_of_columns(columns, cell),
                               row_shares = shares_of_samples(rows, cell);
  std::vector<std::size_t> first_share(rows);
  for (std::size_t i = row_shares.size(); i-- > 0;) first_share[row_shares[i].sample] = i;
  std::vector<float> re(wave_columns * lanes), im(wave_columns * lanes), in_cells(cell_columns * lanes);
  for (std::size_t phase = 0; phase < factor_t; ++phase)
    for (std::size_t q = 0; q * factor_t + phase < rows; q += lanes) {
      for (std::size_t c = 0; c < wave_columns; ++c) {
        const FinerWave u(grid.along_t, phase, wave.re(c) + q, wave.im(c) + q, 1);
        hn::StoreU(u.re, d, &re[c * lanes]);
        hn::StoreU(u.im, d, &im[c * lanes]);
      }
      std::fill(in_cells.begin(), in_cells.end(), 0.0F);
      auto share = column_shares.begin();
      for (std::size_t c = 0; c < columns; ++c) {
        const std::size_t from = c / factor_s * lanes;
        const FinerWave u(grid.along_s, c % factor_s, &re[from], &im[from], lanes);
        const auto light = hn::MulAdd(u.re, u.re, hn::Mul(u.im, u.im));
        for (; share != column_shares.end() && share->sample == c; ++share) {
          float* to = &in_cells[share->cell * lanes];
          hn::StoreU(hn::MulAdd(hn::Set(d, share->share), light, hn::LoadU(d, to)), d, to);
        }
      }
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const std::size_t row = (q + lane) * factor_t + phase;
        if (row >= rows) break;
        for (std::size_t i = first_share[row]; i < row_shares.size() && row_shares[i].sample == row; ++i)
          for (std::size_t j = 0; j < cell_columns; ++j)
            cells[row_shares[i].cell * cell_columns + j] +=
                static_cast<double>(row_shares[i].share * in_cells[j * lanes + lane]);
      }
    }
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(cell_light);

FinerSamples FinerSamples::of_step(double step) {
  constexpr double largest_step = 0.8, precision = 1e-4;
  FinerSamples finer;
  finer.factor = std::max(1, static_cast<int>(largest_step / step));
  if (finer.factor == 1) return finer;
  const double clear = pi * (1 - finer.factor * step), steepness = std::log(2 / precision);
  finer.reach = static_cast<int>(std::ceil(steepness / clear));
  for (int phase = 1; phase < finer.factor; ++phase)
    for (int j = 1 - finer.reach; j <= finer.reach; ++j) {
      const double x = static_cast<double>(phase) / finer.factor - j, share = x / finer.reach;
      const double window =
          std::cosh(clear * finer.reach * std::sqrt(1 - share * share)) / std::cosh(clear * finer.reach);
      finer.weights.push_back(static_cast<float>(std::sin(pi * x) / (pi * x) * window));
    }
  return finer;
}

void sum_cell_light(const WaveSamples& wave, const CellGrid& grid, std::vector<double>& cells) {
  const int cell_columns = grid.columns / grid.cell, cell_rows = grid.rows / grid.cell;
  cells.assign(static_cast<std::size_t>(cell_columns) * static_cast<std::size_t>(cell_rows), 0.0);
  HWY_DYNAMIC_DISPATCH(cell_light)(wave, grid, cells.data());
}

}  // namespace petzval
#endif
