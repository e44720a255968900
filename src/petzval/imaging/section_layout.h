// SPDX-License-Identifier: BSD-3-Clause
// How sections cover a row or a column of cells.
#pragma once

#include <vector>

namespace petzval {

/// A section along one axis of the grid: cells [first, first + length) of which some may lie outside the
/// grid.
struct SectionSpan {
  int first = 0;
  bool mirrored =
      false;  ///< lies on the negative side of the axis, as the mirror image of its group's other one
};

/// Sections at one distance from the optical axis: two that mirror each other, or one.
struct SectionGroup {
  double centre =
      0;  ///< cells from the optical axis to the centre of the group's section that is not mirrored
  std::vector<SectionSpan> sections;
};

/// Covers `cells` with sections of `length`, in groups whose distance from group to group is at least one
/// length. The layout is symmetric about the axis unless cells are odd and length even: then each section is
/// a group.
std::vector<SectionGroup> lay_sections(int cells, int length);

/// The same for sections that fade into each other: they reach over half a length on either side (less half a
/// cell if the length is odd), and as many lie around the grid that the weights of fading sum to 1 in every
/// cell.
std::vector<SectionGroup> lay_fading_sections(int cells, int length);

/// Weights of the cells of a fading section of 2 × length (− 1 if odd) cells: 1 − distance from its centre /
/// length.
std::vector<float> fading_weights(int length);

}  // namespace petzval
