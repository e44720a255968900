// SPDX-License-Identifier: BSD-3-Clause
// Both blurs against each other, against the definition, and against conservation of energy.
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/imaging/exact_blur.h>
#include <petzval/imaging/section_blur.h>

#include <string>

namespace petzval {
namespace {

using namespace testing;

constexpr double pitch_um = 6.25;

TEST(ExactBlur, PutsTheKernelOfItsPlaceAtEveryPoint) {
  const LensDataTable table = make_table(comatic_recipe(0.4));
  const PsfField psfs(table, 550, pitch_um);
  CellPlane source({47, 37, pitch_um});
  source.row(18)[30] = 2;
  source.row(0)[0] = 3;
  const CellPlane image = blur_exact(source, psfs, 0);
  const int radius = psfs.radius();
  ASSERT_LE(radius, 16) << "the kernels must lie within the plane";
  const Kernel inside = psfs.kernel_at(source.grid.x_mm(30.5), source.grid.y_mm(18.5));
  const Kernel corner = psfs.kernel_at(source.grid.x_mm(0.5), source.grid.y_mm(0.5));
  for (int i = -radius; i <= radius; ++i)
    for (int j = -radius; j <= radius; ++j) {
      const auto at = static_cast<std::size_t>((i + radius) * inside.size() + j + radius);
      // The image is float.
      EXPECT_NEAR(image.row(static_cast<std::size_t>(18 + i))[30 + j], 2 * inside.weights[at], 1e-7);
      if (i >= 0 && j >= 0) {
        EXPECT_NEAR(image.row(static_cast<std::size_t>(i))[j], 3 * corner.weights[at], 2e-7);
      }
    }
}

TEST(ExactBlur, MarginCellsSendLightInAndNoneIsKept) {
  const LensDataTable table = make_table({});
  const PsfField psfs(table, 550, pitch_um);
  const int margin = psfs.radius();
  CellPlane source(grown({20, 20, pitch_um}, margin));
  source.row(static_cast<std::size_t>(margin))[margin - 1] = 1;  // just left of the frame, in its first row
  const CellPlane image = blur_exact(source, psfs, margin);
  ASSERT_EQ(image.grid.columns, 20);
  const Kernel kernel = psfs.kernel_at(source.grid.x_mm(margin - 0.5), source.grid.y_mm(margin + 0.5));
  EXPECT_NEAR(image.row(0)[0], kernel.weights[static_cast<std::size_t>(margin * kernel.size() + margin + 1)],
              1e-8);
  EXPECT_LT(sum_of(image), 0.5);
}

// Where the PSF is the same everywhere, sections of any size are a plain convolution: any difference is a
// fault of layout, margins, flips or wrap-around. A round spot is the same at every azimuth but for what its
// splines bend: 1e-5 relative to the image's norm.
TEST(SectionBlur, IsAPlainConvolutionWhereThePsfIsConstant) {
  TableRecipe recipe;
  recipe.psf = [](double, double) {
    return psf_of_spots({{0, 0, pitch_um, pitch_um, 1}}, 101, pitch_um / 10);
  };
  const LensDataTable table = make_table(recipe);
  const PsfField psfs(table, 550, pitch_um);
  for (const SensorGeometry grid :
       {SensorGeometry{96, 64, pitch_um}, {77, 51, pitch_um}, {5, 90, pitch_um}}) {
    const CellPlane source = random_plane(grid);
    const CellPlane expected = blur_exact(source, psfs, 0);
    for (const int section : {1, 3, 8, 16, 100})
      EXPECT_LT(relative_l2(blur_sections(source, psfs, 0, {section, 0}), expected), 1e-5)
          << grid.columns << "×" << grid.rows << " in sections of " << section;
  }
}

class SectionAgainstExact : public ::testing::TestWithParam<double> {};

// One cell a section is the exact method, by another way: transforms, and kernels shared between mirrored
// places. The frame is small, but off-centre sizes and both symmetries of the PSF are covered.
TEST_P(SectionAgainstExact, AgreesToRoundingWhenEachCellIsASection) {
  const LensDataTable table = make_table(comatic_recipe(GetParam()));
  const PsfField psfs(table, 550, 25.0);
  for (const SensorGeometry grid : {SensorGeometry{120, 90, 25.0}, {111, 77, 25.0}, {60, 45, 25.0}}) {
    const CellPlane source = random_plane(grid);
    EXPECT_LT(relative_l2(blur_sections(source, psfs, 2, {1, 0}), blur_exact(source, psfs, 2)), 5e-7);
  }
}

INSTANTIATE_TEST_SUITE_P(Lean, SectionAgainstExact, ::testing::Values(0.0, 0.6));

// Smaller sections come closer, roughly in proportion to their size: the PSF is off by half a section's
// change.
TEST(SectionBlur, ApproachesTheExactOneAsSectionsShrink) {
  TableRecipe recipe = comatic_recipe();
  recipe.height_mm = [](double field, double) { return 2 * std::tan(radians(field)); };  // ends at the corner
  const LensDataTable table = make_table(recipe);
  const PsfField psfs(table, 550, pitch_um);
  const CellPlane source = random_plane({192, 144, pitch_um});
  const CellPlane exact = blur_exact(source, psfs, psfs.radius());
  double previous = 1;
  for (const int section : {64, 32, 16, 8, 1}) {
    const double error = relative_l2(blur_sections(source, psfs, psfs.radius(), {section, 0}), exact);
    RecordProperty("relative_l2_of_sections_of_" + std::to_string(section), std::to_string(error));
    std::printf("sections of %2d cells: relative L2 error %.3g\n", section, error);
    EXPECT_LT(error, 0.75 * previous) << section;
    previous = error;
  }
  EXPECT_LT(previous, 5e-7) << "one cell a section: rounding of single precision only";
}

// Blended sections are off by the curvature of the kernel over a section, not by its slope: a quarter for
// half the size. A PSF without kinks between fields shows it: one that grows with the square of the height.
TEST(SectionBlur, BlendedSectionsConvergeTwiceAsFast) {
  TableRecipe recipe;
  recipe.fields.clear();
  for (int field = 0; field <= 40; ++field) recipe.fields.push_back(field / 2.0);
  recipe.height_mm = [](double field, double) { return 2 * std::tan(radians(field)); };
  recipe.psf = [](double field, double) { return comatic_psf(std::pow(field / 20, 2)); };
  const LensDataTable table = make_table(recipe);
  const PsfField psfs(table, 550, pitch_um);
  const CellPlane source = random_plane({192, 144, pitch_um});
  const CellPlane exact = blur_exact(source, psfs, psfs.radius());
  double previous = 1;
  for (const int section : {32, 16, 8}) {
    const double blended = relative_l2(blur_sections(source, psfs, psfs.radius(), {section, 0, true}), exact);
    const double plain = relative_l2(blur_sections(source, psfs, psfs.radius(), {section, 0, false}), exact);
    std::printf("sections of %2d cells: relative L2 error %.3g blended, %.3g not\n", section, blended, plain);
    EXPECT_LT(blended, plain / 2) << section;
    EXPECT_LT(blended, previous / 3) << section;
    previous = blended;
  }
  EXPECT_LT(relative_l2(blur_sections(source, psfs, psfs.radius(), {1, 0, true}), exact), 5e-7);
}

TEST(SectionBlur, KeepsTheEnergyOfLightThatStaysInside) {
  const LensDataTable table = make_table(comatic_recipe(0.6));
  const PsfField psfs(table, 550, pitch_um);
  CellPlane source = random_plane({200, 150, pitch_um});
  const auto radius = static_cast<std::size_t>(psfs.radius());
  for (std::size_t row = 0; row < source.rows(); ++row)
    for (std::size_t column = 0; column < source.columns(); ++column)
      if (row < radius || column < radius || row + radius >= source.rows() ||
          column + radius >= source.columns())
        source.row(row)[column] = 0;
  // Weights sum to 1 to float rounding, 6e-8 each and at random.
  for (const int section : {32, 16, 7, 1})
    EXPECT_NEAR(sum_of(blur_sections(source, psfs, 0, {section, 0})) / sum_of(source), 1, 1e-6) << section;
  for (const int section : {16, 7})
    EXPECT_NEAR(sum_of(blur_sections(source, psfs, 0, {section, 0, true})) / sum_of(source), 1, 1e-6)
        << section;
  EXPECT_NEAR(sum_of(blur_exact(source, psfs, 0)) / sum_of(source), 1, 1e-6);
}

TEST(SectionBlur, GivesTheSameBytesForAnyNumberOfThreads) {
  const LensDataTable table = make_table(comatic_recipe(0.6));
  const PsfField psfs(table, 550, pitch_um);
  const CellPlane source = random_plane({211, 160, pitch_um});
  const auto with_threads = [&](int threads, bool exact, int section, bool blend = false) {
    const ThreadLimit limit(threads);
    return exact ? blur_exact(source, psfs, 3).values
                 : blur_sections(source, psfs, 3, {section, 0, blend}).values;
  };
  for (const int section : {16, 4, 1})
    EXPECT_EQ(with_threads(1, false, section), with_threads(2, false, section));
  EXPECT_EQ(with_threads(1, false, 16, true), with_threads(2, false, 16, true));
  EXPECT_EQ(with_threads(1, true, 0), with_threads(2, true, 0));
}

TEST(SectionBlur, LargerTransformsChangeNothing) {
  const LensDataTable table = make_table(comatic_recipe());
  const PsfField psfs(table, 550, pitch_um);
  const CellPlane source = random_plane({100, 80, pitch_um});
  // Each of the two rounds by itself.
  EXPECT_LT(relative_l2(blur_sections(source, psfs, 0, {16, 0}), blur_sections(source, psfs, 0, {16, 120})),
            3e-7);
}

TEST(SectionBlur, RefusesTransformsThatWouldWrapAndSaysWhichWouldNot) {
  EXPECT_EQ(transform_size({16, 0}, 5), 30);
  EXPECT_EQ(transform_size({16, 26}, 5), 26);
  EXPECT_EQ(transform_size({16, 0, true}, 5), 48);
  try {
    transform_size({16, 25}, 5);
    FAIL() << "25 < 16 + 11 − 1";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("from 26"), std::string::npos) << error.what();
  }
  EXPECT_THROW(transform_size({0, 0}, 5), InputError);
  EXPECT_THROW(transform_size({5000, 0}, 5), InputError);
  EXPECT_THROW(transform_size({16, 1 << 20}, 5), InputError);
}

// The paper found that interpolating PSFs gives the more accurate picture. Here the truth is known between
// the fields: a table twice as fine.
TEST(PsfInterpolationFigure, PsfsAreNoWorseThanOtfs) {
  TableRecipe recipe = comatic_recipe();
  const LensDataTable coarse = make_table(recipe);
  recipe.fields = {0, 2.5, 5, 7.5, 10, 12.5, 15, 17.5, 20};
  const LensDataTable fine = make_table(recipe);
  const CellPlane source = random_plane({160, 120, 18.0});
  const auto blurred = [&](const LensDataTable& table, PsfInterpolation interpolation) {
    const PsfField psfs(table, 550, 18.0, interpolation);
    return blur_sections(source, psfs, 2, {8, 0});
  };
  const CellPlane truth = blurred(fine, PsfInterpolation::psf);
  const double psf_error = relative_l2(blurred(coarse, PsfInterpolation::psf), truth);
  const double otf_error = relative_l2(blurred(coarse, PsfInterpolation::otf), truth);
  std::printf("fields 5° apart: relative L2 error %.3g interpolating PSFs, %.3g OTFs\n", psf_error,
              otf_error);
  EXPECT_LT(psf_error, 0.02);
  EXPECT_LT(otf_error, 0.02);
  EXPECT_NEAR(sum_of(blurred(coarse, PsfInterpolation::otf)) / sum_of(truth), 1, 1e-3);
}

}  // namespace
}  // namespace petzval
