// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/shapes/curve_segments.h>

#include <cmath>
#include <limits>

namespace petzval::render {

namespace {

using Cubic = std::array<Vector3, 4>;

Vector3 between(Vector3 a, Vector3 b, double share) {
  return (1 - share) * a + share * b;
}

/// The cubic that a quadratic Bézier curve is.
Cubic elevated(Vector3 a, Vector3 b, Vector3 c) {
  return {a, between(a, b, 2.0 / 3), between(c, b, 2.0 / 3), c};
}

/// Bézier points of the piece of a uniform B-spline that some of its points rule (Farin, Curves and Surfaces
/// for CAGD, 5th ed. 2002, ch. 8).
Cubic from_spline(const Vector3* p, int degree) {
  if (degree == 2) return elevated(between(p[0], p[1], 0.5), p[1], between(p[1], p[2], 0.5));
  const Vector3 before = between(p[0], p[1], 2.0 / 3), first = between(p[1], p[2], 1.0 / 3),
                second = between(p[1], p[2], 2.0 / 3), after = between(p[2], p[3], 1.0 / 3);
  return {between(before, first, 0.5), first, second, between(second, after, 0.5)};
}

std::vector<Cubic> bezier_pieces(const std::vector<Vector3>& points, int degree, bool spline,
                                 const Parameters& parameters) {
  const auto order = static_cast<std::size_t>(degree);
  const std::size_t step = spline ? 1 : order;
  if (points.size() < order + 1 || (points.size() - 1) % step != 0)
    throw scene_error(parameters.location_of("P"),
                      fmt::format("a {} curve of degree {} through {} points; {} would be right",
                                  spline ? "bspline" : "bezier", degree, points.size(),
                                  spline ? fmt::format("{} or more", degree + 1)
                                         : fmt::format("{0} + 1, 2 · {0} + 1 and so on", degree)));
  std::vector<Cubic> result;
  for (std::size_t i = 0; i + order < points.size(); i += step) {
    const Vector3* p = &points[i];
    if (spline)
      result.push_back(from_spline(p, degree));
    else
      result.push_back(degree == 2 ? elevated(p[0], p[1], p[2]) : Cubic{p[0], p[1], p[2], p[3]});
  }
  return result;
}

/// By which a transformation makes everything larger.
double even_scale(const ShapeDescription& shape, Unsupported& unsupported) {
  const Vector3 x = shape.world_from_object.direction({1, 0, 0}),
                y = shape.world_from_object.direction({0, 1, 0}),
                z = shape.world_from_object.direction({0, 0, 1});
  const double scale = length(x);
  constexpr double even = 1e-6;
  for (const double off :
       {length(y) - scale, length(z) - scale, dot(x, y) / scale, dot(y, z) / scale, dot(z, x) / scale})
    if (std::abs(off) > even * scale) {
      unsupported.report(shape.entity.location(), "a curve that is stretched in one direction only");
      break;
    }
  return scale;
}

std::vector<Vector3> world_points(const ShapeDescription& shape) {
  const Parameters& parameters = shape.entity.parameters;
  const std::vector<double> numbers = parameters.numbers("P", {"point3", "point"});
  if (numbers.empty() || numbers.size() % 3 != 0)
    throw scene_error(parameters.location_of("P"), "a curve needs \"point3 P\", three numbers a point");
  std::vector<Vector3> points;
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    const Vector3 p = shape.world_from_object.point({numbers[i], numbers[i + 1], numbers[i + 2]});
    constexpr double farthest = std::numeric_limits<float>::max() / 16;
    if (!(std::abs(p.x) < farthest && std::abs(p.y) < farthest && std::abs(p.z) < farthest))
      throw scene_error(parameters.location_of("P"), "a point of this curve is not finite");
    points.push_back(p);
  }
  return points;
}

/// One where each segment begins, and one at the end.
std::vector<Vector3> world_normals(const ShapeDescription& shape, std::size_t count) {
  const Parameters& parameters = shape.entity.parameters;
  const std::vector<double> numbers = parameters.numbers("N", {"normal", "normal3"});
  if (numbers.size() != 3 * count)
    throw scene_error(
        parameters.location_of("N"),
        fmt::format("a ribbon with {} numbers in \"normal N\"; three for each of its {} ends of segments "
                    "would be right",
                    numbers.size(), count));
  std::vector<Vector3> normals;
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    const Vector3 n =
        normalised(shape.world_from_object.normal({numbers[i], numbers[i + 1], numbers[i + 2]}));
    if (!(dot(n, n) > 0.5)) throw scene_error(parameters.location_of("N"), "a normal has no length");
    if (!normals.empty() && dot(normals.back(), n) < -1 + 1e-9)
      throw scene_error(parameters.location_of("N"),
                        "two normals of a segment point opposite ways, so that it might turn either way");
    normals.push_back(n);
  }
  return normals;
}

