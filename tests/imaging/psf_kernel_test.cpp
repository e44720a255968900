// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/synthetic_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/imaging/field_mixture.h>
#include <petzval/imaging/otf_interpolation.h>
#include <petzval/imaging/psf_kernel.h>

namespace petzval {
namespace {

using namespace testing;

/// On a lattice whose rows run along the tangential direction.
void add(const Psf& psf, double weight, double spacing_um, Kernel& lattice) {
  deposit(MergedPsf(psf), {weight, {1, 1}}, spacing_um, lattice);
}

/// First and third moments of a kernel along a direction of the picture, in cells.
struct MomentsAlong {
  double mean = 0, third = 0;
};

MomentsAlong moments_along(const Kernel& kernel, double column_direction, double row_direction) {
  MomentsAlong moments;
  for (int pass = 0; pass < 2; ++pass)
    for (int row = -kernel.radius; row <= kernel.radius; ++row)
      for (int column = -kernel.radius; column <= kernel.radius; ++column) {
        const double along = column * column_direction + row * row_direction;
        if (pass == 0)
          moments.mean += kernel.at(row, column) * along;
        else
          moments.third += kernel.at(row, column) * std::pow(along - moments.mean, 3);
      }
  return moments;
}

// A rotated Gaussian spot, seen through the window of a kernel, at the middle of a cell: its formula, the
// variances added. Rotation is written here once more, from the meaning of the axes: in the picture,
// tangential points away from the middle, and sagittal is that turned a quarter clockwise as seen on the
// screen (at the bottom of the picture: to the left).
double gaussian_at_cell(int row, int column, double cell_um, double azimuth, const Spot& spot) {
  const double t_column = std::cos(azimuth), t_row = std::sin(azimuth), s_column = -t_row, s_row = t_column;
  const double window_um = 0.65 * cell_um;
  const double sigma_s = std::hypot(spot.sigma_s_um, window_um),
               sigma_t = std::hypot(spot.sigma_t_um, window_um);
  const double x = column * cell_um, y = row * cell_um;
  const double s = (x * s_column + y * s_row - spot.s_um) / sigma_s;
  const double t = (x * t_column + y * t_row - spot.t_um) / sigma_t;
  return cell_um * cell_um * std::exp(-(s * s + t * t) / 2) / (2 * pi * sigma_s * sigma_t);
}

/// Moments of such a spot in the picture, seen through the window: rotation from the same meaning of the
/// axes.
Moments moments_of(const Spot& spot, double azimuth, double cell_um) {
  const double t_column = std::cos(azimuth), t_row = std::sin(azimuth), s_column = -t_row, s_row = t_column;
  const double u = (spot.t_um * t_column + spot.s_um * s_column) / cell_um;
  const double v = (spot.t_um * t_row + spot.s_um * s_row) / cell_um;
  const double s_square = std::pow(spot.sigma_s_um / cell_um, 2);
  const double t_square = std::pow(spot.sigma_t_um / cell_um, 2), of_window = 0.65 * 0.65;
  return {{u, v},
          u * u + t_square * t_column * t_column + s_square * s_column * s_column + of_window,
          u * v + t_square * t_column * t_row + s_square * s_column * s_row,
          v * v + t_square * t_row * t_row + s_square * s_row * s_row + of_window};
}

void expect_moments(const Moments& moments, const Moments& wanted, double tolerance,
                    const std::string& what) {
  EXPECT_NEAR(moments.mean[0], wanted.mean[0], tolerance) << what;
  EXPECT_NEAR(moments.mean[1], wanted.mean[1], tolerance) << what;
  EXPECT_NEAR(moments.uu, wanted.uu, tolerance) << what;
  EXPECT_NEAR(moments.uv, wanted.uv, tolerance) << what;
  EXPECT_NEAR(moments.vv, wanted.vv, tolerance) << what;
}

// On cells much wider than the spot too: the window makes it smooth, and centroid and spread are right
// wherever the cells lie.
TEST(PsfKernel, IsTheRotatedPsfThroughTheWindow) {
  TableRecipe recipe;
  const Spot spot{1.5, -2, 2, 4, 1};
  recipe.psf = [&](double, double) { return psf_of_spots({spot}, 401, 0.1); };
  const LensDataTable table = make_table(recipe);
  for (const double cell_um : {12.0, 5.0, 1.3})
    for (const double degrees : {0.0, 30.0, 90.0, 205.0, 300.0}) {
      const double azimuth = radians(degrees);
      const PsfField psfs(table, 550, cell_um);
      const Kernel kernel = psfs.kernel_at(-std::cos(azimuth), std::sin(azimuth));  // columns run along −x'
      const std::string what = fmt::format("{} µm, {}°", cell_um, degrees);
      // The table's window cuts the Gaussian where it has 5e-6 of its peak, up to 15 cells from the centre:
      // 10⁻³ cells². What the window of a kernel leaves at the cells' frequency, 2·10⁻⁴, times 4π² (0.65)² =
      // 17, is as much.
      expect_moments(kernel.moments(), moments_of(spot, azimuth, cell_um), 4e-3, what);
      double worst = 0, peak = 0;
      for (int row = -kernel.radius; row <= kernel.radius; ++row)
        for (int column = -kernel.radius; column <= kernel.radius; ++column) {
          const double wanted = gaussian_at_cell(row, column, cell_um, azimuth, spot);
          worst = std::max(worst, std::abs(kernel.at(row, column) - wanted));
          peak = std::max(peak, wanted);
        }
      EXPECT_LT(worst, 1e-3 * peak) << what;
    }
}

// Where rows of samples begin and end to be lit makes no difference.
TEST(PsfKernel, IsTheSameInAWindowWithDarkMargins) {
  const Psf small = psf_of_spots({{2, 3, 1.5, 2.5, 1}}, 61, 0.4);
  Psf large;
  large.size = 141;
  large.spacing_um = small.spacing_um;
  large.values.resize(141 * 141);
  for (int i = 0; i < small.size; ++i)
    for (int j = 0; j < small.size; ++j)
      if (std::hypot(i - 38, j - 35) < 20)
        large.values[static_cast<std::size_t>((i + 40) * 141 + j + 40)] = small.at(i, j);
  Psf round = small;  // the same samples, dark ones as far as its window goes
  for (int i = 0; i < small.size; ++i)
    for (int j = 0; j < small.size; ++j)
      round.values[static_cast<std::size_t>(i * small.size + j)] = large.at(i + 40, j + 40);
  Kernel of_small(12), of_large(12);
  add(round, 1, 2.2, of_small);
  add(large, 1, 2.2, of_large);
  EXPECT_GT(of_small.sum(), 0.9);
  for (std::size_t i = 0; i < of_small.weights.size(); ++i)
    ASSERT_NEAR(of_small.weights[i], of_large.weights[i], 2e-7) << i;
}

// Windows of even size begin with a column that has no mirrored partner. Cut where there is light, as
// listings of other programs and our own tables are, they are PSFs of a centred lens all the same: four tiles
// share kernels.
TEST(PsfKernel, AnEvenWindowOfASymmetricPsfIsSymmetric) {
  const auto kernel_of = [](const Spot& spot, bool& symmetric) {
    TableRecipe recipe;
    recipe.psf = [&](double, double) { return psf_of_spots({spot}, 40, 0.5); };
    const PsfField psfs(make_table(recipe), 550, 2.0);
    symmetric = psfs.symmetry() == KernelSymmetry::mirrored;
    return psfs.kernel_at(0, 1);  // away from the axis is down
  };
  bool symmetric = false;
  const Kernel kernel = kernel_of({0, 1, 4, 3, 1}, symmetric);  // at its first column 0.04 of the peak
  EXPECT_TRUE(symmetric);
  double light_at_ends = 0;
  for (int row = -kernel.radius; row <= kernel.radius; ++row)
    for (int column = 1; column <= kernel.radius; ++column) {
      EXPECT_NEAR(kernel.at(row, column), kernel.at(row, -column), 1e-7) << row << ", " << column;
      if (column == 5) light_at_ends += kernel.at(row, column);
    }
  EXPECT_GT(light_at_ends, 1e-3);
  EXPECT_NEAR(kernel.sum(), 1, 1e-6);
  EXPECT_NEAR(kernel.moments().mean[0], 0, 1e-6);
  kernel_of({0.01, 1, 4, 3, 1}, symmetric);
  EXPECT_FALSE(symmetric);
}

TEST(PsfKernel, PointsAwayFromTheMiddleOfThePictureAtEightAzimuths) {
  for (const double lean : {0.0, 0.6}) {
    const LensDataTable table = make_table(comatic_recipe(lean));
    const PsfField psfs(table, 550, 3.0);
    EXPECT_EQ(psfs.symmetry(), lean == 0 ? KernelSymmetry::mirrored : KernelSymmetry::turned);
    const double height_mm = table.real_image_height_mm[3];
    const Psf& psf = table.psf[3];
    double mean_s = 0, mean_t = 0;  // of the samples [cells]
    for (int i = 0; i < psf.size; ++i)
      for (int j = 0; j < psf.size; ++j) {
        mean_s += double(psf.at(i, j)) * (j - psf.size / 2) * psf.spacing_um / 3.0;
        mean_t += double(psf.at(i, j)) * (i - psf.size / 2) * psf.spacing_um / 3.0;
      }
    ASSERT_GT(mean_t, 0.5);
    for (int eighth = 0; eighth < 8; ++eighth) {
      const double azimuth = eighth * pi / 4;
      const double right = std::cos(azimuth), down = std::sin(azimuth);
      const Kernel kernel = psfs.kernel_at(-right * height_mm, down * height_mm);
      const MomentsAlong tangential = moments_along(kernel, right, down);
      const MomentsAlong sagittal = moments_along(kernel, -down, right);
      // Integrated over cells, a smooth PSF keeps its centre of gravity: to the aliasing of a cell of 3 µm.
      EXPECT_NEAR(tangential.mean, mean_t, 2e-3) << eighth;
      EXPECT_NEAR(sagittal.mean, mean_s, 2e-3) << eighth;
      EXPECT_GT(tangential.third, 1) << eighth;
    }
  }
}

TEST(PsfKernel, SumsToOneWhateverTheCells) {
  const LensDataTable table = make_table(comatic_recipe(0.3));
  for (const double cell_um : {0.2, 0.5, 0.7, 3.0, 100.0}) {  // samples coarser than a cell, equal, finer
    const Kernel kernel = PsfField(table, 550, cell_um).kernel_at(0.5, -0.3);
    EXPECT_NEAR(kernel.sum(), 1, 1e-12) << cell_um;
  }
  // Nothing is lost before it is normalised either, to the rounding of what the lattice adds up as floats.
  Kernel lattice(60);
  add(table.psf[2], 1, 0.7, lattice);
  EXPECT_NEAR(lattice.sum(), std::accumulate(table.psf[2].values.begin(), table.psf[2].values.end(), 0.0),
              1e-6);
}

// A Gaussian that grows with height: halfway between two fields lies the Gaussian of a width in between, not
// a mixture of a narrow and a wide one, whose peak would be 3 % higher here.
TEST(PsfKernel, GrowsBetweenFields) {
  TableRecipe recipe;
  const auto sigma_um = [](double height_mm) { return 2 * std::sqrt(1 + std::pow(height_mm / 0.8, 2)); };
  recipe.psf = [&](double field, double) {
    const double sigma = sigma_um(recipe.height_mm(field, 550));
    return psf_of_spots({{0, 0, sigma, sigma, 1}}, 257, 0.25);
  };
  const LensDataTable table = make_table(recipe);
  const double height_mm = 0.5 * (table.real_image_height_mm[2] + table.real_image_height_mm[3]);
  const Kernel kernel = PsfField(table, 550, 1.0).kernel_at(0, height_mm);
  const double sigma = sigma_um(height_mm);
  for (const auto& [row, column] : {std::pair{0, 0}, {2, 1}, {-3, 3}, {5, 0}})
    EXPECT_NEAR(kernel.at(row, column) / gaussian_at_cell(row, column, 1.0, 0, {0, 0, sigma, sigma, 1}), 1,
                5e-3)
        << row << ", " << column;
}

TEST(PsfKernel, SamplesCoarserThanCellsAreSquares) {
  // One sample of 4 µm on cells of 1 µm: a square of 4 × 4 cells about the middle of a cell, so that the two
  // outer rows hold half.
  Kernel kernel(2);
  add(Psf{1, 4.0, {1.0F}, 1.0}, 1, 1.0, kernel);
  EXPECT_NEAR(kernel.at(0, 0), 1.0 / 16, 1e-12);
  EXPECT_NEAR(kernel.at(2, 0), 0.5 / 16, 1e-12);
  EXPECT_NEAR(kernel.at(-2, 2), 0.25 / 16, 1e-12);
}

// PSFs of one spread and different shape: between them lies the mixture that field_shares() says, at either
// wavelength.
TEST(PsfKernel, MixesFieldsAndWavelengths) {
  TableRecipe recipe;
  recipe.wavelengths_nm = {500, 600};
  recipe.height_mm = [](double field, double nm) { return field / 10 * (1 + (nm - 500) / 1000); };
  // Ever farther apart and ever narrower, of one spread.
  const auto pair = [](double field) {
    const double apart_um = field / 10, sigma_s_um = std::sqrt(4 - apart_um * apart_um);
    return std::vector<Spot>{{-apart_um, 0, sigma_s_um, 2, 1}, {apart_um, 0, sigma_s_um, 2, 1}};
  };
  recipe.psf = [&](double field, double nm) {
    return psf_of_spots(pair(field), nm < 550 ? 65 : 91, nm < 550 ? 0.5 : 0.6);
  };
  recipe.fields = {0, 5, 10, 15};
  const LensDataTable table = make_table(recipe);
  const double height_mm = 1.1;  // 500 nm: between 1.0 and 1.5, 0.2 of the way; 600 nm: at 1.1, field 10
  const PsfField between(table, 525, 2.0);
  const Kernel kernel = between.kernel_at(0, height_mm);
  Kernel expected(kernel.radius);
  const auto expect = [&](double field, double weight) {
    for (const Spot& spot : pair(field))
      for (int row = -kernel.radius; row <= kernel.radius; ++row)
        for (int column = -kernel.radius; column <= kernel.radius; ++column)
          expected.at(row, column) += weight / 2 * gaussian_at_cell(row, column, 2.0, pi / 2, spot);
  };
  for (const FieldShare& share : field_shares(std::vector<double>{0, 0.5, 1, 1.5}, height_mm))
    expect(table.fields[share.field], 0.75 * share.weight);
  expect(table.fields[2], 0.25);
  // 2 ‰ of the peak: four steps between fields. A linear mixture of two fields is 7 ‰ off.
  const double peak = *std::max_element(expected.weights.begin(), expected.weights.end());
  for (std::size_t i = 0; i < kernel.weights.size(); ++i)
    EXPECT_NEAR(kernel.weights[i], expected.weights[i], 3e-3 * peak);
}

TEST(PsfKernel, SaysItsReachBeforeItIsMade) {
  TableRecipe recipe = comatic_recipe(0.3);
  recipe.wavelengths_nm = {500, 600};
  LensDataTable table = make_table(recipe);
  table.psf[1].captured = 0.9;
  table.psf[2].captured = 0.8;
  const LightCentres centres(table);
  for (const double wavelength_nm : {500.0, 530.0, 600.0})
    for (const double cell_um : {1.0, 12.5}) {
      const PsfField psfs(table, wavelength_nm, cell_um, PsfInterpolation::psf, centres);
      const PsfReach reach = psf_reach(table, wavelength_nm, cell_um, centres);
      EXPECT_GT(reach.radius, 0);
      EXPECT_EQ(reach.radius, psfs.radius());
      EXPECT_EQ(reach.least_captured, psfs.least_captured());
    }
  EXPECT_EQ(psf_reach(table, 500, 1.0).least_captured, 0.8);
  EXPECT_EQ(psf_reach(table, 600, 1.0).least_captured, 0.9);
  EXPECT_THROW(psf_reach(table, 499, 1.0), InputError);
  EXPECT_THROW(psf_reach(table, 550, 1e-4), InputError);
}

// Kernels do not depend on whether what they share was made before.
TEST(PsfKernel, IsTheSameWhenPrepared) {
  const LensDataTable table = make_table(comatic_recipe(0.3));
  const PsfField prepared(table, 550, 12.5), as_it_comes(table, 550, 12.5);
  prepared.prepare({{0, 0}, {0, 0.1}, {0.4, 0}, {0, -0.4}, {2, 0}});
  for (const double height_mm : {0.1, 0.25, 0.4})
    EXPECT_EQ(prepared.kernel_at(0.6 * height_mm, 0.8 * height_mm).weights,
              as_it_comes.kernel_at(0.6 * height_mm, 0.8 * height_mm).weights);
}

TEST(PsfKernel, RefusesDamagedTablesAndForeignWavelengths) {
  LensDataTable table = make_table({});
  EXPECT_THROW(PsfField(table, 549.4, 3.0), InputError);
  EXPECT_NO_THROW(PsfField(table, 550.4, 3.0));  // a single wavelength serves ±0.5 nm
  EXPECT_THROW(PsfField(table, 550, 1e-4), InputError) << "a kernel of 10^11 weights";
  table.psf[2].values.pop_back();
  EXPECT_THROW(PsfField(table, 550, 3.0), InputError);
  table.psf[2] = Psf{1, 1.0, {0.0F}, 1.0};
  EXPECT_THROW(PsfField(table, 550, 3.0), InputError) << "a dark PSF";
}

// The shift theorem: halfway in modulus and phase between a point and the same point one cell on lies the
// point moved by half a cell, a sinc with negative lobes; halfway between the PSFs are two points of half the
// light.
TEST(OtfInterpolation, MovesWherePsfInterpolationBlends) {
  constexpr int radius = 8;
  Kernel here(radius), there(radius);
  here.at(0, 0) = 1;
  there.at(0, 1) = 1;
  const Kernel half = between_otfs(here, there, 0.5);
  for (int column = -3; column <= 4; ++column) {
    const double d = pi * (column - 0.5);
    // Periodic in 36 cells (the transform's size) instead of endless: sinc becomes sin d / (N tan(d/N)).
    EXPECT_NEAR(half.at(0, column), std::sin(d) / (36 * std::tan(d / 36)), 1e-12) << column;
    EXPECT_NEAR(half.at(1, column), 0, 1e-12);
  }
  EXPECT_NEAR(between_otfs(here, there, 0).at(0, 0), 1, 1e-12);
  EXPECT_NEAR(between_otfs(here, there, 1).at(0, 1), 1, 1e-12);
}

}  // namespace
}  // namespace petzval
