// SPDX-License-Identifier: BSD-3-Clause
// Rays through a ray transfer: one text for single rays and for vectors of them. Included once per
// instruction set.
#if defined(PETZVAL_LENS_TRANSFER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_LENS_TRANSFER_INL_H_
#undef PETZVAL_LENS_TRANSFER_INL_H_
#else
#define PETZVAL_LENS_TRANSFER_INL_H_
#endif

#include <petzval/lens/shapes/numbers-inl.h>
#include <petzval/lens/transfer_data.h>
#include <petzval/lens/transfer_limits.h>

#include <cstddef>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

/// A ray on a plane: place, and direction cosines of travel against the light.
template <class V>
struct PlaneRay {
  V x, y, l, m;
};

/// Where a ray of the rear plane goes: the front plane, the stop, and (r/R)² at the worst of the other
/// apertures.
template <class V>
struct CarriedRay {
  PlaneRay<V> front;
  V stop_x, stop_y, others_sq;
};

/// Of the 16 of most processors, some are for terms and coefficients.
constexpr std::size_t most_sums_in_registers = 10;

/// The three variables of a ray, and the turn that made them.
template <class V>
struct TransferArguments {
  V of[3];
  V sine, cosine;  ///< of the place's azimuth from +y towards +x; of turned variables
};

template <class V>
HWY_INLINE TransferArguments<V> turned_arguments(const PlaneRay<V>& ray) {
  TransferArguments<V> result;
  const V r = square_root(mul_add(ray.x, ray.x, ray.y * ray.y)), tiny = constant<V>(1e-30);
  const auto on_axis = is_below(r, tiny);
  const V per_r = constant<V>(1) / at_least(r, tiny);
  result.sine = choose(on_axis, constant<V>(0), ray.x * per_r);
  result.cosine = choose(on_axis, constant<V>(1), ray.y * per_r);
  result.of[0] = r;
  result.of[1] = neg_mul_add(ray.m, result.sine, ray.l * result.cosine);
  result.of[2] = mul_add(ray.l, result.sine, ray.m * result.cosine);
  return result;
}

template <class V, class T>
HWY_INLINE TransferArguments<V> arguments_of(const TransferPolynomials<T>& p, const PlaneRay<V>& ray) {
  if (p.variables == TransferVariables::turned) return turned_arguments(ray);
  TransferArguments<V> result;
  const V unit = constant<V>(static_cast<double>(p.per_unit));
  result.of[0] = mul_add(ray.x, ray.x, ray.y * ray.y) * unit * unit;
  result.of[1] = mul_add(ray.x, ray.l, ray.y * ray.m) * unit;
  result.of[2] = mul_add(ray.l, ray.l, ray.m * ray.m);
  result.sine = result.cosine = constant<V>(0);
  return result;
}

/// Outputs from `first` on, whose sums stay in registers. \param next  makes or finds a term.
template <std::size_t first, std::size_t... output, class V, class T, class Next>
HWY_INLINE void sum_terms(const TransferPolynomials<T>& p, const Next& next, V* out,
                          std::index_sequence<output...>) {
  const T* row = p.coefficients.data() + first;
  V sum[] = {constant<V>(static_cast<double>(row[output]))...};
  for (std::size_t k = 1; k < p.steps.size(); ++k) {
    row += p.outputs;
    const V term = next(k);
    ((sum[output] = mul_add(constant<V>(static_cast<double>(row[output])), term, sum[output])), ...);
  }
  ((out[first + output] = sum[output]), ...);
}

template <std::size_t outputs, class V, class T>
HWY_INLINE void evaluate_terms(const TransferPolynomials<T>& p, const TransferArguments<V>& arguments,
                               V (&out)[outputs]) {
  V term[most_transfer_terms];
  term[0] = constant<V>(1);
  const auto made = [&](std::size_t k) HWY_ATTR {
    return term[k] = term[p.steps[k].from] * arguments.of[p.steps[k].variable];
  };
  const auto found = [&](std::size_t k) HWY_ATTR { return term[k]; };
  constexpr std::size_t at_once = outputs <= most_sums_in_registers ? outputs : outputs / 2;
  static_assert(outputs - at_once <= most_sums_in_registers);
  sum_terms<0>(p, made, out, std::make_index_sequence<at_once>());
  if constexpr (outputs > at_once)
    sum_terms<at_once>(p, found, out, std::make_index_sequence<outputs - at_once>());
}

