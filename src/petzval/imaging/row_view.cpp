// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/plane_sampling.h>
#include <petzval/imaging/row_view.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/imaging/row_view.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

// Without vectors nothing is done at once: all is left to SceneRows and AimedPlane.
void look(const SceneMapSteps&, const CellRow&, std::size_t, std::size_t, RowView&) {}

std::size_t turn(const PlaneTurn&, const RowView&, RowView&) {
  return 0;
}

#else

using Doubles = hn::CappedTag<double, 8>;
using HalfFloats = hn::Rebind<float, Doubles>;
using HalfIntegers = hn::Rebind<std::int32_t, Doubles>;
using Vector = hn::Vec<Doubles>;

/// The steps that some cells of a row lie in, and where in them.
struct StepsOfCells {
  static constexpr std::size_t most = 64;  ///< cells
  alignas(64) std::array<SceneMapStep, most> steps;
  alignas(64) std::array<double, most> further;  ///< r'² from the step on
};

HWY_ATTR HWY_INLINE Vector left_of_axis(const CellRow& cells, std::size_t at) {
  const Doubles d;
  const Vector column = hn::Add(hn::Iota(d, 0), hn::Set(d, double(at)));
  return hn::Mul(hn::Sub(hn::Set(d, double(cells.count) / 2 - 0.5), column), hn::Set(d, cells.pitch_mm));
}

/// Reads steps whole, which takes a fraction of the time of gathering their numbers one by one.
HWY_ATTR void find_steps(const SceneMapSteps& map, const CellRow& cells, std::size_t first, std::size_t count,
                         StepsOfCells& found) {
  const Doubles d;
  alignas(64) std::array<std::int32_t, StepsOfCells::most> k;
  const Vector y_squared = hn::Set(d, cells.y_mm * cells.y_mm);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const Vector x = left_of_axis(cells, first + i);
    const Vector square = hn::Min(hn::MulAdd(x, x, y_squared), hn::Set(d, map.last_height_squared));
    const Vector step = hn::Floor(hn::Mul(square, hn::Set(d, map.steps_per_square)));
    hn::StoreU(hn::DemoteTo(HalfIntegers(), step), HalfIntegers(), &k[i]);
    hn::StoreU(hn::NegMulAdd(step, hn::Set(d, 1 / map.steps_per_square), square), d, &found.further[i]);
  }
  for (std::size_t i = 0; i < count; ++i) found.steps[i] = map.steps[k[i]];
}

/// What the cells [first, end) and their mirror images see. Arrays have room for whole vectors.
HWY_ATTR void look(const SceneMapSteps& map, const CellRow& cells, std::size_t first, std::size_t end,
                   RowView& view) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  end = first + (end - first + lanes - 1) / lanes * lanes;
  const auto set = [&](double value) { return hn::Set(d, value); };
  const Vector y = set(cells.y_mm);
  StepsOfCells found;
  for (std::size_t at = first; at < end; at += lanes) {
    const std::size_t place = (at - first) % StepsOfCells::most;
    if (place == 0) find_steps(map, cells, at, std::min(StepsOfCells::most, end - at), found);
    const Vector x = left_of_axis(cells, at), further = hn::LoadU(d, &found.further[place]);
    Vector samples_per_mm, g_source_sr, slope, g_slope;
    static_assert(sizeof(SceneMapStep) == 4 * sizeof(double));
    hn::LoadInterleaved4(d, &found.steps[place].samples_per_mm, samples_per_mm, g_source_sr, slope, g_slope);
    const Vector ratio = hn::MulAdd(further, slope, samples_per_mm);
    const Vector g = hn::MulAdd(further, g_slope, g_source_sr);
    const Vector left = hn::Mul(ratio, x), below = hn::Mul(ratio, y);
    // The samples that a cell spans along an axis: the derivative of ratio × its place.
    const auto spanned = [&](Vector place) {
      const Vector twice = hn::Mul(hn::Mul(place, place), hn::Add(slope, slope));
      return hn::DemoteTo(HalfFloats(), hn::Mul(hn::Add(ratio, twice), set(cells.pitch_mm)));
    };
    const auto light = hn::DemoteTo(HalfFloats(), g), across = spanned(x), along = spanned(y);
    const std::size_t mirrored = cells.count - at - lanes;
    hn::StoreU(hn::Neg(left), d, view.right.data() + at);
    hn::StoreU(hn::Reverse(d, left), d, view.right.data() + mirrored);
    hn::StoreU(below, d, view.down.data() + at);
    hn::StoreU(hn::Reverse(d, below), d, view.down.data() + mirrored);
    const HalfFloats half;
    const auto both = [&](auto values, std::vector<float>& to) {
      hn::StoreU(values, half, to.data() + at);
      hn::StoreU(hn::Reverse(half, values), half, to.data() + mirrored);
    };
    both(light, view.g_source_sr);
    both(across, view.width);
    both(along, view.height);
  }
}

