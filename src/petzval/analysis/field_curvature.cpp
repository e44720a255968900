// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/field_curvature.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/surface_shape.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double distance_along(const Vector& from, const Vector& to, const Vector& direction) {
  return dot({to[0] - from[0], to[1] - from[1], to[2] - from[2]}, direction);
}

/// n/distance to the two foci, measured along the ray from where it is now.
struct Vergence {
  double tangential, sagittal;

  void travel(double distance_mm, double index) {
    tangential /= 1 - distance_mm * tangential / index;
    sagittal /= 1 - distance_mm * sagittal / index;
  }
};

/// Where the chief ray's neighbours cross each other, for lenses without round surfaces to walk.
AstigmaticFoci foci_of_neighbours(const FieldTracer& tracer, const ChiefRay& chief) {
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief.object_field);
  // So small that third order is not seen, and so large that rounding is not.
  constexpr double nudge_share = 1e-3;
  const double stop_mm = tracer.tracer().stop_radius_mm();
  const double nudge = nudge_share * (pencil.v_through(stop_mm) - pencil.v_through(0));
  const auto at = [&](double u, double v) {
    return tracer.tracer().trace(pencil.ray(chief.u + u, chief.v + v).value_or(Ray{}), Tracer::Clip::none);
  };
  const auto focus_mm = [&](const Ray& high, const Ray& low, std::size_t axis) {
    const double apart = high.point_mm[axis] - low.point_mm[axis];
    const double slopes = high.direction[axis] / high.direction[2] - low.direction[axis] / low.direction[2];
    return -apart / slopes / chief.at_image.direction[2];
  };
  return {focus_mm(at(0, nudge), at(0, -nudge), 1), focus_mm(at(nudge, 0), at(-nudge, 0), 0)};
}

}  // namespace

AstigmaticFoci astigmatic_foci(const FieldTracer& tracer, const ChiefRay& chief) {
  const Lens& lens = tracer.lens();
  if (is_ray_transfer(lens) || !is_round(lens) ||
      std::ranges::any_of(lens.surfaces, [](const Surface& each) { return each.ideal_lens.has_value(); }))
    return foci_of_neighbours(tracer, chief);
  const Tracer& glass = tracer.tracer();
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief.object_field);
  const Ray launched = *pencil.ray(0, chief.v);
  std::vector<Intersection> path;
  glass.trace(launched, Tracer::Clip::none, &path);

  Vergence bundle{0, 0};
  Vector at = launched.point_mm, direction = launched.direction;
  if (!pencil.object_at_infinity()) {
    const double distance = distance_along(pencil.point_mm(), path[0].point_mm, direction);
    bundle = {-glass.object_index() / distance, -glass.object_index() / distance};
    at = path[0].point_mm;
  }
  for (std::size_t i = 0; i < glass.surface_count(); ++i) {
    const Tracer::PreparedSurface& surface = glass.surfaces()[i];
    const Intersection& hit = path[i];
    if (i > 0) bundle.travel(distance_along(at, hit.point_mm, direction), surface.index_before);
    const double cosine = dot(direction, hit.normal), cosine_after = dot(hit.direction_after, hit.normal);
    const PrincipalCurvatures curvature =
        principal_curvatures(surface.shape, std::hypot(hit.point_mm[0], hit.point_mm[1]));
    const double power = surface.index_after * cosine_after - surface.index_before * cosine;
    bundle.tangential =
        (bundle.tangential * cosine * cosine + power * curvature.meridional) / (cosine_after * cosine_after);
    bundle.sagittal += power * curvature.sagittal;
    at = hit.point_mm;
    direction = hit.direction_after;
  }
  const double to_image = distance_along(at, chief.at_image.point_mm, direction), n = glass.image_index();
  return {n / bundle.tangential - to_image, n / bundle.sagittal - to_image};
}

std::vector<FieldCurvatureRow> field_curvature_table(const Lens& lens, const FieldTableRequest& request) {
  return field_rows<FieldCurvatureRow>(
      lens, request,
      [&](const FieldTracer& tracer, const ChiefRay& chief) -> std::optional<FieldCurvatureRow> {
        const double wavelength = tracer.tracer().wavelength_nm();
        const AstigmaticFoci foci = astigmatic_foci(tracer, chief);
        const FirstOrder paraxial = first_order(lens, wavelength);
        const double height = ideal_image_height_mm(lens, chief.object_field, wavelength);
        FieldCurvatureRow row;
        row.object_field = chief.object_field;
        row.real_image_height_mm = chief.image_height_mm;
        row.tangential_mm = foci.tangential_mm * chief.at_image.direction[2];
        row.sagittal_mm = foci.sagittal_mm * chief.at_image.direction[2];
        const bool has_height = lens.object_distance_mm || std::abs(chief.object_field) < 90;
        row.petzval_mm = has_height && !is_ray_transfer(lens) && is_round(lens)
                             ? paraxial.paraxial_image_mm - lens.image_distance_mm() +
                                   height * height / (2 * paraxial.petzval_radius_mm)
                             : std::numeric_limits<double>::quiet_NaN();
        return row;
      });
}

}  // namespace petzval
