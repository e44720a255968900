// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/lights/light_importance.h>

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "petzval/render/lights/light_importance.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using render::LightNodes;
using render::LightReceiver;
using D = hn::CappedTag<double, LightNodes::together>;
using V = hn::Vec<D>;

HWY_ATTR HWY_INLINE V sine(V cosine) {
  const D d;
  return hn::Sqrt(hn::Max(hn::Zero(d), hn::Sub(hn::Set(d, 1.0), hn::Mul(cosine, cosine))));
}

/// cos max(0, a − b) of angles 0 … π.
HWY_ATTR HWY_INLINE V cos_of_difference(V cos_a, V sin_b, V cos_b) {
  const D d;
  const V difference = hn::Add(hn::Mul(cos_a, cos_b), hn::Mul(sine(cos_a), sin_b));
  return hn::IfThenElse(hn::Gt(cos_a, cos_b), hn::Set(d, 1.0), difference);
}

HWY_ATTR HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
  return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

HWY_ATTR std::uint32_t importances(const LightNodes& nodes, const LightReceiver& to, double nearness,
                                   double* result) {
  const D d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
  std::uint32_t near = 0;
  for (std::size_t i = 0; i < nodes.count; i += hn::Lanes(d)) {
    const auto column = [&](LightNodes::Column which)
                            HWY_ATTR { return hn::LoadU(d, nodes.numbers + which * nodes.count + i); };
    const V x = hn::Sub(column(LightNodes::centre_x), hn::Set(d, to.position.x)),
            y = hn::Sub(column(LightNodes::centre_y), hn::Set(d, to.position.y)),
            z = hn::Sub(column(LightNodes::centre_z), hn::Set(d, to.position.z));
    const V distance2 = dot(x, y, z, x, y, z), radius2 = column(LightNodes::radius2);
    const V about =
        hn::Div(column(LightNodes::strength),
                hn::Max(hn::Add(distance2, radius2), hn::Set(d, std::numeric_limits<double>::min())));
    const auto is_near = hn::Lt(distance2, hn::Mul(hn::Set(d, nearness * nearness), radius2));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, is_near, bits);
    near |= std::uint32_t{bits[0]} << i;
    // Angles are made smaller by the one that the ball fills (equation 3).
    const V over = hn::Div(one, hn::Sqrt(distance2));
    const V sin_ball = hn::Mul(column(LightNodes::radius), over), cos_ball = sine(sin_ball);
    V light = about;
    if (!nodes.all_ways) {
      V cos_axis = hn::Neg(hn::Mul(over, dot(column(LightNodes::axis_x), column(LightNodes::axis_y),
                                             column(LightNodes::axis_z), x, y, z)));
      cos_axis = hn::IfThenElse(hn::Gt(column(LightNodes::two_sided), zero), hn::Abs(cos_axis), cos_axis);
      const V beyond =
          cos_of_difference(cos_axis, column(LightNodes::sin_spread), column(LightNodes::cos_spread));
      const V cos_out = cos_of_difference(beyond, sin_ball, cos_ball);
      const V least = hn::Max(zero, hn::Sub(column(LightNodes::cos_reach), hn::Set(d, 1e-12)));
      light = hn::IfThenElseZero(hn::Ge(cos_out, least), hn::Mul(about, hn::Max(zero, cos_out)));
    }
    if (!to.all_around) {
      V cos_normal = hn::Mul(
          over, dot(hn::Set(d, to.normal.x), hn::Set(d, to.normal.y), hn::Set(d, to.normal.z), x, y, z));
      if (to.both_sides) cos_normal = hn::Abs(cos_normal);
      const V cos_in = cos_of_difference(cos_normal, sin_ball, cos_ball);
      light = hn::IfThenElseZero(hn::Gt(cos_in, zero), hn::Mul(light, cos_in));
    }
    hn::StoreU(hn::IfThenElse(hn::Le(distance2, radius2), about, light), d, result + i);
  }
  return near;
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace petzval {
HWY_EXPORT(importances);
}
namespace petzval::render {

std::uint32_t light_importances(const LightNodes& nodes, const LightReceiver& to, double nearness,
                                double* importances) {
  return HWY_DYNAMIC_DISPATCH(petzval::importances)(nodes, to, nearness, importances);
}

}  // namespace petzval::render
#endif
