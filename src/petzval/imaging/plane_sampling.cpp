// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/plane_sampling.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/imaging/plane_sampling.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

// Without vectors nothing is done at once: all is left to SceneRows.
void look(const SceneMapSteps&, const CellRow&, std::size_t, std::size_t, RowView&) {}

std::size_t sample(const PlaneView&, const RowView&, double, std::size_t from, std::size_t, float*) {
  return from;
}

std::size_t turn(const PlaneTurn&, const RowView&, RowView&) {
  return 0;
}

std::size_t width() {
  return 1;
}

#else

// As many floats as doubles in two vectors.
using Floats = hn::CappedTag<float, 16>;
using Doubles = hn::Repartition<double, Floats>;
using HalfFloats = hn::Rebind<float, Doubles>;
using HalfIntegers = hn::Rebind<std::int32_t, Doubles>;
using Wide = hn::Rebind<std::int64_t, Doubles>;
using Vector = hn::Vec<Doubles>;

/// What `steps` hold in `member` at the steps k.
HWY_ATTR HWY_INLINE Vector gathered(const SceneMapStep* steps, double SceneMapStep::*member,
                                    hn::Vec<Wide> k) {
  static_assert(sizeof(SceneMapStep) == 4 * sizeof(double));
  return hn::GatherIndex(Doubles(), &(steps->*member), hn::ShiftLeft<2>(k));
}

