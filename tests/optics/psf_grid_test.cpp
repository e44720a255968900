// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/optics/common_grid.h>
#include <petzval/optics/formats/psf_grid.h>

#include <cmath>

#include "analytic_table.h"

namespace petzval {
namespace {

/// A grid that is dark but for three marks: the chief ray, one step away from the axis, two steps to the
/// side.
NumberGrid marked(int size, int row, int column, int away_row, int away_column, int side_row,
                  int side_column) {
  NumberGrid grid{size, size, std::vector<double>(static_cast<std::size_t>(size * size))};
  const auto mark = [&](int r, int c, double value) {
    grid.values[static_cast<std::size_t>(r * size + c)] = value;
  };
  mark(row, column, 0.5);
  mark(row + away_row, column + away_column, 0.25);
  mark(row + 2 * side_row, column + 2 * side_column, 0.25);
  return grid;
}

struct Lie {
  PsfAway away;
  int away_row, away_column, side_row, side_column;  // a quarter turn clockwise, written out by hand
};

class PsfFrames : public ::testing::TestWithParam<Lie> {};

TEST_P(PsfFrames, PutAwayAndAsideWhereTheyBelong) {
  const Lie lie = GetParam();
  for (const int size : {6, 7}) {
    const NumberGrid grid = marked(size, 3, 3, lie.away_row, lie.away_column, lie.side_row, lie.side_column);
    const PsfFrame frame{lie.away, 3, 3};
    const Psf psf = psf_of_grid(grid, frame, 0.5);
    const int c = psf.size / 2;
    EXPECT_EQ(psf.at(c, c), 0.5F);
    EXPECT_EQ(psf.at(c + 1, c), 0.25F);  // t = +1
    EXPECT_EQ(psf.at(c, c + 2), 0.25F);  // s = +2
    EXPECT_EQ(grid_of_psf(psf, frame, size).values, grid.values);
  }
}

INSTANTIATE_TEST_SUITE_P(All, PsfFrames,
                         ::testing::Values(Lie{PsfAway::up, -1, 0, 0, 1}, Lie{PsfAway::right, 0, 1, 1, 0},
                                           Lie{PsfAway::down, 1, 0, 0, -1},
                                           Lie{PsfAway::left, 0, -1, -1, 0}));

TEST(PsfGrid, RefusesWhatDoesNotFit) {
  const Psf psf = psf_of_grid(marked(7, 3, 3, 1, 0, 0, 1), {PsfAway::down, 3, 3}, 1);
  EXPECT_THROW(grid_of_psf(psf, {PsfAway::down, 3, 0}, 4), InputError);
  EXPECT_THROW(psf_of_grid(marked(7, 3, 3, 1, 0, 0, 1), {PsfAway::down, 7, 3}, 1), InputError);
  NumberGrid dark = marked(7, 3, 3, 1, 0, 0, 1);
  dark.values.assign(49, 0.0);
  EXPECT_THROW(psf_of_grid(dark, {PsfAway::down, 3, 3}, 1), InputError);
  dark.values[5] = NAN;
  EXPECT_THROW(psf_of_grid(dark, {PsfAway::down, 3, 3}, 1), InputError);
}

TEST(PsfGrid, TakesAnyUnitOfLight) {
  NumberGrid grid = marked(7, 3, 3, 1, 0, 0, 1);
  for (const double unit : {1e-310, 1e-30, 3.0, 1e307}) {
    NumberGrid scaled = grid;
    for (double& value : scaled.values) value *= unit;
    const Psf psf = psf_of_grid(scaled, {PsfAway::down, 3, 3}, 1);
    EXPECT_NEAR(double(psf.at(psf.size / 2, psf.size / 2)), 0.5, 1e-6) << unit;  // a subnormal has few digits
  }
}

TEST(PsfMirror, IsFoundWhereThereIsOne) {
  const int size = 16, centre = 7;
  for (const bool upright : {false, true}) {
    NumberGrid grid{size, size, {}};
    for (int row = 0; row < size; ++row)
      for (int column = 0; column < size; ++column) {
        const double along = (upright ? row : column) - centre, across = (upright ? column : row) - centre;
        grid.values.push_back(std::exp(-across * across / 4 - (along - 2) * (along - 2) / 6 - 0.1 * along));
      }
    const auto mirror = find_mirror(std::span(&grid, 1));
    ASSERT_TRUE(mirror);
    EXPECT_EQ(mirror->upright, upright);
    EXPECT_EQ(mirror->centre, centre);
  }
  NumberGrid round{size, size, {}};
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column)
      round.values.push_back(std::exp(-std::hypot(row - centre, column - centre)));
  EXPECT_FALSE(find_mirror(std::span(&round, 1))) << "light that is round lies in no direction";
}

TEST(CommonGrid, KeepsLightAndItsCentre) {
  const LensDataTable table = testing::analytic_table(3);
  const PsfGridSize grid = common_grid(table);
  const LensDataTable brought = on_common_grid(table, grid);
  brought.validate();
  const auto centre_um = [](const Psf& psf, bool along_t) {
    double moment = 0;
    for (int i = 0; i < psf.size; ++i)
      for (int j = 0; j < psf.size; ++j) moment += double(psf.at(i, j)) * ((along_t ? i : j) - psf.size / 2);
    return moment * psf.spacing_um;
  };
  for (std::size_t i = 0; i < table.psf.size(); ++i) {
    EXPECT_EQ(brought.psf[i].size, grid.size);
    EXPECT_EQ(brought.psf[i].spacing_um, grid.spacing_um);
    EXPECT_NEAR(brought.psf[i].captured, table.psf[i].captured, 1e-6);  // nothing fell outside
    for (const bool along_t : {true, false})
      EXPECT_NEAR(centre_um(brought.psf[i], along_t), centre_um(table.psf[i], along_t),
                  1e-6);  // single precision
  }
}

TEST(CommonGrid, SaysWhatAWindowThatIsTooSmallHolds) {
  const Psf psf = testing::comatic_psf(11, 3, 0.5);
  const Psf cut = resampled(psf, {4, 0.5});
  EXPECT_LT(cut.captured, 0.9 * psf.captured);
  double sum = 0;
  for (const float value : cut.values) sum += double(value);
  EXPECT_NEAR(sum, 1, 1e-6);
}

}  // namespace
}  // namespace petzval
