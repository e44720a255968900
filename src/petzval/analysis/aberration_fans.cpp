// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/aberration_fans.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/reference_heights.h>
#include <petzval/analysis/stop_aim.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/base/units.h>

#include <algorithm>

namespace petzval {

namespace {

std::vector<FanPoint> fan(const FieldTracer& tracer, const ChiefRay& chief, StopAim& aim, bool tangential,
                          int count, const std::array<double, 2>& from_reference_mm) {
  std::vector<FanPoint> points;
  // From the chief ray outwards on both sides, so that each search begins next to the ray before.
  for (const int side : {-1, 1}) {
    std::vector<FanPoint> half;
    for (int i = 0; i < count; ++i) {
      const int place = side > 0 ? i : count - 1 - i;
      const double pupil = 2.0 * place / (count - 1) - 1;
      if (side > 0 ? pupil < 0 : pupil >= 0) continue;
      const std::optional<PupilRay> ray = tangential ? aim.ray(0, pupil) : aim.ray(pupil, 0);
      if (!ray) continue;
      half.push_back({pupil, (ray->x_mm + from_reference_mm[0]) * um_per_mm,
                      (ray->y_mm + from_reference_mm[1]) * um_per_mm,
                      opd_waves(tracer, chief, {*ray}).front()});
    }
    if (side < 0) std::reverse(half.begin(), half.end());
    points.insert(points.end(), half.begin(), half.end());
  }
  return points;
}

}  // namespace

std::vector<AberrationFans> aberration_fans(const Lens& lens, const FieldTableRequest& request, int count) {
  if (count < 3 || count > 100001)
    throw InputError(fmt::format("a fan of {} rays; 3 to 100001 would be right", count));
  const auto reference = reference_points_mm(lens, request);
  return field_rows<AberrationFans>(
      lens, request, [&](const FieldTracer& tracer, const ChiefRay& chief) -> std::optional<AberrationFans> {
        std::optional<StopAim> aim = StopAim::of(tracer, chief);
        if (!aim) return {};
        const auto& [x_mm, y_mm] = reference.at(chief.object_field);
        const std::array<double, 2> from_mm{chief.image_x_mm - x_mm, chief.image_height_mm - y_mm};
        AberrationFans fans;
        fans.real_image_height_mm = chief.image_height_mm;
        fans.tangential = fan(tracer, chief, *aim, true, count, from_mm);
        fans.sagittal = fan(tracer, chief, *aim, false, count, from_mm);
        return fans;
      });
}

}  // namespace petzval
