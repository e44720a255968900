// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/lens/formats/axis_breaks.h>

#include <algorithm>

namespace petzval {

void put_axis_breaks(const std::vector<AxisBreak>& breaks, Lens& lens) {
  const std::size_t sensor = lens.surfaces.size();
  Frame of_sensor;
  // Later breaks are stated in the axes of earlier ones: groups move what earlier groups have moved.
  for (auto each = breaks.rbegin(); each != breaks.rend(); ++each) {
    if (is_as_good_as_none(each->frame)) continue;
    if (each->surface < sensor) {
      lens.groups.push_back({each->surface, sensor, pose_of(each->frame), each->pivot_mm});
      continue;
    }
    Frame to_pivot, back;
    to_pivot.offset_mm[2] = each->pivot_mm, back.offset_mm[2] = -each->pivot_mm;
    of_sensor = composed(to_pivot, composed(each->frame, composed(back, of_sensor)));
  }
  if (!is_as_good_as_none(of_sensor)) lens.sensor_pose = pose_of(of_sensor);
}

AxisBreaks axis_breaks_of(const Lens& lens) {
  const std::vector<Frame> frames = frames_of(lens);
  AxisBreaks result;
  Frame axes;  // behind the surface before, at its vertex
  double gap_mm = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    Frame along, here = frames[i];
    along.offset_mm[2] = gap_mm;
    for (std::size_t k = 0; k < i; ++k) here.offset_mm[2] += lens.surfaces[k].thickness_mm;
    AxisBreak step{i, composed(inverse(composed(axes, along)), here), 0};
    result.gap_shift_mm.push_back(0);
    if (is_as_good_as_none(step.frame)) {
      axes = composed(axes, along);
    } else {
      result.gap_shift_mm.back() = step.frame.offset_mm[2];
      step.frame.offset_mm[2] = 0;
      result.breaks.push_back(step);
      axes = here;
    }
    if (i < lens.surfaces.size()) gap_mm = lens.surfaces[i].thickness_mm;
  }
  return result;
}

}  // namespace petzval
