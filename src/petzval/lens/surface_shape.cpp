// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/lens/surface_kind.h>
#include <petzval/lens/surface_shape.h>

#include <petzval/lens/shapes/added_kinds-inl.h>
#include <petzval/lens/shapes/powers-inl.h>

#include <cmath>
#include <limits>

namespace petzval {

namespace {

using HWY_NAMESPACE::AddedKinds;
using HWY_NAMESPACE::Conic;
using HWY_NAMESPACE::Dual;
using HWY_NAMESPACE::KindList;
using HWY_NAMESPACE::Powers;

template <class V, class... Kind>
SurfacePoint<V> point_of_added(KindList<Kind...>, const ShapeData<double>& shape, V x, V y) {
  SurfacePoint<V> point{x, x, y};
  [[maybe_unused]] std::size_t i = 0;
  ((shape.added == i++ ? void(point = Kind::at(shape, x, y)) : void()), ...);
  return point;
}

template <class V>
SurfacePoint<V> point_of(const ShapeData<double>& shape, V x, V y) {
  switch (shape.form) {
    case ShapeForm::powers:
      return Powers<false>::at(shape, x, y);
    case ShapeForm::even_powers:
      return Powers<true>::at(shape, x, y);
    case ShapeForm::added:
      return point_of_added(AddedKinds(), shape, x, y);
    default:
      return Conic::at(shape, x, y);
  }
}

void set_powers(const std::map<int, double>& powers, ShapeData<double>& shape) {
  for (const auto& [power, coefficient] : powers) {
    if (coefficient == 0) continue;
    const auto p = static_cast<std::size_t>(power);
    if (shape.terms.size() <= p) shape.terms.resize(p + 1, 0.0);
    shape.terms[p] = coefficient;
    shape.form = ShapeForm::powers;
  }
}

/// x at 0, as a variable of every order of derivative that T has.
template <class T>
T variable(double value) {
  if constexpr (std::is_floating_point_v<T>)
    return value;
  else
    return {variable<decltype(T::value)>(value), HWY_NAMESPACE::constant<decltype(T::value)>(1)};
}

}  // namespace

ShapeData<double> shape_of(const Surface& surface) {
  ShapeData<double> shape;
  shape.curvature = surface.curvature_per_mm;
  shape.conic = surface.conic;
  shape.one_plus_conic = 1 + surface.conic;
  if (surface.curvature_per_mm != 0) shape.form = surface.conic == 0 ? ShapeForm::sphere : ShapeForm::conic;
  set_powers(surface.asphere, shape);
  if (!surface.shape) return shape;
  const SurfaceKind& kind = surface_kind(surface.shape->kind);
  shape.form = ShapeForm::added;
  shape.added = static_cast<std::size_t>(&kind - surface_kinds().data());
  shape.terms = kind.prepare(surface);
  return shape;
}

SurfacePoint<double> surface_point(const ShapeData<double>& shape, double x_mm, double y_mm) {
  return point_of(shape, x_mm, y_mm);
}

double rim_mm(const ShapeData<double>& shape) {
  const double squared = shape.one_plus_conic * shape.curvature * shape.curvature;
  return squared > 0 ? 1 / std::sqrt(squared) : std::numeric_limits<double>::infinity();
}

bool is_flat(const Surface& surface) {
  return surface.curvature_per_mm == 0 && surface.asphere.empty() && !surface.shape;
}

bool is_spherical(const Surface& surface) {
  return surface.conic == 0 && surface.asphere.empty() && !surface.shape;
}

PrincipalCurvatures principal_curvatures(const ShapeData<double>& shape, double r_mm) {
  double slope, bend;
  if (shape.form == ShapeForm::added) {
    using V = Dual<double>;
    const V slope_x = point_of(shape, variable<V>(r_mm), V{0, 0}).slope_x;
    slope = slope_x.value, bend = slope_x.slope;
  } else {
    const double c = shape.curvature, square = 1 - shape.one_plus_conic * c * c * r_mm * r_mm;
    slope = c * r_mm / std::sqrt(square), bend = c / std::pow(square, 1.5);
    for (std::size_t p = 1; p < shape.terms.size(); ++p) {
      const double power = static_cast<double>(p), a = shape.terms[p];
      if (a == 0) continue;
      slope += a * power * std::pow(r_mm, power - 1);
      if (p > 1) bend += a * power * (power - 1) * std::pow(r_mm, power - 2);
    }
  }
  const double length = std::sqrt(1 + slope * slope);
  // On the axis both are the same; a cone (p = 1) has no curvature there to speak of.
  if (r_mm == 0) return {bend, bend};
  return {bend / (length * length * length), slope / (r_mm * length)};
}

VertexSeries vertex_series(const Surface& surface) {
  if (surface.shape) {
    using V = Dual<Dual<Dual<double>>>;
    const V at = variable<V>(0), axis = HWY_NAMESPACE::constant<V>(0);
    const bool round = surface_kind(surface.shape->kind).is_round;
    const V slope =
        round ? point_of(shape_of(surface), at, axis).slope_x : point_of(shape_of(surface), axis, at).slope_y;
    return {slope.value.value.slope, slope.slope.slope.slope / 3};
  }
  const auto coefficient = [&](int power) {
    const auto term = surface.asphere.find(power);
    return term == surface.asphere.end() ? 0.0 : term->second;
  };
  return {surface.curvature_per_mm + 2 * coefficient(2),
          (1 + surface.conic) * std::pow(surface.curvature_per_mm, 3) + 8 * coefficient(4)};
}

double vertex_curvature_per_mm(const Surface& surface) {
  return vertex_series(surface).curvature_per_mm;
}

Surface scaled_surface(Surface surface, double factor) {
  surface.curvature_per_mm /= factor;
  surface.thickness_mm *= factor;
  if (surface.semi_diameter_mm) *surface.semi_diameter_mm *= factor;
  if (surface.ideal_lens) surface.ideal_lens->focal_length_mm *= factor;
  for (ApertureFigure& aperture : surface.apertures)
    for (double* length : {&aperture.half_width_x_mm, &aperture.half_width_y_mm, &aperture.decentre_x_mm,
                           &aperture.decentre_y_mm})
      *length *= factor;
  for (auto& [power, coefficient] : surface.asphere) coefficient *= std::pow(factor, 1 - power);
  if (!surface.shape) return surface;
  for (const ShapeParameter& parameter : surface_kind(surface.shape->kind).parameters)
    if (const auto found = surface.shape->parameters.find(parameter.name);
        found != surface.shape->parameters.end())
      for (double& number : found->second) number *= std::pow(factor, parameter.length_power);
  return surface;
}

std::vector<std::string> shape_remarks(const Surface& surface) {
  if (surface.transfer) return {"ray transfer to the next"};
  std::vector<std::string> remarks;
  if (surface.conic != 0) remarks.push_back(fmt::format("conic {:g}", surface.conic));
  for (const auto& [power, coefficient] : surface.asphere)
    remarks.push_back(fmt::format("r^{} {:g}", power, coefficient));
  if (const std::string bend = bend_remark(surface); !bend.empty()) remarks.push_back(bend);
  if (!surface.shape) return remarks;
  std::string added = surface.shape->kind;
  for (const auto& [name, numbers] : surface.shape->parameters)
    added += fmt::format(", {} {:g}", name, fmt::join(numbers, " "));
  remarks.push_back(added);
  return remarks;
}

}  // namespace petzval
