// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/trace/ray_derivatives.h>

#include <petzval/trace/surface_meet-inl.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

/// So many derivatives are carried at once: two vectors of eight.
constexpr std::size_t slopes_at_once = 16;

struct Slopes {
  std::array<double, slopes_at_once> by{};

  friend Slopes operator+(Slopes a, const Slopes& b) {
    for (std::size_t i = 0; i < slopes_at_once; ++i) a.by[i] += b.by[i];
    return a;
  }
  friend Slopes operator-(Slopes a, const Slopes& b) {
    for (std::size_t i = 0; i < slopes_at_once; ++i) a.by[i] -= b.by[i];
    return a;
  }
  friend Slopes operator*(Slopes a, double b) {
    for (double& slope : a.by) slope *= b;
    return a;
  }
  friend Slopes operator*(double a, Slopes b) { return b * a; }
  friend Slopes operator/(Slopes a, double b) { return a * (1 / b); }
};

using DualNumber = HWY_NAMESPACE::Dual<double, Slopes>;
using HWY_NAMESPACE::square_root;
using DualPoint = SurfacePoint<DualNumber>;

DualNumber fixed(double value) {
  return {value, {}};
}

struct DerivedPath {
  DualNumber x, y, z, l, m, n, opl;
};

/// The shape with the derivatives of what it is made of.
DualNumber seeded(double value, const std::span<const LensNumber> numbers, LensNumber::Kind kind,
                  std::size_t surface, int power = 0) {
  DualNumber result = fixed(value);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (numbers[i].kind == kind && numbers[i].surface == surface && numbers[i].power == power)
      result.slope.by[i] = 1;
  return result;
}

ShapeData<DualNumber> seeded_shape(const ShapeData<double>& shape, std::size_t surface,
                                   std::span<const LensNumber> numbers) {
  using Kind = LensNumber::Kind;
  const DualNumber conic = seeded(shape.conic, numbers, Kind::conic, surface);
  ShapeData<DualNumber> result{shape.form,
                               shape.added,
                               seeded(shape.curvature, numbers, Kind::curvature_per_mm, surface),
                               conic,
                               {shape.one_plus_conic, conic.slope},
                               {},
                               fixed(shape.per_unit)};
  const bool powers = shape.form != ShapeForm::added;
  for (const double term : shape.terms) {
    const int power = static_cast<int>(result.terms.size());
    result.terms.push_back(powers ? seeded(term, numbers, Kind::power, surface, power) : fixed(term));
  }
  // Powers that the surface does not have yet.
  for (std::size_t i = 0; powers && i < numbers.size(); ++i) {
    if (numbers[i].kind != Kind::power || numbers[i].surface != surface) continue;
    result.form = ShapeForm::powers;
    while (result.terms.size() <= static_cast<std::size_t>(numbers[i].power))
      result.terms.push_back(seeded(0, numbers, Kind::power, surface, static_cast<int>(result.terms.size())));
  }
  return result;
}

template <class... Kind>
DualPoint added_point(HWY_NAMESPACE::KindList<Kind...>, const ShapeData<DualNumber>& shape,
                      const DualNumber& x, const DualNumber& y) {
  DualPoint point{};
  std::size_t i = 0;
  ((shape.added == i++ ? void(point = Kind::at(shape, x, y)) : void()), ...);
  return point;
}

DualPoint point_at(const ShapeData<DualNumber>& shape, const DualNumber& x, const DualNumber& y) {
  if (shape.form == ShapeForm::added) return added_point(HWY_NAMESPACE::AddedKinds(), shape, x, y);
  if (shape.form >= ShapeForm::powers) return HWY_NAMESPACE::Powers<false>::at(shape, x, y);
  return HWY_NAMESPACE::Conic::at(shape, x, y);
}

/// To the surface, a signed distance `way_mm` on. From there one more step of Newton's, in dual numbers,
/// moves nothing and has the derivatives of the implicit function.
DualPoint meet_derived(const ShapeData<DualNumber>& shape, double way_mm, double index, DerivedPath& path) {
  const auto advance = [&](const DualNumber& way) {
    path.x = path.x + way * path.l;
    path.y = path.y + way * path.m;
    path.z = path.z + way * path.n;
    path.opl = path.opl + fixed(index) * way;
  };
  advance(fixed(way_mm));
  DualPoint point = point_at(shape, path.x, path.y);
  const DualNumber slope = path.n - path.l * point.slope_x - path.m * point.slope_y;
  advance((point.sag - path.z) / slope);
  return point_at(shape, path.x, path.y);
}

/// \param sense  −1: the light runs towards −z.
void refract_derived(double sense, double ratio, const DualPoint& at, DerivedPath& path) {
  if (ratio == 1) return;
  const DualNumber scale =
      fixed(sense) / square_root(at.slope_x * at.slope_x + at.slope_y * at.slope_y + fixed(1));
  const DualNumber nx = fixed(-1) * at.slope_x * scale, ny = fixed(-1) * at.slope_y * scale;
  const DualNumber cosine = path.l * nx + path.m * ny + path.n * scale, e = fixed(ratio);
  const DualNumber bend = square_root(fixed(1) - e * e * (fixed(1) - cosine * cosine)) - e * cosine;
  path.l = e * path.l + bend * nx;
  path.m = e * path.m + bend * ny;
  path.n = e * path.n + bend * scale;
}

