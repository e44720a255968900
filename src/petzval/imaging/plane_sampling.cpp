// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/plane_sampling.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

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
std::size_t sample(const PlaneView&, const RowView&, std::size_t from, std::size_t, float*) {
  return from;
}

std::size_t outside(const PlaneView&, const RowView&, std::size_t from, std::size_t) {
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
using Integers = hn::Rebind<std::int32_t, Floats>;
using Vector = hn::Vec<Doubles>;

/// Both halves of what a vector of floats holds.
HWY_ATTR HWY_INLINE hn::Vec<Floats> both(Vector low, Vector high) {
  return hn::Combine(Floats(), hn::DemoteTo(HalfFloats(), high), hn::DemoteTo(HalfFloats(), low));
}

HWY_ATTR HWY_INLINE hn::Vec<Integers> integers_of(Vector low, Vector high) {
  return hn::Combine(Integers(), hn::DemoteTo(HalfIntegers(), high), hn::DemoteTo(HalfIntegers(), low));
}

/// Places along one axis of a scene: the samples nearest to them, and how far they are beyond.
struct Places {
  Vector at_low, at_high, nearest_low, nearest_high;

  HWY_ATTR HWY_INLINE Places(const double* from_middle, double size) {
    const Doubles d;
    at_low = hn::Add(hn::LoadU(d, from_middle), hn::Set(d, size / 2));
    at_high = hn::Add(hn::LoadU(d, from_middle + hn::Lanes(d)), hn::Set(d, size / 2));
    nearest_low = hn::Floor(at_low);
    nearest_high = hn::Floor(at_high);
  }
  HWY_ATTR HWY_INLINE bool inside(double size, double room) const {
    const Doubles d;
    const auto least = hn::Set(d, room), most = hn::Set(d, size - room);
    return hn::AllTrue(
        d, hn::And(hn::Gt(hn::Min(at_low, at_high), least), hn::Lt(hn::Max(at_low, at_high), most)));
  }
  HWY_ATTR HWY_INLINE hn::Vec<Floats> beyond() const {
    const auto half = hn::Set(Doubles(), 0.5);
    return both(hn::Sub(hn::Sub(at_low, nearest_low), half), hn::Sub(hn::Sub(at_high, nearest_high), half));
  }
  /// Of stretches about the places, how much lies in the scene.
  HWY_ATTR HWY_INLINE hn::Vec<Floats> share_inside(hn::Vec<Floats> length, double size) const {
    const Floats f;
    const Vector end = hn::Set(Doubles(), size);
    const auto half = hn::Mul(length, hn::Set(f, 0.5F));
    const auto to_begin = both(at_low, at_high), to_end = both(hn::Sub(end, at_low), hn::Sub(end, at_high));
    const auto within = hn::Add(hn::Min(to_begin, half), hn::Min(to_end, half));
    return hn::Div(hn::Max(within, hn::Zero(f)), length);
  }
};

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

/// Samples at `index` and beside it in three rows. Where the cells of a vector see samples that lie together,
/// those are read at once and sorted into its lanes, which is several times faster than one by one.
class Neighbours {
 public:
  HWY_ATTR HWY_INLINE Neighbours(const PlaneView& view, hn::Vec<Integers> index)
      : radiance_(view.radiance), stride_(static_cast<std::ptrdiff_t>(view.columns)), index_(index) {
    const Integers i;
    const std::size_t lanes = hn::Lanes(i);
    const std::int32_t first = std::min(hn::GetLane(index), hn::ExtractLane(index, lanes - 1)) - 1;
    const auto held = static_cast<std::int32_t>(2 * lanes);
    const auto place = hn::Sub(index, hn::Set(i, first));
    const auto among = hn::And(hn::Gt(place, hn::Zero(i)), hn::Lt(place, hn::Set(i, held - 1)));
    const auto samples = stride_ * static_cast<std::ptrdiff_t>(view.rows);
    together_ = hn::AllTrue(i, among) && first + stride_ + held <= samples;
    if (together_) {
      first_ = first;
      index_ = place;
    }
  }

  /// The mean over a row of them, -1, 0 or 1.
  HWY_ATTR HWY_INLINE hn::Vec<Floats> mean(const Means& of, std::ptrdiff_t row) const {
    const Floats f;
    const Integers i;
    const float* samples = radiance_ + row * stride_;
    const auto sum = [&](auto before, auto here, auto after) {
      return hn::MulAdd(of.after, after, hn::MulAdd(of.here, here, hn::Mul(of.before, before)));
    };
    if (!together_)
      return sum(hn::GatherIndex(f, samples - 1, index_), hn::GatherIndex(f, samples, index_),
                 hn::GatherIndex(f, samples + 1, index_));
    const auto lanes = static_cast<std::int32_t>(hn::Lanes(f));
    const auto low = hn::LoadU(f, samples + first_), high = hn::LoadU(f, samples + first_ + lanes);
    const auto at = [&](std::int32_t beside) {
      const auto place = hn::Add(index_, hn::Set(i, beside)), last = hn::Set(i, lanes - 1);
      const auto lane = hn::IndicesFromVec(f, hn::And(place, last));
      return hn::IfThenElse(hn::RebindMask(f, hn::Gt(place, last)), hn::TableLookupLanes(high, lane),
                            hn::TableLookupLanes(low, lane));
    };
    return sum(at(-1), at(0), at(1));
  }

 private:
  const float* radiance_;
  std::ptrdiff_t stride_, first_ = 0;
  hn::Vec<Integers> index_;
  bool together_ = false;
};

/// What is seen about the edge of a scene and beyond.
HWY_ATTR hn::Vec<Floats> radiance_at_edge(const PlaneView& view, const Places& across, const Places& down,
                                          const Means& right, const Means& below) {
  const Floats f;
  const Integers i;
  const auto clamped = [&](const Places& places, std::int32_t beside, double size) {
    const Doubles d;
    const auto index = [&](Vector nearest) {
      const Vector sample = hn::Add(nearest, hn::Set(d, double(beside)));
      return hn::Max(hn::Min(sample, hn::Set(d, size - 1)), hn::Zero(d));
    };
    return integers_of(index(places.nearest_low), index(places.nearest_high));
  };
  const auto stride = hn::Set(i, static_cast<std::int32_t>(view.columns));
  auto radiance = hn::Zero(f);
  for (const auto& [beside, weight] : {std::pair(-1, below.before), {0, below.here}, {1, below.after}}) {
    const auto first = hn::Mul(clamped(down, beside, view.rows), stride);
    const auto at = [&](std::int32_t column) {
      return hn::GatherIndex(f, view.radiance, hn::Add(first, clamped(across, column, view.columns)));
    };
    const auto mean =
        hn::MulAdd(right.after, at(1), hn::MulAdd(right.here, at(0), hn::Mul(right.before, at(-1))));
    radiance = hn::MulAdd(weight, mean, radiance);
  }
  return radiance;
}

HWY_ATTR std::size_t sample(const PlaneView& view, const RowView& cells, std::size_t from, std::size_t to,
                            float* irradiance) {
  constexpr double room = 2.5;  // to the farthest sample that a cell needs, and one more for rounding
  const Floats f;
  const std::size_t lanes = hn::Lanes(f), end = std::min(to, cells.g_source_sr.size() - cells.dark);
  if (from < cells.dark) return from;
  for (; from + lanes <= end; from += lanes) {
    const auto width = hn::LoadU(f, cells.width.data() + from),
               height = hn::LoadU(f, cells.height.data() + from);
    if (!hn::AllTrue(f, hn::Le(hn::Max(width, height), hn::Set(f, 1.0F))) ||
        !hn::AllTrue(f, hn::Gt(hn::Min(width, height), hn::Zero(f))))
      return from;
    const Places across(cells.right.data() + from, view.columns), down(cells.down.data() + from, view.rows);
    const Means right = means_of(across.beyond(), width), below = means_of(down.beyond(), height);
    auto radiance = hn::Zero(f);
    if (across.inside(view.columns, room) && down.inside(view.rows, room)) {
      const auto index_of = [&](Vector row, Vector column) {
        return hn::MulAdd(row, hn::Set(Doubles(), view.columns), column);
      };
      const Neighbours seen(view, integers_of(index_of(down.nearest_low, across.nearest_low),
                                              index_of(down.nearest_high, across.nearest_high)));
      radiance = hn::MulAdd(
          below.after, seen.mean(right, 1),
          hn::MulAdd(below.here, seen.mean(right, 0), hn::Mul(below.before, seen.mean(right, -1))));
    } else {
      radiance = radiance_at_edge(view, across, down, right, below);
      if (view.dark_around)
        radiance = hn::Mul(radiance, hn::Mul(across.share_inside(width, view.columns),
                                             down.share_inside(height, view.rows)));
    }
    hn::StoreU(hn::Mul(radiance, hn::LoadU(f, cells.g_source_sr.data() + from)), f, irradiance + from);
  }
  return from;
}

HWY_ATTR std::size_t outside(const PlaneView& view, const RowView& cells, std::size_t from, std::size_t to) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  const auto inside = [&](const std::vector<double>& middles, const std::vector<float>& sides, double size) {
    const Vector side = hn::PromoteTo(d, hn::LoadU(HalfFloats(), sides.data() + from));
    const Vector far = hn::MulAdd(side, hn::Set(d, 0.5), hn::Abs(hn::LoadU(d, middles.data() + from)));
    return hn::AllTrue(d, hn::Lt(far, hn::Set(d, size / 2)));
  };
  while (from + lanes <= to && inside(cells.right, cells.width, view.columns) &&
         inside(cells.down, cells.height, view.rows))
    from += lanes;
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

HWY_EXPORT(sample);
HWY_EXPORT(outside);
HWY_EXPORT(width);

std::size_t sample_row(const PlaneView& view, const RowView& cells, std::size_t from, std::size_t to,
                       float* irradiance) {
  return HWY_DYNAMIC_DISPATCH(sample)(view, cells, from, to, irradiance);
}

std::size_t first_outside(const PlaneView& view, const RowView& cells, std::size_t from, std::size_t to) {
  if (from < cells.dark) return from;
  const std::size_t bright_end = std::min(to, cells.g_source_sr.size() - cells.dark);
  std::size_t at = HWY_DYNAMIC_DISPATCH(outside)(view, cells, from, bright_end);
  const auto inside = [&](double middle, float side, double size) {
    return std::abs(middle) + double(side) / 2 < size / 2;
  };
  while (at < bright_end && inside(cells.right[at], cells.width[at], view.columns) &&
         inside(cells.down[at], cells.height[at], view.rows))
    ++at;
  return at;
}

std::size_t sampled_at_once() {
  return HWY_DYNAMIC_DISPATCH(width)();
}

}  // namespace petzval
#endif
