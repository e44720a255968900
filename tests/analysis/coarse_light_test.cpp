// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/analysis/pupil_fit.h>
#include <petzval/lens/lens_file.h>

#include <cmath>
#include <map>
#include <vector>

namespace petzval {
namespace {

using Cells = std::map<std::pair<int, int>, double>;

/// A kernel as image formation has it (docs/IMAGE_FORMATION.md): at the middles of cells the light of a PSF,
/// each sample a square, seen through a Gaussian of 0.65 cells; the chief ray in the middle of a cell.
Cells in_cells(const Psf& psf, double cell_um) {
  constexpr double window = 0.65;
  constexpr int reach = 3;
  const double side = psf.spacing_um / cell_um;
  const auto below = [&](double cells) { return std::erf(cells / (window * std::sqrt(2.0))) / 2; };
  const auto seen = [&](int sample) {
    const double middle = (sample - psf.size / 2) * side;
    std::map<int, double> of;
    for (int cell = int(std::floor(middle)) - reach; cell <= int(std::ceil(middle)) + reach; ++cell)
      of[cell] = (below(middle + side / 2 - cell) - below(middle - side / 2 - cell)) / side;
    return of;
  };
  std::vector<std::map<int, double>> lines;
  for (int sample = 0; sample < psf.size; ++sample) lines.push_back(seen(sample));
  Cells cells;
  for (int row = 0; row < psf.size; ++row) {
    std::map<int, double> of_row;
    for (int column = 0; column < psf.size; ++column)
      for (const auto& [s, share] : lines[static_cast<std::size_t>(column)])
        of_row[s] += share * double(psf.at(row, column));
    for (const auto& [t, share] : lines[static_cast<std::size_t>(row)])
      for (const auto& [s, light] : of_row) cells[{t, s}] += share * light;
  }
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
  for (const double tolerance : {1e-2, 5e-2}) {
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
