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
  std::array<double, 2> column_step;
  std::array<float, 2> inverse_radius;
  std::int32_t width;
};

/// Half a cell before the first sample of a vector: the cell, and how far in it.
struct Start {
  std::array<std::int32_t, 2> cell;
  std::array<float, 2> within;
};

/// \param row  half a cell before the first sample of a row. \param from  the first sample of the vector.
HWY_INLINE Start start_of(const std::array<double, 2>& row, const Geometry& geometry, std::size_t from) {
  Start start{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double far = 1e6;  // beside any canvas
    const double at = std::clamp(row[axis] + double(from) * geometry.column_step[axis], -far, far);
    start.cell[axis] = static_cast<std::int32_t>(std::floor(at));
    start.within[axis] = static_cast<float>(at - start.cell[axis]);
  }
  return start;
}

/// The share of a blob that lies in the second of the two cells that it may reach. \param within  how far
/// half a cell before its middle lies in the first.
HWY_ATTR HWY_INLINE Vector share_beyond(Vector within, float inverse_radius) {
  const Lanes d;
  const auto set = [&](float value) { return hn::Set(d, value); };
  // From the border between the two to the middle of the blob [radii].
  const Vector x = hn::Mul(hn::Sub(within, set(0.5F)), set(inverse_radius));
  const Vector t = hn::Max(hn::Min(x, set(1.0F)), set(-1.0F)), square = hn::Mul(t, t);
  constexpr float scale = 315.0F / 256;
  Vector slope = hn::MulAdd(square, set(scale / 9), set(-4 * scale / 7));
  slope = hn::MulAdd(slope, square, set(6 * scale / 5));
  slope = hn::MulAdd(slope, square, set(-4 * scale / 3));
  slope = hn::MulAdd(slope, square, set(scale));
  return hn::MulAdd(t, slope, set(0.5F));
}

/// Along one axis: how far samples lie in their cells, and these.
struct Places {
  Vector within;
  hn::Vec<Integers> cell;
};
HWY_ATTR HWY_INLINE Places places(const Start& start, const Geometry& geometry, std::size_t axis) {
  const Lanes d;
  const Vector step = hn::Set(d, static_cast<float>(geometry.column_step[axis]));
  const Vector at = hn::MulAdd(hn::Iota(d, 0), step, hn::Set(d, start.within[axis]));
  const Vector whole = hn::Floor(at);
  return {hn::Sub(at, whole),
          hn::Add(hn::ConvertTo(Integers(), whole), hn::Set(Integers(), start.cell[axis]))};
}

HWY_ATTR HWY_INLINE void make_blobs(const Geometry& geometry, const Start& start, const float* values,
                                    Blobs& blobs) {
  const Lanes d;
  const Integers integers;
  const Places across = places(start, geometry, 0), down = places(start, geometry, 1);
  const auto before = hn::Set(integers, -1), end = hn::Set(integers, geometry.width - 1);
  const auto inside = hn::And(hn::And(hn::Gt(across.cell, before), hn::Lt(across.cell, end)),
                              hn::And(hn::Gt(down.cell, before), hn::Lt(down.cell, end)));
  const Vector value = hn::IfThenElseZero(hn::RebindMask(d, inside), hn::Load(d, values));
  const Vector right = share_beyond(across.within, geometry.inverse_radius[0]);
  const Vector below = share_beyond(down.within, geometry.inverse_radius[1]);
  const Vector lower = hn::Mul(value, below), upper = hn::Sub(value, lower);
  const Vector upper_right = hn::Mul(upper, right), lower_right = hn::Mul(lower, right);
  hn::StoreInterleaved4(hn::Sub(upper, upper_right), upper_right, hn::Sub(lower, lower_right), lower_right, d,
                        blobs.parts.data());
  const auto cell = hn::Add(hn::Mul(down.cell, hn::Set(integers, geometry.width)), across.cell);
  hn::Store(hn::IfThenElseZero(inside, hn::ShiftLeft<2>(cell)), integers, blobs.cell.data());
}

HWY_ATTR HWY_INLINE void add_four(const float* parts, float* cell) {
  const hn::CappedTag<float, 4> d;  // one lane where there are no vectors
  for (std::size_t i = 0; i < 4; i += hn::Lanes(d))
    hn::Store(hn::Add(hn::Load(d, cell + i), hn::Load(d, parts + i)), d, cell + i);
}

HWY_ATTR void scatter(std::span<const SampleSquare> squares, const PlacedLattice& lattice, Canvas& canvas) {
  const std::size_t lanes = hn::Lanes(Lanes());
  std::size_t size = 0;
  for (const SampleSquare& square : squares) size = std::max(size, square.size);
  const std::size_t padded = (size + lanes - 1) / lanes * lanes;
  AlignedVector<float> values(strands * padded);
  Geometry geometry{};
  geometry.column_step = lattice.per_column;
  geometry.width = canvas.width();
  for (std::size_t axis = 0; axis < 2; ++axis)
    geometry.inverse_radius[axis] = static_cast<float>(
        1 / std::max(1e-6, blob_radius(std::hypot(lattice.per_row[axis], lattice.per_column[axis]))));
  std::array<Blobs, strands> blobs;
  float* cells = canvas.cells();
  const std::size_t turns = (size + strands - 1) / strands;
  for (std::size_t turn = 0; turn < turns; ++turn) {
    std::array<std::array<double, 2>, strands> row_start{};
    std::size_t active = 0;
    for (; active < strands && turn + active * turns < size; ++active) {
      const std::size_t row = turn + active * turns;
      for (std::size_t axis = 0; axis < 2; ++axis)
        row_start[active][axis] = lattice.first[axis] + double(row) * lattice.per_row[axis] - 0.5;
      mix_row(squares, size, row, padded, values.data() + active * padded);
    }
    for (std::size_t from = 0; from < size; from += lanes) {
      for (std::size_t strand = 0; strand < active; ++strand)
        make_blobs(geometry, start_of(row_start[strand], geometry, from),
                   values.data() + strand * padded + from, blobs[strand]);
      for (std::size_t lane = 0; lane < lanes; ++lane)
        for (std::size_t strand = 0; strand < active; ++strand)
          add_four(blobs[strand].parts.data() + 4 * lane, cells + blobs[strand].cell[lane]);
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

void scatter_samples(std::span<const SampleSquare> squares, const PlacedLattice& lattice, Canvas& canvas) {
  HWY_DYNAMIC_DISPATCH(scatter)(squares, lattice, canvas);
}

void add_scaled(const float* row, float weight, std::size_t count, float* sums) {
  HWY_DYNAMIC_DISPATCH(add_scaled)(row, weight, count, sums);
}

}  // namespace petzval
#endif
