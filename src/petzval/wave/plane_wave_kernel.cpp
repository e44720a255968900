// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/wave/plane_wave_kernel.h>

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/wave/plane_wave_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Nodes a block; a multiple of every vector width. Both matrices of a block fit the second-level cache.
constexpr std::size_t block_nodes = 256;

/// Fills matrix[i·block + j] = start_j · turn_j^i for i < rows as floats: the real parts (times `scale`), and
/// the imaginary ones unless `imaginary` is null.
HWY_ATTR void fill_powers(const double* start_re, const double* start_im, const double* turn_re,
                          const double* turn_im, int rows, double scale, float* real, float* imaginary) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, decltype(d)> f;
  const std::size_t lanes = hn::Lanes(d);
  const auto factor = hn::Set(d, scale);
  for (std::size_t j = 0; j < block_nodes; j += lanes) {
    auto re = hn::LoadU(d, start_re + j), im = hn::LoadU(d, start_im + j);
    const auto tr = hn::LoadU(d, turn_re + j), ti = hn::LoadU(d, turn_im + j);
    for (int i = 0; i < rows; ++i) {
      const std::size_t at = static_cast<std::size_t>(i) * block_nodes + j;
      hn::StoreU(hn::DemoteTo(f, hn::Mul(factor, re)), f, real + at);
      if (imaginary) hn::StoreU(hn::DemoteTo(f, hn::Mul(factor, im)), f, imaginary + at);
      const auto next = hn::Sub(hn::Mul(re, tr), hn::Mul(im, ti));
      im = hn::MulAdd(re, ti, hn::Mul(im, tr));
      re = next;
    }
  }
}

/// field += (rows × block) · (block × columns), 2 × 3 outputs at a time: dot products along the nodes.
HWY_ATTR void multiply_block(const float* row_re, const float* row_im, const float* column, int rows,
                             int columns, double* field_re, double* field_im) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  for (int i = 0; i < rows; i += 2) {
    const float* re0 = row_re + static_cast<std::size_t>(i) * block_nodes;
    const float* im0 = row_im + static_cast<std::size_t>(i) * block_nodes;
    for (int c = 0; c < columns; c += 3) {
      const float* s0 = column + static_cast<std::size_t>(c) * block_nodes;
      auto a00 = hn::Zero(d), a01 = a00, a02 = a00, a10 = a00, a11 = a00, a12 = a00;
      auto b00 = a00, b01 = a00, b02 = a00, b10 = a00, b11 = a00, b12 = a00;
      for (std::size_t j = 0; j < block_nodes; j += lanes) {
        const auto r0 = hn::LoadU(d, re0 + j), r1 = hn::LoadU(d, re0 + block_nodes + j);
        const auto q0 = hn::LoadU(d, im0 + j), q1 = hn::LoadU(d, im0 + block_nodes + j);
        const auto v0 = hn::LoadU(d, s0 + j), v1 = hn::LoadU(d, s0 + block_nodes + j);
        const auto v2 = hn::LoadU(d, s0 + 2 * block_nodes + j);
        a00 = hn::MulAdd(r0, v0, a00);
        a01 = hn::MulAdd(r0, v1, a01);
        a02 = hn::MulAdd(r0, v2, a02);
        a10 = hn::MulAdd(r1, v0, a10);
        a11 = hn::MulAdd(r1, v1, a11);
        a12 = hn::MulAdd(r1, v2, a12);
        b00 = hn::MulAdd(q0, v0, b00);
        b01 = hn::MulAdd(q0, v1, b01);
        b02 = hn::MulAdd(q0, v2, b02);
        b10 = hn::MulAdd(q1, v0, b10);
        b11 = hn::MulAdd(q1, v1, b11);
        b12 = hn::MulAdd(q1, v2, b12);
      }
      const auto add = [&](int row, int col, const auto& re, const auto& im) HWY_ATTR {
        const std::size_t at =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(col);
        field_re[at] += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, re)));
        field_im[at] += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, im)));
      };
      add(i, c, a00, b00);
      add(i, c + 1, a01, b01);
      add(i, c + 2, a02, b02);
      add(i + 1, c, a10, b10);
      add(i + 1, c + 1, a11, b11);
      add(i + 1, c + 2, a12, b12);
    }
  }
}

/// `rows` and `columns` are multiples of 2 and 3; the turns are padded to whole blocks with zero amplitude.
HWY_ATTR void sum_blocks(const WaveTurns& turns, WaveColumns kind, int rows, int columns, double* field_re,
                         double* field_im) {
  const std::size_t row_values = static_cast<std::size_t>(rows) * block_nodes;
  std::vector<float> row_re(row_values), row_im(row_values);
  std::vector<float> column(static_cast<std::size_t>(columns) * block_nodes);
  // Columns of real parts: Re(z) is the cosine, Re(−i z) the sine.
  const bool sines = kind == WaveColumns::sines;
  const std::vector<double> start_re(block_nodes, sines ? 0.0 : 1.0),
      start_im(block_nodes, sines ? -1.0 : 0.0);
  for (std::size_t start = 0; start < turns.start_re.size(); start += block_nodes) {
    fill_powers(&turns.start_re[start], &turns.start_im[start], &turns.row_re[start], &turns.row_im[start],
                rows, 1.0, row_re.data(), row_im.data());
    fill_powers(start_re.data(), start_im.data(), &turns.column_re[start], &turns.column_im[start], columns,
                2.0, column.data(), nullptr);
    multiply_block(row_re.data(), row_im.data(), column.data(), rows, columns, field_re, field_im);
  }
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(sum_blocks);

void WaveTurns::resize(std::size_t count) {
  for (std::vector<double>* column : {&start_re, &start_im, &row_re, &row_im, &column_re, &column_im})
    column->resize(count, 0.0);
}

void sum_wave_turns(const WaveTurns& turns, WaveColumns kind, int rows, int columns,
                    std::vector<double>& field_re, std::vector<double>& field_im) {
  constexpr std::size_t block = 256;  // as block_nodes of every target
  WaveTurns padded = turns;
  padded.resize((turns.start_re.size() + block - 1) / block * block);
  const int padded_rows = (rows + 1) / 2 * 2, padded_columns = (columns + 2) / 3 * 3;
  const std::size_t size = static_cast<std::size_t>(padded_rows) * static_cast<std::size_t>(padded_columns);
  std::vector<double> re(size, 0.0), im(size, 0.0);
  HWY_DYNAMIC_DISPATCH(sum_blocks)(padded, kind, padded_rows, padded_columns, re.data(), im.data());
  const auto wanted = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  field_re.resize(wanted);
  field_im.resize(wanted);
  for (int i = 0; i < rows; ++i) {
    const auto from = static_cast<std::ptrdiff_t>(i) * padded_columns,
               to = static_cast<std::ptrdiff_t>(i) * columns;
    std::copy_n(re.begin() + from, columns, field_re.begin() + to);
    std::copy_n(im.begin() + from, columns, field_im.begin() + to);
  }
}

}  // namespace petzval
#endif