/// From outputs to a place and a direction, in the axes of the lens.
template <class V, class T>
HWY_INLINE PlaneRay<V> combined(const TransferPolynomials<T>& p, const TransferArguments<V>& arguments,
                                const PlaneRay<V>& ray, const V* out) {
  if (p.variables == TransferVariables::invariants)
    return {mul_add(ray.x, out[0], ray.l * out[1]), mul_add(ray.y, out[0], ray.m * out[1]),
            mul_add(ray.x, out[2], ray.l * out[3]), mul_add(ray.y, out[2], ray.m * out[3])};
  const V s = arguments.sine, c = arguments.cosine;
  return {mul_add(out[0], c, out[1] * s), neg_mul_add(out[0], s, out[1] * c), mul_add(out[2], c, out[3] * s),
          neg_mul_add(out[2], s, out[3] * c)};
}

template <class V, class T>
HWY_INLINE V looked_up(const std::vector<T>& table, V whole) {
  if constexpr (std::is_floating_point_v<V>) {
    return static_cast<V>(table[static_cast<std::size_t>(whole)]);
  } else {
    const hn::DFromV<V> d;
    return hn::GatherIndex(d, table.data(), hn::ConvertTo(hn::RebindToSigned<hn::DFromV<V>>(), whole));
  }
}
template <class V>
HWY_INLINE V whole_part(V a) {
  if constexpr (std::is_floating_point_v<V>)
    return std::floor(a);
  else
    return hn::Floor(a);
}
template <class V>
HWY_INLINE V at_most(V a, V ceiling) {
  if constexpr (std::is_floating_point_v<V>)
    return a < ceiling ? a : ceiling;
  else
    return hn::Min(a, ceiling);
}

/// The stop's coordinates of ellipses: turned to the place, and back.
template <class V, class T>
HWY_INLINE void meet_ellipse(const TransferData<T>& data, const PlaneRay<V>& ray, V& stop_x, V& stop_y) {
  const TransferEllipses<T>& e = data.ellipses;
  const TransferArguments<V> at = turned_arguments(ray);
  const V r = at.of[0], one = constant<V>(1);
  // Beyond the last knot, and of no number at all, the last interval goes on.
  const V last = constant<V>(static_cast<double>(e.radius_x.size() - 2));
  const V knots = r * constant<V>(static_cast<double>(e.per_step));
  const V below = at_least(at_most(whole_part(knots), last), constant<V>(0));
  const V share = knots - below, above = below + one;
  const auto between = [&](const std::vector<T>& table) HWY_ATTR {
    const V from = looked_up<V>(table, below);
    return mul_add(share, looked_up<V>(table, above) - from, from);
  };
  const V least = constant<V>(1e-9), radius = constant<V>(static_cast<double>(data.stop_radius));
  const V cosine = square_root(one - mul_add(ray.l, ray.l, ray.m * ray.m));
  const V along = constant<V>(static_cast<double>(e.plane_mm)) / cosine;
  const V x = along * at.of[1] * radius / at_least(between(e.radius_x), least);
  const V y =
      (mul_add(along, at.of[2], r) - between(e.centre_y)) * radius / at_least(between(e.radius_y), least);
  stop_x = mul_add(x, at.cosine, y * at.sine);
  stop_y = neg_mul_add(x, at.sine, y * at.cosine);
}

