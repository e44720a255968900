// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/imaging/flat_blocks.h>

namespace petzval {
namespace {

// Dark but for one sample, in a picture whose sides are not whole blocks.
TEST(FlatBlocks, AreKnownByTheirValueAndTheirPlace) {
  constexpr std::size_t columns = 70, rows = 41;
  std::vector<float> samples(columns * rows, 0.0F);
  samples[20 * columns + 33] = 1;
  const FlatBlocks blocks(samples, columns, rows);
  EXPECT_TRUE(blocks.any());
  EXPECT_EQ(blocks.value_in(1, 31.9, 3, 40, false), 0.0F);   // left of the bright one's block
  EXPECT_EQ(blocks.value_in(48, 69.5, 3, 40, false), 0.0F);  // and right of it
  EXPECT_EQ(blocks.value_in(31.9, 32.1, 20, 21, false), std::nullopt);
  EXPECT_EQ(blocks.value_in(48, 70.5, 3, 40, false), std::nullopt);  // beyond the picture
  EXPECT_EQ(blocks.value_in(48, 70.5, -9, 60, true), 0.0F);
  samples.assign(samples.size(), 2.0F);
  EXPECT_EQ(FlatBlocks(samples, columns, rows).value_in(0, 69, 0, 40, false), 2.0F);
}

}  // namespace
}  // namespace petzval
