// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/sample_scatter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

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

/// The lit samples of a row, padded to full vectors. \param size  of the largest square.
HWY_ATTR HWY_INLINE void mix_row(std::span<const SampleSquare> squares, std::size_t size, std::size_t row,
                                 const LitSamples& lit, float* values) {
  const std::size_t lanes = hn::Lanes(Lanes());
  std::fill_n(values, (lit.end - lit.first + lanes - 1) / lanes * lanes, 0.0F);
  for (const SampleSquare& square : squares) {
    const std::size_t before = (size - square.size) / 2;
    if (row < before || row >= before + square.size) continue;
    const LitSamples& own = square.lit[row - before];
    add_scaled_row(square.samples + (row - before) * square.size + own.first, square.weight,
                   own.end - own.first, values + before + own.first - lit.first);
  }
}

/// What is lit of the rows of a mixture.
class LitRows {
 public:
  /// \param size  of the largest square.
  LitRows(std::span<const SampleSquare> squares, std::size_t size, std::size_t lanes)
      : lit_(size), before_(size + 1) {
    for (const SampleSquare& square : squares) {
      const std::size_t before = (size - square.size) / 2;
      for (std::size_t row = 0; row < square.size; ++row) {
        const LitSamples& own = square.lit[row];
        LitSamples& lit = lit_[before + row];
        if (own.first == own.end) continue;
        const bool dark = lit.first == lit.end;
        lit = {dark ? before + own.first : std::min(lit.first, before + own.first),
               dark ? before + own.end : std::max(lit.end, before + own.end)};
      }
    }
    for (std::size_t row = 0; row < size; ++row)
      before_[row + 1] = before_[row] + (lit_[row].end - lit_[row].first + lanes - 1) / lanes;
  }
  const LitSamples& lit(std::size_t row) const { return lit_[row]; }
  /// The first row of the k-th of so many parts, with about as many vectors each.
  std::size_t border(std::size_t k, std::size_t parts) const {
    const std::size_t wanted = before_.back() * k / parts;
    if (k == parts) return lit_.size();
    return static_cast<std::size_t>(std::upper_bound(before_.begin(), before_.end(), wanted) -
                                    before_.begin()) -
           1;
  }

 private:
  std::vector<LitSamples> lit_;
  std::vector<std::size_t> before_;  ///< vectors in the rows before each
};

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

/// Where one strand has come to.
struct Strand {
  std::size_t row = 0, end_row = 0;  ///< the next one, and the one behind its last
  std::size_t from = 0, end = 0;     ///< samples of the row at hand
  std::array<double, 2> start{};     ///< of that row, half a cell before its first sample
  const float* next = nullptr;       ///< values of the samples from `from` on
};

HWY_ATTR void scatter(std::span<const SampleSquare> squares, const PlacedLattice& lattice, Canvas& canvas) {
  const std::size_t lanes = hn::Lanes(Lanes());
  std::size_t size = 0;
  for (const SampleSquare& square : squares) size = std::max(size, square.size);
  const LitRows rows(squares, size, lanes);
  const std::size_t padded = (size + lanes - 1) / lanes * lanes;
  AlignedVector<float> values(strands * padded);
  Geometry geometry{};
  geometry.column_step = lattice.per_column;
  geometry.width = canvas.width();
  for (std::size_t axis = 0; axis < 2; ++axis)
    geometry.inverse_radius[axis] = static_cast<float>(
        1 / std::max(1e-6, blob_radius(std::hypot(lattice.per_row[axis], lattice.per_column[axis]))));

  std::array<Strand, strands> all{};
  for (std::size_t k = 0; k < strands; ++k) {
    all[k].row = rows.border(k, strands);
    all[k].end_row = rows.border(k + 1, strands);
  }
  /// Whether there is anything left to do for it.
  const auto go_on = [&](std::size_t k) HWY_ATTR {
    Strand& strand = all[k];
    for (; strand.from >= strand.end; ++strand.row) {
      if (strand.row == strand.end_row) return false;
      const LitSamples& lit = rows.lit(strand.row);
      strand.from = lit.first;
      strand.end = lit.end;
      for (std::size_t axis = 0; axis < 2; ++axis)
        strand.start[axis] = lattice.first[axis] + double(strand.row) * lattice.per_row[axis] - 0.5;
      float* row = values.data() + k * padded;
      mix_row(squares, size, strand.row, lit, row);
      strand.next = row;
    }
    return true;
  };
  std::array<Blobs, strands> blobs;
  float* cells = canvas.cells();
  std::size_t active = strands;
  while (active != 0) {
    active = 0;
    for (std::size_t k = 0; k < strands; ++k) {
      if (!go_on(k)) continue;
      Strand& strand = all[k];
      make_blobs(geometry, start_of(strand.start, geometry, strand.from), strand.next, blobs[active++]);
      strand.from += lanes;
      strand.next += lanes;
    }
    for (std::size_t lane = 0; lane < lanes; ++lane)
      for (std::size_t i = 0; i < active; ++i)
        add_four(blobs[i].parts.data() + 4 * lane, cells + blobs[i].cell[lane]);
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
