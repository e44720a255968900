// SPDX-License-Identifier: BSD-3-Clause
// The sum over chords against the sum over polar nodes, which shares neither nodes nor arithmetic with it.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/wave/chord_sum.h>

#include <algorithm>

#include "wave/analytic_pupils.h"

namespace petzval {
namespace {

constexpr double na = 0.125;
constexpr double lambda_n_um = lambda_nm * 1e-3 / (2 * na);

/// Defocus, astigmatism, coma and spherical aberration: nothing that a mirror at t = 0 would leave as it is.
double aberrated(double a, double b) {
  const double x = a / na, y = b / na, r2 = x * x + y * y;
  return 1.3 * r2 + 0.8 * y * y + 1.1 * y * r2 - 0.9 * r2 * r2;
}

double worst_over_peak(const Psf& one, const Psf& other) {
  float peak = 0, worst = 0;
  for (std::size_t i = 0; i < one.values.size(); ++i) {
    peak = std::max(peak, one.values[i]);
    worst = std::max(worst, std::abs(one.values[i] - other.values[i]));
  }
  return worst / peak;
}

TEST(ChordSum, EqualsTheSumOverNodes) {
  for (const int size : {1, 2, 33, 64}) {
    const double spacing = 0.45 * lambda_n_um;
    const Psf nodes = sum_plane_waves(disc(na, aberrated), size, spacing);
    const Psf chords = sum_chords(smooth_disc(na, aberrated), {size, spacing});
    // Chords end like square roots, which Gauss-Legendre panels integrate to 1e-5.
    EXPECT_LT(worst_over_peak(nodes, chords), 5e-5) << size;
    EXPECT_NEAR(chords.captured, nodes.captured, 5e-5) << size;
  }
}

TEST(ChordSum, CellsHoldTheLightOfTheirSamples) {
  // Cells of fifteen fine samples a side, odd so that both grids have their middles in common, against cells
  // of two and three and four coarser ones.
  const int size = 25, fine_per_cell = 15;
  const double cell_um = 1.0 * lambda_n_um;
  const Psf fine =
      sum_plane_waves(disc(na, aberrated, 96, 300), size * fine_per_cell, cell_um / fine_per_cell);
  std::vector<double> expected(size * size, 0.0);
  for (int i = 0; i < fine.size; ++i)
    for (int j = 0; j < fine.size; ++j)
      expected[static_cast<std::size_t>((i / fine_per_cell) * size + j / fine_per_cell)] += fine.at(i, j);
  const double peak = *std::max_element(expected.begin(), expected.end());
  for (const auto& [per_cell, tolerance] : {std::pair{2, 3e-2}, {3, 1e-2}, {4, 3e-3}, {5, 2e-3}}) {
    const Psf cells = sum_chords(smooth_disc(na, aberrated), {size, cell_um, per_cell});
    double worst = 0, sum = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      worst = std::max(worst, std::abs(cells.values[i] - expected[i]) / peak);
      sum += cells.values[i];
    }
    // Fourth order in the samples' spacing, 0.5 to 0.2 λN; the reference itself is a sum of midpoints, good
    // to 1e-3.
    EXPECT_LT(worst, tolerance) << per_cell;
    EXPECT_NEAR(sum, 1, 1e-6);
  }
}

TEST(ChordSum, LeavesCellsDarkOnRequestAndTheRestAsItIs) {
  const SmoothPupil pupil = smooth_disc(na, aberrated);
  const Psf whole = sum_chords(pupil, {40, 0.9 * lambda_n_um, 2});
  PsfGrid grid{40, 0.9 * lambda_n_um, 2};
  grid.first_row = 11;
  grid.last_row = 30;
  grid.reach = 9;
  const Psf part = sum_chords(pupil, grid);
  EXPECT_LT(part.captured, whole.captured);
  float peak = *std::max_element(whole.values.begin(), whole.values.end());
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) {
      const bool lit = i >= 11 && i <= 30 && std::abs(j - 20) <= 9;
      if (!lit) {
        EXPECT_EQ(part.at(i, j), 0);
      }
      // Cells inside the border; those on it miss what samples beyond it would have given them, 1/24 at most.
      if (lit && i > 11 && i < 30 && std::abs(j - 20) < 9) {
        EXPECT_NEAR(part.at(i, j) * part.captured, whole.at(i, j) * whole.captured, 1e-5 * peak)
            << i << " " << j;
      }
    }
}

TEST(ChordSum, FindsChordsOfPupilsWithCorners) {
  // A circle cut by a straight edge at β = 0.3 na: the outline is smooth but for one corner.
  SmoothPupil pupil = smooth_disc(na, aberrated);
  std::vector<double> alpha{0.0}, beta{0.3 * na};
  const double corner = std::sqrt(1 - 0.09) * na;
  // The edge is a function of α, not of β; a slope of a thousandth makes it one.
  for (const double share : {0.3, 0.6}) {
    alpha.push_back(share * corner);
    beta.push_back((0.3 - 1e-3 * share) * na);
  }
  const double low = 0.3 - 1e-3, top = std::acos(low);
  for (int i = 0; i <= 40; ++i) {
    const double azimuth = top + (pi - top) * i / 40;
    alpha.push_back(i == 40 ? 0 : na * std::sin(azimuth));
    beta.push_back(na * std::cos(azimuth));
  }
  pupil.outline_alpha = alpha;
  pupil.outline_beta = beta;
  pupil.corners = {3};
  for (const double b : {-0.95, -0.5, 0.0, 0.2, 0.29, 0.2985})
    EXPECT_NEAR(pupil.half_chord(b * na), std::sqrt(1 - b * b) * na, 2e-6 * na) << b;
  EXPECT_EQ(pupil.half_chord(0.31 * na), 0);
  const double segment = na * na * (pi - std::acos(0.3) + 0.3 * std::sqrt(1 - 0.09));
  EXPECT_NEAR(pupil.amplitude_square_integral() / segment, 1, 1e-3);  // the slope's share of the area
}

TEST(ChordSum, RefusesEmptyAndHugeGrids) {
  const SmoothPupil pupil = smooth_disc(na, aberrated);
  EXPECT_THROW(sum_chords(pupil, {0, 1.0}), InputError);
  EXPECT_THROW(sum_chords(pupil, {8, 0.0}), InputError);
  EXPECT_THROW(sum_chords(pupil, {8, 1.0, 0}), InputError);
  EXPECT_THROW(sum_chords(pupil, {4096, 1.0, 1000}), InputError);
}

}  // namespace
}  // namespace petzval