void reflect_derived(const DualPoint& at, DerivedPath& path) {
  const DualNumber square = at.slope_x * at.slope_x + at.slope_y * at.slope_y + fixed(1);
  const DualNumber twice = fixed(2) * (path.n - path.l * at.slope_x - path.m * at.slope_y) / square;
  path.l = path.l + twice * at.slope_x;
  path.m = path.m + twice * at.slope_y;
  path.n = path.n - twice;
}

/// At most `slopes_at_once` numbers. \param met  where the ray meets the surfaces, from the tracer.
DerivedPath derived(const Tracer& tracer, const Ray& ray, const std::vector<Intersection>& met,
                    std::span<const LensNumber> numbers) {
  DerivedPath path{
      fixed(ray.point_mm[0]),  fixed(ray.point_mm[1]),  fixed(ray.point_mm[2] - tracer.vertex_z_mm(0)),
      fixed(ray.direction[0]), fixed(ray.direction[1]), fixed(ray.direction[2]),
      fixed(ray.opl_mm)};
  const std::size_t count = tracer.surface_count();
  for (std::size_t i = 0; i < count; ++i) {
    const Tracer::PreparedSurface& surface = tracer.surfaces()[i];
    const double way = (met[i].point_mm[2] - surface.vertex_z_mm - path.z.value) / path.n.value;
    const DualPoint at =
        meet_derived(seeded_shape(surface.shape, i, numbers), way, surface.index_before, path);
    if (surface.mirror)
      reflect_derived(at, path);
    else
      refract_derived(surface.sense, surface.index_before / surface.index_after, at, path);
    const double next = i + 1 < count ? tracer.vertex_z_mm(i + 1) : tracer.image_z_mm();
    path.z = path.z - seeded(next - surface.vertex_z_mm, numbers, LensNumber::Kind::thickness_mm, i);
  }
  const DualNumber way = fixed(-1) * path.z / path.n;
  path.x = path.x + way * path.l;
  path.y = path.y + way * path.m;
  path.opl = path.opl + fixed(tracer.image_index()) * way;
  return path;
}

void check_number(const Lens& lens, const LensNumber& number) {
  if (number.surface >= lens.surfaces.size())
    throw InputError(
        fmt::format("surfaces[{}]: the lens has surfaces 0 to {}", number.surface, lens.surfaces.size() - 1));
  if (number.kind == LensNumber::Kind::power && (number.power < 2 || number.power > 30))
    throw InputError(fmt::format("a power of {}; 2 to 30 would be right", number.power));
}

}  // namespace

double value_of(const Lens& lens, const LensNumber& number) {
  check_number(lens, number);
  const Surface& surface = lens.surfaces[number.surface];
  switch (number.kind) {
    case LensNumber::Kind::curvature_per_mm:
      return surface.curvature_per_mm;
    case LensNumber::Kind::thickness_mm:
      return surface.thickness_mm;
    case LensNumber::Kind::conic:
      return surface.conic;
    case LensNumber::Kind::power:
      break;
  }
  const auto term = surface.asphere.find(number.power);
  return term == surface.asphere.end() ? 0 : term->second;
}

Lens with_value(Lens lens, const LensNumber& number, double value) {
  check_number(lens, number);
  Surface& surface = lens.surfaces[number.surface];
  switch (number.kind) {
    case LensNumber::Kind::curvature_per_mm:
      surface.curvature_per_mm = value;
      break;
    case LensNumber::Kind::thickness_mm:
      surface.thickness_mm = value;
      break;
    case LensNumber::Kind::conic:
      surface.conic = value;
      break;
    case LensNumber::Kind::power:
      surface.asphere[number.power] = value;
  }
  return lens;
}

std::optional<DerivedRay> trace_derived(const Tracer& tracer, const Ray& ray,
                                        std::span<const LensNumber> numbers) {
  if (!tracer.is_centred() || tracer.sensor_posed())
    throw InputError("derivatives of rays are those of centred lenses; a lens without poses would be right");
  for (const Tracer::PreparedSurface& surface : tracer.surfaces()) {
    if (surface.bend)
      throw InputError(
          "derivatives of rays are those of surfaces that refract or reflect; set ideal_lens=null");
    if (surface.transfer)
      throw InputError("derivatives of rays are those of surfaces, and a ray transfer has none");
  }
  std::vector<Intersection> met;
  DerivedRay result{tracer.trace(ray, Tracer::Clip::none, &met), {}};
  if (result.ray.status != RayStatus::ok) return {};
  for (std::size_t first = 0; first < numbers.size(); first += slopes_at_once) {
    const auto some = numbers.subspan(first, std::min(slopes_at_once, numbers.size() - first));
    const DerivedPath path = derived(tracer, ray, met, some);
    for (std::size_t i = 0; i < some.size(); ++i)
      result.by.push_back({path.x.slope.by[i], path.y.slope.by[i], path.l.slope.by[i], path.m.slope.by[i],
                           path.opl.slope.by[i]});
  }
  return result;
}

}  // namespace petzval