template <std::size_t apertures, class V, class T>
HWY_INLINE CarriedRay<V> carry_with(const TransferData<T>& data, const PlaneRay<V>& ray) {
  const TransferArguments<V> arguments = arguments_of(data.back, ray);
  V out[4 + 2 * apertures];
  evaluate_terms(data.back, arguments, out);
  CarriedRay<V> result;
  result.front = combined(data.back, arguments, ray, out);
  result.others_sq = constant<V>(0);
  if constexpr (apertures == 0) {
    meet_ellipse(data, ray, result.stop_x, result.stop_y);
  } else {
    const auto place_x = [&](std::size_t i)
                             HWY_ATTR { return mul_add(ray.x, out[4 + 2 * i], ray.l * out[5 + 2 * i]); };
    const auto place_y = [&](std::size_t i)
                             HWY_ATTR { return mul_add(ray.y, out[4 + 2 * i], ray.m * out[5 + 2 * i]); };
    result.stop_x = place_x(0);
    result.stop_y = place_y(0);
    for (std::size_t i = 1; i < apertures; ++i) {
      const V x = place_x(i), y = place_y(i);
      const V per_sq = constant<V>(1 / static_cast<double>(data.other_radii_sq[i - 1]));
      result.others_sq = at_least(mul_add(x, x, y * y) * per_sq, result.others_sq);
    }
  }
  return result;
}

/// From the rear plane to the front plane.
template <class V, class T>
HWY_INLINE CarriedRay<V> carry_back(const TransferData<T>& data, const PlaneRay<V>& ray) {
  switch (data.back.outputs) {
    case 4:
      return carry_with<0>(data, ray);
    case 8:
      return carry_with<2>(data, ray);
    default:
      return carry_with<7>(data, ray);
  }
}

/// The ray of the rear plane that goes to a ray in front, with what it meets. The target is moved by what the
/// start misses until that lands on it: the map and its start undo each other nearly, so each turn gains
/// digits. \returns by how much the last one still missed, relative to what polynomials that jump leave open.
template <class V, class T>
HWY_INLINE V carry_forth(const TransferData<T>& data, const PlaneRay<V>& front, PlaneRay<V>& rear,
                         CarriedRay<V>& carried) {
  const double least = std::is_same_v<T, float> ? 2e-6 : 1e-13;
  const double least_mm = least * (1 + static_cast<double>(data.length_mm));
  const V close_mm = constant<V>(1 / least_mm), close = constant<V>(1 / least);
  const V per_mm = constant<V>(1 / (static_cast<double>(data.jump_mm) + least_mm));
  const V per_one = constant<V>(1 / (static_cast<double>(data.jump) + least));
  PlaneRay<V> target = front;
  V miss = constant<V>(0);
  for (int turn = 0; turn < most_transfer_turns; ++turn) {
    const TransferArguments<V> arguments = arguments_of(data.start, target);
    V out[4];
    evaluate_terms(data.start, arguments, out);
    rear = combined(data.start, arguments, target, out);
    carried = carry_back(data, rear);
    const V x = carried.front.x - front.x, y = carried.front.y - front.y;
    const V l = carried.front.l - front.l, m = carried.front.m - front.m;
    const V place = at_least(magnitude(x), magnitude(y)), slope = at_least(magnitude(l), magnitude(m));
    miss = at_least(place * per_mm, slope * per_one);
    const V left = at_least(place * close_mm, slope * close);
    if constexpr (std::is_floating_point_v<V>) {
      if (!(left > 1)) break;
    } else {
      if (hn::AllFalse(hn::DFromV<V>(), hn::Gt(left, constant<V>(1)))) break;
    }
    target = {target.x - x, target.y - y, target.l - l, target.m - m};
  }
  return miss;
}

