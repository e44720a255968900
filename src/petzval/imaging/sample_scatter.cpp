// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/sample_scatter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/imaging/sample_scatter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, 16>;
using Integers = hn::Rebind<std::int32_t, Lanes>;
using Vector = hn::Vec<Lanes>;

/// Rows far from one another are worked on in turn: neighbours of a row mostly meet in one cell, and one
/// addition to it must be through before the next.
constexpr std::size_t strands = 8;
constexpr std::size_t most_lanes = 16;

HWY_ATTR HWY_INLINE void add_scaled_row(const float* row, float weight, std::size_t count, float* sums) {
  const Lanes d;
  const std::size_t lanes = hn::Lanes(d);
  const Vector factor = hn::Set(d, weight);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes)
    hn::StoreU(hn::MulAdd(factor, hn::LoadU(d, row + i), hn::LoadU(d, sums + i)), d, sums + i);
  for (; i < count; ++i) sums[i] += weight * row[i];
}

/// The samples of a row, padded to full vectors. \param size  of the largest square.
HWY_ATTR HWY_INLINE void mix_row(std::span<const SampleSquare> squares, std::size_t size, std::size_t row,
                                 std::size_t padded, float* values) {
  std::fill_n(values, padded, 0.0F);
  for (const SampleSquare& square : squares) {
    const std::size_t before = (size - square.size) / 2;
    if (row < before || row >= before + square.size) continue;
    add_scaled_row(square.samples + (row - before) * square.size, square.weight, square.size,
                   values + before);
  }
}

/// Where blobs go: their cells, and what these and their neighbours get.
struct Blobs {
  alignas(64) std::array<float, 4 * most_lanes> parts;
  alignas(64) std::array<std::int32_t, most_lanes> cell;
};

/// What does not change from row to row.
struct Geometry {
  float column_step[2];
  float inverse_radius[2];
  float end;  ///< blobs half a cell before it reach no farther than the last cell
  std::int32_t width;
};

/// The share of a blob that lies in the second of the two cells that it may reach. \param at  half a cell
/// before its middle. \param cell  the first of the two, in which that lies.
HWY_ATTR HWY_INLINE Vector share_beyond(Vector at, Vector cell, Vector inverse_radius) {
  const Lanes d;
  // From the border between the two to the middle of the blob [radii].
  const Vector x = hn::Mul(hn::Sub(hn::Sub(at, cell), hn::Set(d, 0.5F)), inverse_radius);
  const Vector t = hn::Max(hn::Min(x, hn::Set(d, 1.0F)), hn::Set(d, -1.0F));
  const Vector square = hn::Mul(t, t);
  const Vector slope = hn::MulAdd(hn::MulAdd(square, hn::Set(d, 0.1875F), hn::Set(d, -0.625F)), square,
                                  hn::Set(d, 0.9375F));
  return hn::MulAdd(t, slope, hn::Set(d, 0.5F));
}

/// \param start  half a cell before the first sample of the row.
HWY_ATTR HWY_INLINE void make_blobs(const Geometry& geometry, const float* start, std::size_t from,
                                    const float* values, Blobs& blobs) {
  const Lanes d;
  const Integers i;
  const Vector j = hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<float>(from)));
  Vector u = hn::MulAdd(j, hn::Set(d, geometry.column_step[0]), hn::Set(d, start[0]));
  Vector v = hn::MulAdd(j, hn::Set(d, geometry.column_step[1]), hn::Set(d, start[1]));
  const Vector zero = hn::Zero(d), end = hn::Set(d, geometry.end);
  const auto inside =
      hn::And(hn::And(hn::Ge(u, zero), hn::Lt(u, end)), hn::And(hn::Ge(v, zero), hn::Lt(v, end)));
  const Vector value = hn::IfThenElseZero(inside, hn::Load(d, values + from));
  u = hn::IfThenElseZero(inside, u);
  v = hn::IfThenElseZero(inside, v);
  const auto column = hn::ConvertTo(i, u), row = hn::ConvertTo(i, v);
  const Vector right = share_beyond(u, hn::ConvertTo(d, column), hn::Set(d, geometry.inverse_radius[0]));
  const Vector below = share_beyond(v, hn::ConvertTo(d, row), hn::Set(d, geometry.inverse_radius[1]));
  const Vector lower = hn::Mul(value, below), upper = hn::Sub(value, lower);
  const Vector upper_right = hn::Mul(upper, right), lower_right = hn::Mul(lower, right);
  hn::StoreInterleaved4(hn::Sub(upper, upper_right), upper_right, hn::Sub(lower, lower_right), lower_right, d,
                        blobs.parts.data());
  const auto cell = hn::Add(hn::Mul(row, hn::Set(i, geometry.width)), column);
  hn::Store(hn::ShiftLeft<2>(cell), i, blobs.cell.data());
}