HWY_ATTR std::size_t turn(const PlaneTurn& turn, const RowView& straight, RowView& turned) {
  const Doubles d;
  const HalfFloats half;
  const std::size_t lanes = hn::Lanes(d), count = straight.right.size();
  const auto set = [&](double value) { return hn::Set(d, value); };
  const Vector per_sample = set(turn.tangent_per_sample), samples = set(1 / turn.tangent_per_sample);
  const Vector cos_pan = set(turn.cos_pan), sin_pan = set(turn.sin_pan), cos_pitch = set(turn.cos_pitch),
               sin_pitch = set(turn.sin_pitch), pan_of_up = set(turn.sin_pitch * turn.cos_pan);
  std::size_t at = 0;
  for (; at + lanes <= count; at += lanes) {
    const Vector right = hn::LoadU(d, straight.right.data() + at),
                 down = hn::LoadU(d, straight.down.data() + at);
    const Vector x = hn::Mul(right, per_sample), y = hn::Neg(hn::Mul(down, per_sample));
    const Vector up = hn::MulAdd(y, cos_pitch, sin_pitch), ahead = hn::NegMulAdd(y, sin_pitch, cos_pitch);
    const Vector aside = hn::MulAdd(x, cos_pan, hn::Mul(ahead, sin_pan)),
                 front = hn::NegMulAdd(x, sin_pan, hn::Mul(ahead, cos_pan));
    const auto seen = hn::Gt(front, hn::Zero(d));
    const Vector inverse = hn::Div(set(1), front), square = hn::Mul(inverse, inverse);
    const Vector scale = hn::Mul(inverse, samples);
    hn::StoreU(hn::IfThenElse(seen, hn::Mul(aside, scale), right), d, turned.right.data() + at);
    hn::StoreU(hn::IfThenElse(seen, hn::Neg(hn::Mul(up, scale)), down), d, turned.down.data() + at);
    const auto stretch = [&](const std::vector<float>& side, Vector by, std::vector<float>& to) {
      const auto factor = hn::DemoteTo(half, hn::IfThenElse(seen, hn::Mul(hn::Abs(by), square), set(1)));
      hn::StoreU(hn::Mul(hn::LoadU(half, side.data() + at), factor), half, to.data() + at);
    };
    stretch(straight.width, hn::MulAdd(cos_pan, front, hn::Mul(aside, sin_pan)), turned.width);
    stretch(straight.height, hn::MulAdd(cos_pitch, front, hn::Mul(up, pan_of_up)), turned.height);
    const auto light = hn::DemoteTo(half, hn::IfThenElseZero(seen, set(1)));
    hn::StoreU(hn::Mul(hn::LoadU(half, straight.g_source_sr.data() + at), light), half,
               turned.g_source_sr.data() + at);
  }
  return at;
}

#endif

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(look);
HWY_EXPORT(turn);

void RowView::look(const SceneMapSteps& map, const CellRow& cells) {
  right.resize(cells.count);
  down.resize(cells.count);
  width.resize(cells.count);
  height.resize(cells.count);
  g_source_sr.resize(cells.count);
  // Bright cells reach as far as the last height, but for one that rounding might darken.
  const double bright_mm = std::sqrt(std::max(0.0, map.last_height_squared - cells.y_mm * cells.y_mm));
  const double beyond = double(cells.count) / 2 - bright_mm / cells.pitch_mm;
  const std::size_t middle = (cells.count + 1) / 2;
  dark = beyond <= 0 ? 0 : std::min(middle, static_cast<std::size_t>(beyond) + 2);
  // Whole vectors, from the middle outwards.
  const std::size_t lanes = sampled_at_once();
  if (cells.count < 2 * lanes) dark = middle;
  if (dark == middle) return;
  HWY_DYNAMIC_DISPATCH(look)(map, cells, dark, middle, *this);
}

std::size_t turn_row(const PlaneTurn& turn, const RowView& straight, RowView& turned) {
  return HWY_DYNAMIC_DISPATCH(turn)(turn, straight, turned);
}

}  // namespace petzval
#endif
