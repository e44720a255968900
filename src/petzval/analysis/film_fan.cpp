// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/film_fan.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace petzval {

namespace {

/// The direction cosine within a section that runs from −1 to 1, and the other one, which is fixed.
struct Directions {
  FilmSection section;
  double height_mm, fixed;

  Ray ray(const Tracer& tracer, double along) const {
    const double x = section == FilmSection::sagittal ? along : fixed,
                 y = section == FilmSection::sagittal ? fixed : along;
    // Light travels towards the film; the ray is followed back.
    return {{0, height_mm, tracer.image_z_mm()}, {-x, -y, -std::sqrt(std::max(0.0, 1 - x * x - y * y))}};
  }
  bool passes(const Tracer& tracer, double along) const {
    return along * along + fixed * fixed < 1 &&
           tracer.trace_backward(ray(tracer, along)).status == RayStatus::ok;
  }
};

/// The lowest and the highest direction that pass.
std::optional<std::array<double, 2>> rims(const Tracer& tracer, const Directions& directions) {
  constexpr int steps = 4000, halvings = 40;
  std::optional<std::array<double, 2>> found;
  const auto at = [](int i) { return 2.0 * i / steps - 1; };
  for (int i = 1; i < steps; ++i)
    if (directions.passes(tracer, at(i))) found = {found ? (*found)[0] : at(i), at(i)};
  if (!found) return found;
  for (const int side : {0, 1}) {
    double in = (*found)[static_cast<std::size_t>(side)], out = in + (side == 0 ? -2.0 : 2.0) / steps;
    for (int i = 0; i < halvings; ++i)
      (directions.passes(tracer, (in + out) / 2) ? in : out) = (in + out) / 2;
    (*found)[static_cast<std::size_t>(side)] = in;
  }
  return found;
}

FilmRay path_of(const Tracer& tracer, const Directions& directions, double along, double lead_mm) {
  const std::size_t across = directions.section == FilmSection::sagittal ? 0 : 1;
  std::vector<Intersection> met;
  const Ray ray = directions.ray(tracer, along);
  const Ray out = tracer.trace_backward(ray, Tracer::Clip::apertures, &met);
  const Frame::Vector film = tracer.sensor_frame().point_to_lens(ray.point_mm, tracer.image_z_mm());
  FilmRay path{{film[2], film[across]}};
  for (const Intersection& each : met) path.push_back({each.point_mm[2], each.point_mm[across]});
  const double on = (-lead_mm - out.point_mm[2]) / out.direction[2];
  if (on > 0) path.push_back({-lead_mm, out.point_mm[across] + on * out.direction[across]});
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace

std::vector<FilmRay> film_fan(const Tracer& tracer, double height_mm, FilmSection section, int count,
                              double lead_mm) {
  Directions directions{FilmSection::meridional, height_mm, 0};
  auto range = rims(tracer, directions);
  if (range && section == FilmSection::sagittal) {
    directions = {section, height_mm, ((*range)[0] + (*range)[1]) / 2};
    range = rims(tracer, directions);
  }
  std::vector<FilmRay> fan;
  if (!range) return fan;
  for (int i = 0; i < count; ++i) {
    const double share = count == 1 ? 0.5 : static_cast<double>(i) / (count - 1);
    fan.push_back(path_of(tracer, directions, (*range)[0] + share * ((*range)[1] - (*range)[0]), lead_mm));
  }
  return fan;
}

}  // namespace petzval
