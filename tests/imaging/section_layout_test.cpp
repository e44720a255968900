// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/imaging/section_layout.h>

#include <cstdlib>
#include <vector>

namespace petzval {
namespace {

TEST(SectionLayout, CoversEveryCellOnce) {
  for (const int cells : {1, 2, 7, 16, 17, 96, 97, 776})
    for (const int length : {1, 2, 3, 8, 16, 32, 1000}) {
      std::vector<int> covered(static_cast<std::size_t>(cells));
      for (const SectionGroup& group : lay_sections(cells, length))
        for (const SectionSpan& section : group.sections)
          for (int i = section.first; i < section.first + length; ++i)
            if (i >= 0 && i < cells) ++covered[static_cast<std::size_t>(i)];
      EXPECT_EQ(covered, std::vector<int>(static_cast<std::size_t>(cells), 1)) << cells << " by " << length;
    }
}

TEST(SectionLayout, GroupsKeepTheirDistanceAndMirrorTheirSections) {
  for (const int cells : {9, 16, 96, 97})
    for (const int length : {1, 3, 8, 16}) {
      const std::vector<SectionGroup> groups = lay_sections(cells, length);
      for (std::size_t i = 0; i < groups.size(); ++i) {
        for (const SectionSpan& section : groups[i].sections) {
          const double centre = section.first + length / 2.0 - cells / 2.0;
          EXPECT_EQ(centre, section.mirrored ? -groups[i].centre : groups[i].centre);
        }
        for (std::size_t j = 0; j < i; ++j)
          for (const SectionSpan& one : groups[i].sections)
            for (const SectionSpan& other : groups[j].sections)
              EXPECT_GE(std::abs(one.first - other.first), static_cast<int>(i - j) * length);
      }
    }
}

// The weights of all sections that reach a cell sum to 1: light is neither made nor lost by fading.
TEST(SectionLayout, FadingSectionsShareEveryCellWholly) {
  for (const int cells : {1, 2, 7, 16, 17, 97})
    for (const int length : {1, 2, 3, 8, 16, 1000}) {
      const std::vector<float> weights = fading_weights(length);
      std::vector<double> shares(static_cast<std::size_t>(cells));
      for (const SectionGroup& group : lay_fading_sections(cells, length))
        for (const SectionSpan& section : group.sections) {
          const double centre = section.first + double(weights.size()) / 2 - cells / 2.0;
          EXPECT_EQ(centre, section.mirrored ? -group.centre : group.centre);
          for (std::size_t i = 0; i < weights.size(); ++i) {
            const int cell = section.first + static_cast<int>(i);
            if (cell >= 0 && cell < cells) shares[static_cast<std::size_t>(cell)] += double(weights[i]);
          }
        }
      for (const double share : shares) EXPECT_NEAR(share, 1, 1e-7) << cells << " by " << length;
    }
}

}  // namespace
}  // namespace petzval
