// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/imaging/psf_kernel.h>
#include <petzval/imaging/psf_refinement.h>

#include <cmath>
#include <numeric>

#include "synthetic_table.h"

namespace petzval {
namespace {

using testing::make_table;
using testing::TableRecipe;

constexpr double lambda_n_um = 4;

/// Airy's pattern at the spacing that tables have.
Psf airy_psf(int size) {
  Psf psf;
  psf.size = size;
  psf.spacing_um = 0.45 * lambda_n_um;
  double sum = 0;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      const double v = pi * std::hypot(i - size / 2, j - size / 2) * psf.spacing_um / lambda_n_um;
      const double amplitude = v == 0 ? 1 : 2 * std::cyl_bessel_j(1, v) / v;
      psf.values.push_back(static_cast<float>(amplitude * amplitude));
      sum += amplitude * amplitude;
    }
  for (float& value : psf.values) value = static_cast<float>(value / sum);
  return psf;
}

/// Of a round pupil without aberration, at a share of its cut-off.
double diffraction_mtf(double share) {
  return share >= 1 ? 0 : 2 / pi * (std::acos(share) - share * std::sqrt(1 - share * share));
}

/// Modulus of a kernel's transform along its columns [cycles a cell].
double modulus(const Kernel& kernel, double frequency) {
  double cosine = 0, sine = 0;
  for (int row = -kernel.radius; row <= kernel.radius; ++row)
    for (int column = -kernel.radius; column <= kernel.radius; ++column) {
      cosine += kernel.at(row, column) * std::cos(2 * pi * frequency * row);
      sine += kernel.at(row, column) * std::sin(2 * pi * frequency * row);
    }
  return std::hypot(cosine, sine);
}

// Cells finer than the samples, whatever their azimuth: the transform of a kernel is that of the pupil's
// autocorrelation times that of the window. 4e-3 for the light beyond the window (0.6 %, modulated by half at
// most), 2e-3 for what splines between fine samples bend. As squares of their own the samples would miss it
// by up to 0.06.
TEST(PsfRefinement, KernelsHaveTheTransferOfTheirPsf) {
  TableRecipe recipe;
  recipe.psf = [](double, double) { return airy_psf(144); };
  const LensDataTable table = make_table(recipe);
  for (const double cell_um : {0.4 * lambda_n_um, 0.25 * lambda_n_um}) {
    const PsfField psfs(table, 550, cell_um);
    for (const double azimuth_deg : {0.0, 20.0, 45.0}) {
      const double height_mm = 1.1, a = radians(azimuth_deg);
      const Kernel kernel = psfs.kernel_at(height_mm * std::sin(a), height_mm * std::cos(a));
      for (const double share : {0.1, 0.25, 0.5, 0.75, 0.9}) {
        const double frequency = share * cell_um / lambda_n_um;
        EXPECT_NEAR(modulus(kernel, frequency),
                    diffraction_mtf(share) * std::exp(-2 * std::pow(pi * 0.65 * frequency, 2)), 6e-3)
            << cell_um << ' ' << azimuth_deg << ' ' << share;
      }
    }
  }
}

TEST(PsfRefinement, IsThePatternBetweenItsSamples) {
  const Psf coarse = airy_psf(256), fine = refined_psf(coarse, 0.06 * lambda_n_um);
  EXPECT_NEAR(fine.spacing_um, coarse.spacing_um / 2, 1e-12)
      << "bounded: 724 samples a side, rounded to whole parts";
  const Psf small = refined_psf(airy_psf(64), 0.06 * lambda_n_um);
  EXPECT_NEAR(small.spacing_um, 0.45 * lambda_n_um / 8, 1e-12);
  EXPECT_EQ(small.size, 2 * 8 * 32 + 1);
  EXPECT_NEAR(std::accumulate(small.values.begin(), small.values.end(), 0.0), 1, 2e-3);
  // Squares of an eighth hardly differ from samples: 1/24 of the second difference, a thousandth of the peak
  // here.
  const double per_sample = small.spacing_um * small.spacing_um / (0.45 * 0.45 * lambda_n_um * lambda_n_um);
  const Psf wanted = airy_psf(64);
  const double peak = wanted.at(32, 32);
  for (int j = 0; j < 40; ++j) {
    const double v = pi * j * small.spacing_um / lambda_n_um;
    const double amplitude = v == 0 ? 1 : 2 * std::cyl_bessel_j(1, v) / v;
    EXPECT_NEAR(small.at(256, 256 + j) / per_sample, peak * amplitude * amplitude, 3e-3 * peak) << j;
  }
}

// One bright sample, and a disc with a sharp edge: whatever lies between such samples, they do not say it.
// A lens that diffraction alone limits has the same PSF in all fields, so all kernels are alike: to what
// laying samples down at one angle or another makes of them (3e-3), and to the corners of windows, which turn
// with the azimuth (5e-4). Were the axis to have another width than its neighbours, kernels between the two
// would be 5 % sharper or softer.
TEST(PsfRefinement, ALensOfEqualPsfsHasEqualKernels) {
  TableRecipe recipe;
  recipe.psf = [](double, double) { return airy_psf(88); };
  for (const double cell_um : {0.5 * lambda_n_um, 2 * lambda_n_um}) {
    const PsfField psfs(make_table(recipe), 550, cell_um);
    const Kernel on_axis = psfs.kernel_at(0, 0);
    double norm = 0;
    for (const double weight : on_axis.weights) norm += weight * weight;
    for (const double height_mm : {0.002, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 1.0, 2.0}) {
      const Kernel kernel = psfs.kernel_at(0.6 * height_mm, 0.8 * height_mm);
      double square = 0;
      for (std::size_t i = 0; i < kernel.weights.size(); ++i)
        square += std::pow(kernel.weights[i] - on_axis.weights[i], 2);
      EXPECT_LT(std::sqrt(square / norm), 3.5e-3) << cell_um << " um, " << height_mm << " mm";
    }
  }
}

// A lit disc in a dark window: no light comes where no rays are, and none is lost.
TEST(PsfRefinement, KeepsDarkWhatIsDark) {
  Psf cut = airy_psf(64);
  constexpr double lit = 15.5;
  const auto from_middle = [](const Psf& psf, int i, int j) {
    return std::hypot(i - psf.size / 2, j - psf.size / 2);
  };
  for (int i = 0; i < cut.size; ++i)
    for (int j = 0; j < cut.size; ++j)
      if (from_middle(cut, i, j) > lit) cut.values[static_cast<std::size_t>(i * cut.size + j)] = 0;
  const Psf fine = refined_psf(cut, 0.06 * lambda_n_um);
  const double factor = cut.spacing_um / fine.spacing_um;
  ASSERT_GT(factor, 2);
  std::size_t beside = 0;
  for (int i = 0; i < fine.size; ++i)
    for (int j = 0; j < fine.size; ++j)
      if (from_middle(fine, i, j) > (lit + 2) * factor)
        ASSERT_EQ(fine.at(i, j), 0) << i << ", " << j;
      else if (from_middle(fine, i, j) > (lit + 0.5) * factor && fine.at(i, j) != 0)
        ++beside;
  EXPECT_GT(beside, 0U);  // the slope down to it is there
  const auto light = [](const Psf& psf) {
    return std::accumulate(psf.values.begin(), psf.values.end(), 0.0);
  };
  EXPECT_NEAR(light(fine) / light(cut), 1, 1e-5);  // sums of a quarter of a million floats
}

TEST(PsfRefinement, LeavesWhatIsNotBandLimited) {
  const Psf point{1, 4.0, {1.0F}, 1.0};
  EXPECT_EQ(refined_psf(point, 0.5).values, point.values);
  Psf disc{33, 4.0, std::vector<float>(33 * 33, 0.0F), 1.0};
  for (int i = 0; i < 33; ++i)
    for (int j = 0; j < 33; ++j)
      if (std::hypot(i - 16, j - 16) < 3.3) disc.values[static_cast<std::size_t>(33 * i + j)] = 1;
  EXPECT_EQ(refined_psf(disc, 0.5).values, disc.values);
  EXPECT_EQ(refined_psf(disc, 0.5).spacing_um, 4.0);
}

}  // namespace
}  // namespace petzval
