// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/section_layout.h>

#include <cmath>
#include <utility>

namespace petzval {

std::vector<SectionGroup> lay_sections(int cells, int length) {
  int count = (cells + length - 1) / length;
  // One more section, if that makes the overhang even and so the layout symmetric.
  if ((count * length - cells) % 2 != 0 && length % 2 != 0) ++count;
  const int overhang = count * length - cells, first = -(overhang / 2);
  const auto centre_of = [&](int section) { return first + (section + 0.5) * length - cells / 2.0; };

  std::vector<SectionGroup> groups;
  if (overhang % 2 != 0) {
    for (int section = 0; section < count; ++section)
      groups.push_back({centre_of(section), {{first + section * length, false}}});
    return groups;
  }
  for (int section = count / 2; section < count; ++section) {
    SectionGroup group{centre_of(section), {{first + section * length, false}}};
    const int opposite = count - 1 - section;
    if (opposite != section) group.sections.push_back({first + opposite * length, true});
    groups.push_back(std::move(group));
  }
  return groups;
}

std::vector<SectionGroup> lay_fading_sections(int cells, int length) {
  const int around = (length + 1) / 2;
  std::vector<SectionGroup> groups = lay_sections(cells + 2 * around, length);
  for (SectionGroup& group : groups)
    for (SectionSpan& section : group.sections) section.first -= around + length / 2;
  return groups;
}

std::vector<float> fading_weights(int length) {
  std::vector<float> weights;
  for (int cell = 0; cell < 2 * length - length % 2; ++cell) {
    const double distance = std::abs(cell + 0.5 - (length - 0.5 * (length % 2)));
    weights.push_back(static_cast<float>(1 - distance / length));
  }
  return weights;
}

}  // namespace petzval
