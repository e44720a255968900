// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/units.h>
#include <petzval/render/shapes/quadric.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval::render {

namespace {

double azimuth(Vector3 p) {
  const double phi = std::atan2(p.y, p.x);
  return phi < 0 ? phi + 2 * pi : phi;
}

/// Both roots of a t² + 2 b t + c, the smaller first, without cancellation; false if there are none.
bool roots(double a, double half_b, double c, double& first, double& second) {
  const double discriminant = half_b * half_b - a * c;
  if (!(discriminant >= 0) || a == 0) return false;
  const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
  first = q / a;
  second = q != 0 ? c / q : first;
  if (first > second) std::swap(first, second);
  return true;
}

/// By how much a transformation makes volumes larger.
double volume_scale(const Transform& transform) {
  const Matrix4& m = transform.matrix();
  const Vector3 x{m[0][0], m[1][0], m[2][0]}, y{m[0][1], m[1][1], m[2][1]}, z{m[0][2], m[1][2], m[2][2]};
  return std::abs(dot(x, cross(y, z)));
}

double positive(const Parameters& parameters, const char* name, double otherwise) {
  const double value = parameters.number(name, otherwise);
  if (!(value > 0))
    throw scene_error(parameters.location_of(name),
                      fmt::format("\"{}\" is {}; above 0 would be right", name, value));
  return value;
}

}  // namespace

bool Quadric::covers(Vector3 p) const {
  if (phi_max < 2 * pi && azimuth(p) > phi_max) return false;
  if (kind == Kind::disk) {
    const double r2 = p.x * p.x + p.y * p.y;
    return r2 <= radius * radius && r2 >= inner_radius * inner_radius;
  }
  if (kind == Kind::sphere && z_min <= -radius && z_max >= radius) return true;
  return p.z >= z_min && p.z <= z_max;
}

std::optional<double> Quadric::hit(Vector3 origin, Vector3 direction, double t_min, double t_max) const {
  double first, second;
  if (ball) {
    const Vector3 from = origin - ball->centre;
    if (!roots(dot(direction, direction), dot(from, direction), dot(from, from) - ball->radius * ball->radius,
               first, second))
      return {};
    for (const double t : {first, second})
      if (t > t_min && t < t_max) return t;
    return {};
  }
  const Vector3 o = world_from_object.inverse_point(origin),
                d = world_from_object.inverse_direction(direction);
  if (kind == Kind::disk) {
    if (d.z == 0) return {};
    first = second = (z_min - o.z) / d.z;
  } else {
    const bool sphere = kind == Kind::sphere;
    const double a = d.x * d.x + d.y * d.y + (sphere ? d.z * d.z : 0);
    const double b = o.x * d.x + o.y * d.y + (sphere ? o.z * d.z : 0);
    const double c = o.x * o.x + o.y * o.y + (sphere ? o.z * o.z : 0) - radius * radius;
    if (!roots(a, b, c, first, second)) return {};
  }
  for (const double t : {first, second})
    if (t > t_min && t < t_max && covers(o + t * d)) return t;
  return {};
}

Vector3 Quadric::object_normal(Vector3 p) const {
  if (kind == Kind::disk) return {0, 0, 1};
  if (kind == Kind::cylinder) return normalised(Vector3{p.x, p.y, 0});
  return normalised(p);
}

void Quadric::find_ball() {
  Ball found{{}, 0, {}};
  if (!is_round_sphere(found.centre, found.radius)) return;
  found.axis = normalised(world_from_object.direction({0, 0, 1}));
  if (world_from_object.swaps_handedness()) found.axis = -found.axis;
  ball = found;
}

Quadric::Point Quadric::at_ball(Vector3 world_position) const {
  Point result;
  result.normal = normalised(world_position - ball->centre);
  result.position = ball->centre + ball->radius * result.normal;
  result.along_u = phi_max * cross(ball->axis, ball->radius * result.normal);
  return result;
}

Quadric::Point Quadric::at(Vector3 world_position, bool coordinates) const {
  if (ball && !coordinates) return at_ball(world_position);
  Vector3 p = world_from_object.inverse_point(world_position);
  // Onto the surface exactly.
  if (kind == Kind::sphere && dot(p, p) > 0)
    p = radius * normalised(p);
  else if (kind == Kind::cylinder && p.x * p.x + p.y * p.y > 0) {
    const double scale = radius / std::hypot(p.x, p.y);
    p.x *= scale, p.y *= scale;
  } else if (kind == Kind::disk)
    p.z = z_min;
  Point result;
  result.position = world_from_object.point(p);
  result.normal = normalised(world_from_object.normal(object_normal(p)));
  result.along_u = world_from_object.direction({-phi_max * p.y, phi_max * p.x, 0});
  if (coordinates) set_coordinates(p, result);
  return result;
}

/// \param p  in the quadric's own space.
void Quadric::set_coordinates(Vector3 p, Point& point) const {
  point.u = azimuth(p) / phi_max;
  if (kind == Kind::sphere) {
    const auto polar = [&](double z) { return std::acos(std::clamp(z / radius, -1.0, 1.0)); };
    point.v = (polar(p.z) - polar(z_min)) / (polar(z_max) - polar(z_min));
  } else if (kind == Kind::cylinder) {
    point.v = (p.z - z_min) / (z_max - z_min);
  } else {
    point.v = (radius - std::hypot(p.x, p.y)) / (radius - inner_radius);
  }
}