/// What the cells [first, end) and their mirror images see. Arrays have room for whole vectors.
HWY_ATTR void look(const SceneMapSteps& map, const CellRow& cells, std::size_t first, std::size_t end,
                   RowView& view) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  const auto set = [&](double value) { return hn::Set(d, value); };
  const Vector y = set(cells.y_mm), middle = set(double(cells.count) / 2 - 0.5);
  for (std::size_t at = first; at < end; at += lanes) {
    const Vector column = hn::Add(hn::Iota(d, 0), set(double(at)));
    const Vector x = hn::Mul(hn::Sub(middle, column), set(cells.pitch_mm));
    const Vector square = hn::Min(hn::MulAdd(x, x, hn::Mul(y, y)), set(map.last_height_squared));
    const Vector step = hn::Floor(hn::Mul(square, set(map.steps_per_square)));
    const Vector further = hn::NegMulAdd(step, set(1 / map.steps_per_square), square);
    const auto k = hn::PromoteTo(Wide(), hn::DemoteTo(HalfIntegers(), step));
    const Vector slope = gathered(map.steps, &SceneMapStep::samples_slope, k);
    const Vector ratio = hn::MulAdd(further, slope, gathered(map.steps, &SceneMapStep::samples_per_mm, k));
    const Vector g = hn::MulAdd(further, gathered(map.steps, &SceneMapStep::g_source_slope, k),
                                gathered(map.steps, &SceneMapStep::g_source_sr, k));
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

/// Places along one axis: the samples nearest to them, and how far they are beyond.
struct Places {
  Vector nearest, beyond;
  hn::Mask<Doubles> inside;
};

HWY_ATTR HWY_INLINE Places places_at(Vector from_middle, double size, double room) {
  const Doubles d;
  const Vector at = hn::Add(from_middle, hn::Set(d, size / 2));
  const auto inside = hn::And(hn::Gt(at, hn::Set(d, room)), hn::Lt(at, hn::Set(d, size - room)));
  const Vector nearest = hn::Floor(at);
  return {nearest, hn::Sub(hn::Sub(at, nearest), hn::Set(d, 0.5)), inside};
}

/// LinearMean, several at a time.
struct Means {
  hn::Vec<Floats> before, here, after;
};

HWY_ATTR HWY_INLINE Means means_of(hn::Vec<Floats> beyond, hn::Vec<Floats> length) {
  const Floats f;
  const auto half = hn::Mul(length, hn::Set(f, 0.5F)), zero = hn::Zero(f);
  const auto scale = hn::Div(hn::Set(f, 0.5F), length);
  const auto side = [&](auto middle) {
    const auto to = hn::Max(hn::Add(middle, half), zero), from = hn::Max(hn::Sub(middle, half), zero);
    return hn::Mul(hn::Mul(hn::Sub(to, from), hn::Add(to, from)), scale);
  };
  const auto before = side(hn::Neg(beyond)), after = side(beyond);
  return {before, hn::Sub(hn::Sub(hn::Set(f, 1.0F), before), after), after};
}

HWY_ATTR std::size_t sample(const PlaneView& view, const RowView& cells, double down_sign, std::size_t from,
                            std::size_t to, float* irradiance) {
  const Doubles d;
  const Floats f;
  const hn::Rebind<std::int32_t, Floats> integers;
  const std::size_t half = hn::Lanes(d), lanes = hn::Lanes(f);
  const Vector sign = hn::Set(d, down_sign), columns = hn::Set(d, view.columns);
  const auto stride = static_cast<std::ptrdiff_t>(view.columns);
  const std::size_t end = std::min(to, cells.g_source_sr.size() - cells.dark);
  if (from < cells.dark) return from;
  for (; from + lanes <= end; from += lanes) {
    const auto across_at = [&](std::size_t first) {
      return places_at(hn::LoadU(d, cells.right.data() + first), view.columns, view.room);
    };
    const auto down_at = [&](std::size_t first) {
      return places_at(hn::Mul(sign, hn::LoadU(d, cells.down.data() + first)), view.rows, view.room);
    };
    const Places across_low = across_at(from), across_high = across_at(from + half);
    const Places down_low = down_at(from), down_high = down_at(from + half);
    const auto inside =
        hn::And(hn::And(across_low.inside, across_high.inside), hn::And(down_low.inside, down_high.inside));
    const auto width = hn::LoadU(f, cells.width.data() + from),
               height = hn::LoadU(f, cells.height.data() + from);
    if (!hn::AllTrue(d, inside) || !hn::AllTrue(f, hn::Le(hn::Max(width, height), hn::Set(f, 1.0F))) ||
        !hn::AllTrue(f, hn::Gt(hn::Min(width, height), hn::Zero(f))))
      return from;

    const auto both = [&](Vector low, Vector high) {
      return hn::Combine(f, hn::DemoteTo(HalfFloats(), high), hn::DemoteTo(HalfFloats(), low));
    };
    const auto index_of = [&](const Places& across, const Places& down) {
      return hn::DemoteTo(HalfIntegers(), hn::MulAdd(down.nearest, columns, across.nearest));
    };
    const auto index =
        hn::Combine(integers, index_of(across_high, down_high), index_of(across_low, down_low));
    const Means right = means_of(both(across_low.beyond, across_high.beyond), width),
                below = means_of(both(down_low.beyond, down_high.beyond), height);
    const auto row = [&](std::ptrdiff_t offset) {
      const float* samples = view.radiance + offset;
      const auto sides = hn::Mul(right.before, hn::GatherIndex(f, samples - 1, index));
      const auto inner = hn::MulAdd(right.here, hn::GatherIndex(f, samples, index), sides);
      return hn::MulAdd(right.after, hn::GatherIndex(f, samples + 1, index), inner);
    };
    const auto radiance = hn::MulAdd(below.after, row(stride),
                                     hn::MulAdd(below.here, row(0), hn::Mul(below.before, row(-stride))));
    hn::StoreU(hn::Mul(radiance, hn::LoadU(f, cells.g_source_sr.data() + from)), f, irradiance + from);
  }
  return from;
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

HWY_ATTR std::size_t width() {
  return hn::Lanes(Floats());
}

#endif

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(look);
HWY_EXPORT(sample);
HWY_EXPORT(turn);
HWY_EXPORT(width);

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

std::size_t sample_row(const PlaneView& view, const RowView& cells, double down, std::size_t from,
                       std::size_t to, float* irradiance) {
  return HWY_DYNAMIC_DISPATCH(sample)(view, cells, down, from, to, irradiance);
}

std::size_t turn_row(const PlaneTurn& turn, const RowView& straight, RowView& turned) {
  return HWY_DYNAMIC_DISPATCH(turn)(turn, straight, turned);
}

std::size_t sampled_at_once() {
  return HWY_DYNAMIC_DISPATCH(width)();
}

}  // namespace petzval
#endif