/// The optical path of a ray from front plane to rear plane [mm], that along the axis being the length,
/// integrated over rays (tq, tp) of the rear plane, 0 ≤ t ≤ 1: dV = p_rear·dq_rear − p_front·dq_front of a
/// point characteristic V (Hamilton; Born & Wolf 4.1). Parts of one degree n in t are t^n times a number
/// each, so the integral is a sum.
template <class V, class T>
HWY_INLINE V path_from_axis(const TransferData<T>& data, const PlaneRay<V>& ray) {
  const TransferPolynomials<T>& p = data.back;
  const TransferArguments<V> arguments = arguments_of(p, ray);
  V term[most_transfer_terms];
  PlaneRay<V> part[most_transfer_degree + 1];
  int degrees[most_transfer_degree + 1];
  std::size_t parts = 0;
  const T* row = p.coefficients.data();
  const V zero = constant<V>(0);
  for (std::size_t k = 0; k < p.steps.size();) {
    V out[4] = {zero, zero, zero, zero};
    const int degree = p.steps[k].degree;
    for (; k < p.steps.size() && p.steps[k].degree == degree; ++k, row += p.outputs) {
      term[k] = k == 0 ? constant<V>(1) : term[p.steps[k].from] * arguments.of[p.steps[k].variable];
      for (std::size_t o = 0; o < 4; ++o)
        out[o] = mul_add(constant<V>(static_cast<double>(row[o])), term[k], out[o]);
    }
    part[parts] = combined(p, arguments, ray, out);
    degrees[parts++] = degree;
  }
  V path = neg_mul_add(constant<V>(0.5), mul_add(ray.x, ray.l, ray.y * ray.m),
                       constant<V>(static_cast<double>(data.length_mm)));
  for (std::size_t q = 0; q < parts; ++q) {
    if (degrees[q] == 0) continue;
    for (std::size_t n = 0; n < parts; ++n)
      path = mul_add(constant<V>(static_cast<double>(degrees[q]) / (degrees[q] + degrees[n])),
                     mul_add(part[n].l, part[q].x, part[n].m * part[q].y), path);
  }
  return path;
}

/// The optical path of a ray: from the axis to the middle of the light that comes in with its direction, and
/// from there straight across the pupil. Ways differ where polynomials break étendue; on this one the waves
/// of an object far away have the slopes of its rays, whatever the polynomials are worth elsewhere.
template <class V, class T>
HWY_INLINE V transfer_path(const TransferData<T>& data, const PlaneRay<V>& front, const PlaneRay<V>& ray) {
  const V square = mul_add(front.l, front.l, front.m * front.m);
  V place = constant<V>(0);
  for (std::size_t k = data.centre.size(); k-- > 0;)
    place = mul_add(place, square, constant<V>(static_cast<double>(data.centre[k])));
  const PlaneRay<V> middle{front.l * place, front.m * place, front.l, front.m};
  V out[4];
  const TransferArguments<V> arguments = arguments_of(data.start, middle);
  evaluate_terms(data.start, arguments, out);
  const PlaneRay<V> base = combined(data.start, arguments, middle, out);
  const PlaneRay<V> way{ray.x - base.x, ray.y - base.y, ray.l - base.l, ray.m - base.m};
  PlaneRay<V> at[transfer_path_nodes];
  for (std::size_t i = 0; i < transfer_path_nodes; ++i) {
    const V t = constant<V>(static_cast<double>(data.path_at[i]));
    const PlaneRay<V> rear{mul_add(t, way.x, base.x), mul_add(t, way.y, base.y), mul_add(t, way.l, base.l),
                           mul_add(t, way.m, base.m)};
    const TransferArguments<V> of = arguments_of(data.back, rear);
    evaluate_terms(data.back, of, out);
    at[i] = combined(data.back, of, rear, out);
  }
  const V half = constant<V>(-0.5);
  V path = half * mul_add(base.l + ray.l, way.x, (base.m + ray.m) * way.y) + path_from_axis(data, base);
  for (std::size_t i = 0; i < transfer_path_nodes; ++i)
    for (std::size_t k = 0; k < transfer_path_nodes; ++k)
      path = mul_add(constant<V>(static_cast<double>(data.path_weights[i * transfer_path_nodes + k])),
                     mul_add(at[i].l, at[k].x, at[i].m * at[k].y), path);
  return path;
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_LENS_TRANSFER_INL_H_