double width_of(const Parameters& parameters, const char* name, double otherwise) {
  const double width = parameters.number(name, otherwise);
  if (!(width >= 0 && width < std::numeric_limits<float>::max() / 16))
    throw scene_error(parameters.location_of(name),
                      fmt::format("a curve {} wide; 0 or more would be right", width));
  return width;
}

}  // namespace

CurveSegments::Place CurveSegments::at(std::size_t segment, double t) const {
  const ControlPoint* c = &points[4 * segment];
  const double s = 1 - t;
  const double weight[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
  const double slope[4] = {-3 * s * s, 3 * s * (s - 2 * t), 3 * t * (2 * s - t), 3 * t * t};
  Place place;
  for (int i = 0; i < 4; ++i) {
    const Vector3 p{c[i][0], c[i][1], c[i][2]};
    place.centre = place.centre + weight[i] * p;
    place.tangent = place.tangent + slope[i] * p;
    place.radius += weight[i] * static_cast<double>(c[i][3]);
  }
  // Where control points fall together there is still a way from one end to the other.
  if (!(dot(place.tangent, place.tangent) > 0))
    place.tangent = Vector3{c[3][0], c[3][1], c[3][2]} - Vector3{c[0][0], c[0][1], c[0][2]};
  return place;
}

CurveSegments read_curve(const ShapeDescription& shape, Unsupported& unsupported) {
  const Parameters& parameters = shape.entity.parameters;
  CurveSegments curve;
  const std::string type = parameters.string("type", "flat");
  if (type == "cylinder")
    curve.kind = CurveSegments::Kind::cylinder;
  else if (type == "ribbon")
    curve.kind = CurveSegments::Kind::ribbon;
  else if (type != "flat")
    unsupported.report(parameters.location_of("type"), fmt::format("a curve of type \"{}\"", type));
  const bool spline = parameters.choice("basis", "bezier", {"bezier", "bspline"}) == "bspline";
  const int degree = parameters.integer("degree", 3);
  if (degree != 2 && degree != 3)
    throw scene_error(parameters.location_of("degree"),
                      fmt::format("a curve of degree {}; 2 or 3 would be right", degree));
  const double width = width_of(parameters, "width", 1);
  const double begin = width_of(parameters, "width0", width), end = width_of(parameters, "width1", width);
  parameters.number("splitdepth", 3);  // how pbrt divides it
  const double scale = even_scale(shape, unsupported);
  const std::vector<Cubic> cubics = bezier_pieces(world_points(shape), degree, spline, parameters);
  for (std::size_t i = 0; i < cubics.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      const double along =
          (static_cast<double>(i) + static_cast<double>(k) / 3) / static_cast<double>(cubics.size());
      const Vector3 p = cubics[i][k];
      curve.points.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z),
                              static_cast<float>(scale * ((1 - along) * begin + along * end) / 2)});
    }
  if (curve.kind == CurveSegments::Kind::ribbon) curve.normals = world_normals(shape, cubics.size() + 1);
  return curve;
}

}  // namespace petzval::render
