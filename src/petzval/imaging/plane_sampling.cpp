// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/plane_sampling.h>

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/imaging/plane_sampling.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using Floats = hn::Rebind<float, Doubles>;
using Integers = hn::Rebind<std::int32_t, Doubles>;
using Wide = hn::Rebind<std::int64_t, Doubles>;
using Vector = hn::Vec<Doubles>;

/// What `steps` hold in `member` at the steps k.
HWY_ATTR HWY_INLINE Vector gathered(const SceneMapStep* steps, double SceneMapStep::*member,
                                    hn::Vec<Wide> k) {
  static_assert(sizeof(SceneMapStep) == 4 * sizeof(double));
  return hn::GatherIndex(Doubles(), &(steps->*member), hn::ShiftLeft<2>(k));
}

/// Samples of the scene at an index.
HWY_ATTR HWY_INLINE Vector gathered(const float* samples, hn::Vec<Integers> at) {
  return hn::PromoteTo(Doubles(), hn::GatherIndex(Floats(), samples, at));
}

HWY_ATTR std::size_t sample(const PlaneView& view, const CellRow& cells, std::size_t from,
                            float* irradiance) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  const auto set = [&](double value) { return hn::Set(d, value); };
  const Vector y = set(cells.y_mm), half = set(0.5), room = set(view.room);
  const auto width = static_cast<std::ptrdiff_t>(view.columns);
  for (; from + lanes <= cells.count; from += lanes) {
    const Vector column = hn::Add(hn::Iota(d, 0), set(double(from)));
    const Vector x = hn::NegMulAdd(column, set(cells.pitch_mm), set(cells.first_x_mm));
    const Vector square = hn::MulAdd(x, x, hn::Mul(y, y));
    const Vector at = hn::Floor(hn::Mul(square, set(view.steps_per_square)));
    const Vector further = hn::Sub(square, hn::Mul(at, set(1 / view.steps_per_square)));
    const auto bright = hn::Lt(square, set(view.last_height_squared));
    if (!hn::AllTrue(d, bright)) return from;
    const auto k = hn::ConvertTo(Wide(), at);
    const Vector ratio = hn::MulAdd(further, gathered(view.steps, &SceneMapStep::samples_slope, k),
                                    gathered(view.steps, &SceneMapStep::samples_per_mm, k));
    const Vector g = hn::MulAdd(further, gathered(view.steps, &SceneMapStep::g_source_slope, k),
                                gathered(view.steps, &SceneMapStep::g_source_sr, k));
    const Vector across = hn::NegMulAdd(ratio, x, set(view.columns / 2));
    const Vector down = hn::MulAdd(ratio, y, set(view.rows / 2));
    const auto inside = hn::And(hn::And(hn::Gt(across, room), hn::Lt(across, set(view.columns - view.room))),
                                hn::And(hn::Gt(down, room), hn::Lt(down, set(view.rows - view.room))));
    if (!hn::AllTrue(d, inside)) return from;

    const Vector u = hn::Sub(across, half), v = hn::Sub(down, half);
    const Vector j = hn::Floor(u), i = hn::Floor(v), right = hn::Sub(u, j), below = hn::Sub(v, i);
    const auto index = hn::DemoteTo(Integers(), hn::MulAdd(i, set(view.columns), j));
    const float *here = view.radiance, *next = here + width;
    const Vector a = gathered(here, index), b = gathered(here + 1, index), c = gathered(next, index),
                 e = gathered(next + 1, index);
    const Vector upper = hn::MulAdd(right, hn::Sub(b, a), a), lower = hn::MulAdd(right, hn::Sub(e, c), c);
    const Vector radiance = hn::MulAdd(below, hn::Sub(lower, upper), upper);
    hn::StoreU(hn::DemoteTo(Floats(), hn::Mul(g, radiance)), Floats(), irradiance + from);
  }
  return from;
}

HWY_ATTR std::size_t width() {
  return hn::Lanes(Doubles());
}

}  // namespace
}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {

HWY_EXPORT(sample);
HWY_EXPORT(width);

std::size_t sample_row(const PlaneView& view, const CellRow& cells, std::size_t from, float* irradiance) {
  return HWY_DYNAMIC_DISPATCH(sample)(view, cells, from, irradiance);
}

std::size_t sampled_at_once() {
  return HWY_DYNAMIC_DISPATCH(width)();
}

}  // namespace petzval
#endif
