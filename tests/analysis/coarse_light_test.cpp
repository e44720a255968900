// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/pupil_fit.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace petzval {
namespace {

using Cells = std::map<std::pair<int, int>, double>;

/// The light of a PSF in square cells, the chief ray in the middle of one: each sample shared out as a
/// square.
Cells in_cells(const Psf& psf, double cell_um) {
  const auto shares = [&](int sample) {
    const double middle = (sample - psf.size / 2) * psf.spacing_um / cell_um + 0.5,
                 half = psf.spacing_um / cell_um / 2;
    std::map<int, double> of;
    for (int cell = int(std::floor(middle - half)); cell <= int(std::floor(middle + half)); ++cell)
      of[cell] = (std::min(middle + half, cell + 1.0) - std::max(middle - half, double(cell))) / (2 * half);
    return of;
  };
  Cells cells;
  for (int row = 0; row < psf.size; ++row)
    for (int column = 0; column < psf.size; ++column)
      if (const double light = double(psf.at(row, column)); light > 0)
        for (const auto& [t, of_t] : shares(row))
          for (const auto& [s, of_s] : shares(column)) cells[{t, s}] += light * of_t * of_s;
  return cells;
}

struct CoarseCase {
  const char* lens;
  double field_deg, pixel_um;
};
class CoarseLightOf : public testing::TestWithParam<CoarseCase> {};

// What a preview may be off by, in the measure by which it is planned: √(Σd²/(1 + Σh²)) over the cells of a
// picture with one to a pixel.
TEST_P(CoarseLightOf, KeepsItsToleranceInCells) {
  const CoarseCase& of = GetParam();
  FieldTracer tracer(read_lens(of.lens).lens, 550);
  const ChiefRay chief = tracer.chief_ray(of.field_deg).value();
  const Cells reference = in_cells(point_spread(fit_pupil(tracer, chief).value()), of.pixel_um);
  for (const double tolerance : {1e-2, 3e-3}) {
    PsfOptions options;
    options.coarse = {of.pixel_um / 2, tolerance};
    const Psf coarse = point_spread(fit_pupil(tracer, chief, PupilFitLimits::coarse()).value(), options);
    Cells difference = in_cells(coarse, of.pixel_um);
    double light = 0, missed = 0;
    for (const auto& [cell, value] : reference) {
      light += value * value;
      difference[cell] -= value;
    }
    for (const auto& [cell, value] : difference) missed += value * value;
    EXPECT_LT(std::sqrt(missed / (1 + light)), tolerance);
  }
}
INSTANTIATE_TEST_SUITE_P(Bundled, CoarseLightOf,
                         testing::Values(CoarseCase{"dgauss-50mm", 0, 54}, CoarseCase{"dgauss-50mm", 14, 54},
                                         CoarseCase{"dgauss-50mm", 14, 8}, CoarseCase{"edmund-54852", 0, 7.5},
                                         CoarseCase{"edmund-54852", 20, 7.5},
                                         CoarseCase{"edmund-54852", 20, 50},
                                         CoarseCase{"wide-22mm", 25, 54}));

TEST(CoarseLight, LeavesFinePsfsAlone) {
  EXPECT_FALSE(CoarseLight{}.any());
  EXPECT_FALSE(CoarseLight{}.rays_serve(1));
  EXPECT_EQ(CoarseLight{}.spacing_um(), 0);
}

}  // namespace
}  // namespace petzval