HWY_ATTR HWY_INLINE void add_four(const float* parts, float* cell) {
  const hn::CappedTag<float, 4> d;  // one lane where there are no vectors
  for (std::size_t i = 0; i < 4; i += hn::Lanes(d))
    hn::Store(hn::Add(hn::Load(d, cell + i), hn::Load(d, parts + i)), d, cell + i);
}

HWY_ATTR void scatter(std::span<const SampleSquare> squares, const SampleLattice2& lattice, Canvas& canvas) {
  const std::size_t lanes = hn::Lanes(Lanes());
  std::size_t size = 0;
  for (const SampleSquare& square : squares) size = std::max(size, square.size);
  const std::size_t padded = (size + lanes - 1) / lanes * lanes;
  AlignedVector<float> values(strands * padded);
  Geometry geometry{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    geometry.column_step[axis] = static_cast<float>(lattice.per_column[axis]);
    const double radius = blob_radius(lattice.per_row[axis], lattice.per_column[axis]);
    geometry.inverse_radius[axis] = static_cast<float>(1 / std::max(radius, 1e-6));
  }
  geometry.width = canvas.width();
  geometry.end = static_cast<float>(canvas.width() - 1);
  std::array<Blobs, strands> blobs;
  float* cells = canvas.cells();
  const std::size_t turns = (size + strands - 1) / strands;
  for (std::size_t turn = 0; turn < turns; ++turn) {
    std::array<std::array<float, 2>, strands> start{};
    std::size_t active = 0;
    for (; active < strands && turn + active * turns < size; ++active) {
      const std::size_t row = turn + active * turns;
      for (std::size_t axis = 0; axis < 2; ++axis)
        start[active][axis] =
            static_cast<float>(lattice.first[axis] + double(row) * lattice.per_row[axis] - 0.5);
      mix_row(squares, size, row, padded, values.data() + active * padded);
    }
    for (std::size_t from = 0; from < size; from += lanes) {
      for (std::size_t strand = 0; strand < active; ++strand)
        make_blobs(geometry, start[strand].data(), from, values.data() + strand * padded, blobs[strand]);
      for (std::size_t lane = 0; lane < lanes; ++lane)
        for (std::size_t strand = 0; strand < active; ++strand) {
          add_four(blobs[strand].parts.data() + 4 * lane, cells + blobs[strand].cell[lane]);
        }
    }
  }
}

HWY_ATTR void add_scaled(const float* row, float weight, std::size_t count, float* sums) {
  add_scaled_row(row, weight, count, sums);
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(scatter);
HWY_EXPORT(add_scaled);

double blob_radius(double step_of_rows, double step_of_columns) {
  // The first zero of the spectrum of (1 − (x/R)²)² lies at 2πR = 5.7635.
  constexpr double radii_per_step = 5.7634592 / (2 * 3.14159265358979);
  return radii_per_step * std::hypot(step_of_rows, step_of_columns);
}

void scatter_samples(std::span<const SampleSquare> squares, const SampleLattice2& lattice, Canvas& canvas) {
  HWY_DYNAMIC_DISPATCH(scatter)(squares, lattice, canvas);
}

void add_scaled(const float* row, float weight, std::size_t count, float* sums) {
  HWY_DYNAMIC_DISPATCH(add_scaled)(row, weight, count, sums);
}

}  // namespace petzval
#endif
