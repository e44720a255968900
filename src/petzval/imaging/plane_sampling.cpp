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

// Without vectors nothing is done at once: all is left to averaged().
void look(const SceneMapSteps&, const CellRow&, std::size_t, std::size_t, double*, double*, float*) {}

std::size_t sample(const PlaneView&, const RowView&, double, std::size_t from, float*) {
  return from;
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
                   double* right, double* down, float* g_source_sr) {
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
    const Vector ratio = hn::MulAdd(further, gathered(map.steps, &SceneMapStep::samples_slope, k),
                                    gathered(map.steps, &SceneMapStep::samples_per_mm, k));
    const Vector g = hn::MulAdd(further, gathered(map.steps, &SceneMapStep::g_source_slope, k),
                                gathered(map.steps, &SceneMapStep::g_source_sr, k));
    const Vector left = hn::Mul(ratio, x), below = hn::Mul(ratio, y);
    const auto light = hn::DemoteTo(HalfFloats(), g);
    hn::StoreU(hn::Neg(left), d, right + at);
    hn::StoreU(below, d, down + at);
    hn::StoreU(light, HalfFloats(), g_source_sr + at);
    const std::size_t mirrored = cells.count - at - lanes;
    hn::StoreU(hn::Reverse(d, left), d, right + mirrored);
    hn::StoreU(hn::Reverse(d, below), d, down + mirrored);
    hn::StoreU(hn::Reverse(HalfFloats(), light), HalfFloats(), g_source_sr + mirrored);
  }
}

/// Places along one axis: the samples before them, and how far they are beyond.
struct Places {
  Vector before, beyond;
  hn::Mask<Doubles> inside;
};

HWY_ATTR HWY_INLINE Places places_at(Vector from_middle, double size, double room) {
  const Doubles d;
  const Vector at = hn::Add(from_middle, hn::Set(d, size / 2));
  const auto inside = hn::And(hn::Gt(at, hn::Set(d, room)), hn::Lt(at, hn::Set(d, size - room)));
  const Vector u = hn::Sub(at, hn::Set(d, 0.5)), before = hn::Floor(u);
  return {before, hn::Sub(u, before), inside};
}

/// Pairs of samples that are neighbours in a row, at byte offsets.
HWY_ATTR HWY_INLINE hn::Vec<Floats> pairs_at(const float* samples, hn::Vec<Wide> offsets) {
  return hn::BitCast(Floats(),
                     hn::GatherOffset(Wide(), reinterpret_cast<const std::int64_t*>(samples), offsets));
}

HWY_ATTR std::size_t sample(const PlaneView& view, const RowView& cells, double down_sign, std::size_t from,
                            float* irradiance) {
  const Doubles d;
  const Floats f;
  const std::size_t half = hn::Lanes(d), lanes = hn::Lanes(f);
  const Vector sign = hn::Set(d, down_sign), columns = hn::Set(d, view.columns);
  const float *here = view.radiance, *next = here + static_cast<std::ptrdiff_t>(view.columns);
  const std::size_t end = cells.g_source_sr.size() - cells.dark;
  if (from < cells.dark) return from;
  for (; from + lanes <= end; from += lanes) {
    const Places across_low = places_at(hn::LoadU(d, cells.right.data() + from), view.columns, view.room),
                 across_high =
                     places_at(hn::LoadU(d, cells.right.data() + from + half), view.columns, view.room);
    const Places down_low =
                     places_at(hn::Mul(sign, hn::LoadU(d, cells.down.data() + from)), view.rows, view.room),
                 down_high = places_at(hn::Mul(sign, hn::LoadU(d, cells.down.data() + from + half)),
                                       view.rows, view.room);
    const auto inside =
        hn::And(hn::And(across_low.inside, across_high.inside), hn::And(down_low.inside, down_high.inside));
    if (!hn::AllTrue(d, inside)) return from;

    const auto offsets = [&](const Places& across, const Places& down) {
      const Vector index = hn::MulAdd(down.before, columns, across.before);
      return hn::ShiftLeft<2>(hn::PromoteTo(Wide(), hn::DemoteTo(HalfIntegers(), index)));
    };
    const auto both = [&](Vector low, Vector high) {
      return hn::Combine(f, hn::DemoteTo(HalfFloats(), high), hn::DemoteTo(HalfFloats(), low));
    };
    const auto low = offsets(across_low, down_low), high = offsets(across_high, down_high);
    const auto upper_low = pairs_at(here, low), upper_high = pairs_at(here, high),
               lower_low = pairs_at(next, low), lower_high = pairs_at(next, high);
    const auto right = both(across_low.beyond, across_high.beyond),
               below = both(down_low.beyond, down_high.beyond);
    const auto between = [&](auto pairs_high, auto pairs_low) {
      const auto left = hn::ConcatEven(f, pairs_high, pairs_low);
      return hn::MulAdd(right, hn::Sub(hn::ConcatOdd(f, pairs_high, pairs_low), left), left);
    };
    const auto upper = between(upper_high, upper_low), lower = between(lower_high, lower_low);
    const auto radiance = hn::MulAdd(below, hn::Sub(lower, upper), upper);
    hn::StoreU(hn::Mul(radiance, hn::LoadU(f, cells.g_source_sr.data() + from)), f, irradiance + from);
  }
  return from;
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
HWY_EXPORT(width);

void RowView::look(const SceneMapSteps& map, const CellRow& cells) {
  right.resize(cells.count);
  down.resize(cells.count);
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
  HWY_DYNAMIC_DISPATCH(look)(map, cells, dark, middle, right.data(), down.data(), g_source_sr.data());
}

std::size_t sample_row(const PlaneView& view, const RowView& cells, double down, std::size_t from,
                       float* irradiance) {
  return HWY_DYNAMIC_DISPATCH(sample)(view, cells, down, from, irradiance);
}

std::size_t sampled_at_once() {
  return HWY_DYNAMIC_DISPATCH(width)();
}

}  // namespace petzval
#endif