Vector3 Quadric::along_v(Vector3 world_position) const {
  const Vector3 p = world_from_object.inverse_point(world_position);
  const double from_axis = std::hypot(p.x, p.y);
  if (kind == Kind::cylinder) return world_from_object.direction({0, 0, z_max - z_min});
  if (!(from_axis > 0)) return {};
  const double cos = p.x / from_axis, sin = p.y / from_axis;
  if (kind == Kind::disk) return world_from_object.direction((inner_radius - radius) * Vector3{cos, sin, 0});
  const auto polar = [&](double z) { return std::acos(std::clamp(z / radius, -1.0, 1.0)); };
  return world_from_object.direction((polar(z_max) - polar(z_min)) *
                                     Vector3{cos * p.z, sin * p.z, -from_axis});
}

std::array<Vector3, 2> Quadric::bounds() const {
  const double top = kind == Kind::disk ? z_min : z_max, infinity = std::numeric_limits<double>::infinity();
  Vector3 least{infinity, infinity, infinity}, greatest = -least;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3 p = world_from_object.point(
        {corner & 1 ? radius : -radius, corner & 2 ? radius : -radius, corner & 4 ? top : z_min});
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    greatest = {std::max(greatest.x, p.x), std::max(greatest.y, p.y), std::max(greatest.z, p.z)};
  }
  return {least, greatest};
}

double Quadric::object_area() const {
  if (kind == Kind::disk) return phi_max / 2 * (radius * radius - inner_radius * inner_radius);
  return phi_max * radius * (z_max - z_min);
}

double Quadric::area() const {
  constexpr int points = 64;  // a mean over the surface; exact when the stretch is the same everywhere
  double sum = 0;
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j)
      sum += 1 / sample((i + 0.5) / points, (j + 0.5) / points).per_area / (points * points);
  return sum;
}

Quadric::Sample Quadric::sample(double u, double v) const {
  const double phi = u * phi_max;
  Vector3 p;
  if (kind == Kind::disk) {
    const double r =
        std::sqrt(inner_radius * inner_radius + v * (radius * radius - inner_radius * inner_radius));
    p = {r * std::cos(phi), r * std::sin(phi), z_min};
  } else {
    const double z = z_min + v * (z_max - z_min);
    const double r = kind == Kind::cylinder ? radius : std::sqrt(std::max(0.0, radius * radius - z * z));
    p = {r * std::cos(phi), r * std::sin(phi), z};
  }
  const Vector3 normal = world_from_object.normal(object_normal(p));
  Sample result;
  result.point.position = world_from_object.point(p);
  result.point.normal = normalised(normal);
  result.point.along_u = world_from_object.direction({-phi_max * p.y, phi_max * p.x, 0});
  result.per_area = 1 / (object_area() * volume_scale(world_from_object) * length(normal));
  return result;
}

double Quadric::density(const Point& point) const {
  const Vector3 p = world_from_object.inverse_point(point.position);
  const double stretch = volume_scale(world_from_object) * length(world_from_object.normal(object_normal(p)));
  return 1 / (object_area() * stretch);
}

bool Quadric::is_round_sphere(Vector3& centre, double& world_radius) const {
  if (kind != Kind::sphere || z_min > -radius || z_max < radius || phi_max < 2 * pi) return false;
  const Vector3 x = world_from_object.direction({1, 0, 0}), y = world_from_object.direction({0, 1, 0}),
                z = world_from_object.direction({0, 0, 1});
  const double scale = length(x);
  constexpr double even = 1e-9;
  for (const double each :
       {length(y) - scale, length(z) - scale, dot(x, y) / scale, dot(y, z) / scale, dot(z, x) / scale})
    if (std::abs(each) > even * scale) return false;
  centre = world_from_object.point({0, 0, 0});
  world_radius = scale * radius;
  return true;
}

Quadric read_quadric(const ShapeDescription& shape, Unsupported& unsupported) {
  const Parameters& parameters = shape.entity.parameters;
  Quadric quadric;
  quadric.world_from_object = shape.world_from_object;
  if (!shape.world_from_object.is_affine())
    unsupported.report(parameters.location(), "a transformation with perspective");
  quadric.radius = positive(parameters, "radius", 1);
  quadric.phi_max = radians(positive(parameters, "phimax", 360));
  quadric.phi_max = std::min(quadric.phi_max, 2 * pi);
  if (shape.entity.type == "disk") {
    quadric.kind = Quadric::Kind::disk;
    quadric.inner_radius = parameters.number("innerradius", 0);
    quadric.z_min = quadric.z_max = parameters.number("height", 0);
    if (!(quadric.inner_radius >= 0 && quadric.inner_radius < quadric.radius))
      throw scene_error(parameters.location_of("innerradius"),
                        "\"innerradius\" must lie from 0 to below the radius");
    return quadric;
  }
  const bool sphere = shape.entity.type == "sphere";
  quadric.kind = sphere ? Quadric::Kind::sphere : Quadric::Kind::cylinder;
  double z0 = parameters.number("zmin", sphere ? -quadric.radius : -1);
  double z1 = parameters.number("zmax", sphere ? quadric.radius : 1);
  if (z0 > z1) std::swap(z0, z1);
  if (sphere) z0 = std::max(z0, -quadric.radius), z1 = std::min(z1, quadric.radius);
  if (!(z0 < z1))
    throw scene_error(parameters.location_of("zmin"),
                      "\"zmin\" must lie below \"zmax\" and inside the shape");
  quadric.z_min = z0, quadric.z_max = z1;
  quadric.find_ball();
  return quadric;
}

}  // namespace petzval::render
