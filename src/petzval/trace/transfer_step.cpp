// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/trace/transfer_step.h>

#include <petzval/lens/transfer-inl.h>

#include <cmath>

namespace petzval {

namespace {

bool step_to_plane(double z, SurfaceRay& ray) {
  if (ray.n == 0) return false;
  const double distance = (z - ray.z) / ray.n;
  ray.x += distance * ray.l;
  ray.y += distance * ray.m;
  ray.z = z;
  ray.opl += distance;
  return std::isfinite(distance);
}

}  // namespace

bool carry(const TransferData<double>& transfer, bool backward, SurfaceRay& ray, TransferCrossing& crossing) {
  using Plane = HWY_NAMESPACE::PlaneRay<double>;
  const double length = transfer.length_mm;
  if (backward ? !(ray.n < 0) : !(ray.n > 0)) return false;
  if (!step_to_plane(backward ? length : 0, ray)) return false;
  Plane rear{ray.x, ray.y, ray.l, ray.m};
  Plane in_front{};
  HWY_NAMESPACE::CarriedRay<double> carried;
  if (backward) {
    carried = HWY_NAMESPACE::carry_back(transfer, rear);
  } else {
    const Plane front{ray.x, ray.y, -ray.l, -ray.m};
    if (!(HWY_NAMESPACE::carry_forth(transfer, front, rear, carried) <= transfer_found_within)) return false;
    in_front = front;
  }
  const double share = (carried.stop_x * carried.stop_x + carried.stop_y * carried.stop_y) /
                       (transfer.stop_radius * transfer.stop_radius);
  if (!(share <= transfer_reach_sq)) return false;
  const Plane& end = backward ? carried.front : rear;
  const double cosine_sq = 1 - end.l * end.l - end.m * end.m;
  if (!(cosine_sq > 0)) return false;
  const double opl =
      ray.opl + HWY_NAMESPACE::transfer_path(transfer, backward ? carried.front : in_front, rear);
  crossing = {ray, carried.stop_x, carried.stop_y, carried.others_sq};
  if (backward)
    ray = {end.x, end.y, 0, end.l, end.m, -std::sqrt(cosine_sq), opl};
  else
    ray = {end.x, end.y, length, -end.l, -end.m, std::sqrt(cosine_sq), opl};
  if (backward) crossing.front = ray;
  return true;
}

}  // namespace petzval
