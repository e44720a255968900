// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/flare/source_beam.h>

#include <cmath>

namespace petzval {

SourceBeam::SourceBeam(const BrightSource& source, std::array<double, 2> across)
    : towards_{source.right, source.up, 1}, distance_mm_(source.distance_mm.value_or(0)) {
  const auto unit = [](std::array<double, 3>& vector) {
    const double length = std::hypot(vector[0], vector[1], vector[2]);
    for (double& each : vector) each /= length;
  };
  unit(towards_);
  if (source.radius_rad == 0 || (across[0] == 0 && across[1] == 0)) return;
  // The disc's own axes: one level with the horizon of the camera, one upwards.
  const double level = std::hypot(towards_[0], towards_[2]);
  const std::array<double, 3> side{towards_[2] / level, 0, -towards_[0] / level};
  const std::array<double, 3> over{-towards_[0] * towards_[1] / level, level,
                                   -towards_[1] * towards_[2] / level};
  const double reach = std::tan(source.radius_rad);
  for (std::size_t i = 0; i < 3; ++i) towards_[i] += reach * (across[0] * side[i] + across[1] * over[i]);
  unit(towards_);
}

Ray SourceBeam::ray(double x_mm, double y_mm) const {
  Ray ray;
  ray.point_mm = {x_mm, y_mm, 0};
  if (distance_mm_ == 0) {
    ray.direction = {-towards_[0], -towards_[1], towards_[2]};
    return ray;
  }
  const double scale = distance_mm_ / towards_[2];
  const double x = x_mm - scale * towards_[0], y = y_mm - scale * towards_[1], z = distance_mm_;
  const double length = std::hypot(x, y, z);
  ray.direction = {x / length, y / length, z / length};
  return ray;
}

double SourceBeam::weight(double x_mm, double y_mm) const {
  if (distance_mm_ == 0) return towards_[2];
  const double scale = distance_mm_ / towards_[2];
  const double x = x_mm - scale * towards_[0], y = y_mm - scale * towards_[1];
  const double square = x * x + y * y + distance_mm_ * distance_mm_;
  return scale * scale / square * distance_mm_ / std::sqrt(square);
}

std::vector<std::array<double, 2>> even_disc(int count) {
  std::vector<std::array<double, 2>> places;
  if (count == 1) return {{0.0, 0.0}};
  const double turn = pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double radius = std::sqrt((i + 0.5) / count), angle = i * turn;
    places.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return places;
}

DiscMesh DiscMesh::of_rings(int rings) {
  DiscMesh mesh;
  mesh.nodes.push_back({0, 0});
  constexpr int sides = 6;
  // The polygon of the rim has the area of the disc.
  const double rim_step = 2 * pi / (sides * rings);
  const double reach = std::sqrt(rim_step / std::sin(rim_step));
  const auto node = [](int ring, int step) -> std::size_t {
    if (ring == 0) return 0;
    return static_cast<std::size_t>(1 + sides * ring * (ring - 1) / 2 + step % (sides * ring));
  };
  for (int ring = 1; ring <= rings; ++ring)
    for (int step = 0; step < sides * ring; ++step) {
      const double angle = 2 * pi * step / (sides * ring), radius = reach * ring / rings;
      mesh.nodes.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
  for (int ring = 1; ring <= rings; ++ring)
    for (int side = 0; side < sides; ++side)
      for (int k = 0; k < ring; ++k) {
        const int outer = side * ring + k, inner = side * (ring - 1) + k;
        mesh.triangles.push_back({node(ring, outer), node(ring, outer + 1), node(ring - 1, inner)});
        if (k + 1 < ring)
          mesh.triangles.push_back({node(ring - 1, inner), node(ring, outer + 1), node(ring - 1, inner + 1)});
      }
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto &p = mesh.nodes[a], &q = mesh.nodes[b], &r = mesh.nodes[c];
    mesh.shares.push_back(std::abs((q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1])) / (2 * pi));
  }
  return mesh;
}

}  // namespace petzval
