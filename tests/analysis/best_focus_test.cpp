// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/best_focus.h>
#include <petzval/analysis/mtf.h>
#include <petzval/analysis/spots.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>

#include <cmath>

#include "golden_lenses.h"

namespace petzval {
namespace {

double rms_um(Lens lens, const FieldTableRequest& request, double shift_mm) {
  lens.surfaces.back().thickness_mm += shift_mm;
  return spot_table(lens, request).front().rms_radius_um;
}

TEST(BestSpotFocus, IsTheBottomOfTracedSpots) {
  const Lens lens = read_lens("double-gauss").lens;
  for (const double field : {0.0, 7.0, 14.0}) {
    FieldTableRequest request = FieldTableRequest::of(lens);
    request.fields = {field};
    request.wavelengths_nm = {587.5618};
    const BestFocus best = best_spot_focus(lens, request);
    const double step = 0.05;
    const double below = rms_um(lens, request, best.shift_mm - step),
                 at = rms_um(lens, request, best.shift_mm),
                 above = rms_um(lens, request, best.shift_mm + step);
    EXPECT_NEAR(best.before, rms_um(lens, request, 0), 1e-6);
    EXPECT_NEAR(best.after, at, 1e-6);
    // r² is a parabola in the shift: its bottom from three spots, to the rounding of the differences.
    const double bottom =
        0.5 * step * (below * below - above * above) / (below * below - 2 * at * at + above * above);
    EXPECT_NEAR(bottom, 0, 1e-6);
  }
}

TEST(BestSpotFocus, OfAPerfectLensIsItsFocus) {
  Lens lens;  // plano-hyperbolic, stigmatic on the axis
  Surface front, back;
  front.thickness_mm = 2;
  front.material = Material(Material::Constant{1.5});
  front.stop = true;
  back.curvature_per_mm = -1.0 / 20;
  back.conic = -2.25;
  back.thickness_mm = 40.3;
  lens.surfaces = {front, back};
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 4};
  lens.wavelengths_nm = {550};
  lens.reference_wavelength_nm = 550;
  const FieldTableRequest request = FieldTableRequest::of(lens);
  const BestFocus spot = best_spot_focus(lens, request), mtf = best_mtf_focus(lens, request, 50);
  EXPECT_NEAR(spot.shift_mm, -0.3, 1e-9);
  EXPECT_NEAR(spot.after, 0,
              1e-5);  // µm: the root of rounding, 1e-16 of the square of the beam's 4 mm · 0.01
  EXPECT_NEAR(mtf.shift_mm, -0.3, 1e-4);
  EXPECT_GT(mtf.after, mtf.before + 0.3);
}

TEST(BestSpotFocus, CountsAllWavelengthsAndFields) {
  // Weight on one wavelength alone is that wavelength alone; together they lie between.
  const Lens lens = read_lens("petzval-lens").lens;
  FieldTableRequest request = FieldTableRequest::of(lens), blue = request, red = request;
  blue.wavelengths_nm = {request.wavelengths_nm.front()};
  red.wavelengths_nm = {request.wavelengths_nm.back()};
  std::vector<double> first(request.wavelengths_nm.size(), 0.0);
  first.front() = 3;
  EXPECT_NEAR(best_spot_focus(lens, request, first).shift_mm, best_spot_focus(lens, blue).shift_mm, 1e-12);
  EXPECT_THROW(best_spot_focus(lens, request, {1}), InputError);
  EXPECT_THROW(best_spot_focus(lens, request, std::vector<double>(first.size(), 0.0)), InputError);
  EXPECT_THROW(best_mtf_focus(lens, request, 0), InputError);
}

TEST(BestMtfFocus, IsNoWorseThanItsNeighbours) {
  const Lens lens = read_lens("cooke-triplet").lens;
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.fields = {0, 14};
  const BestFocus best = best_mtf_focus(lens, request, 30);
  const auto mean = [&](double shift_mm) {
    Lens moved = lens;
    moved.surfaces.back().thickness_mm += shift_mm;
    MtfOptions options;
    options.frequencies_cpmm = {30};
    options.weights = {1, 1, 1};
    double sum = 0;
    for (const MtfRow& row : mtf_table(moved, request, options)) sum += (row.tangential + row.sagittal) / 4;
    return sum;
  };
  const double top = mean(best.shift_mm);
  EXPECT_NEAR(best.after, top, 1e-4);  // through the moved sensor and through another last thickness
  EXPECT_NEAR(best.before, mean(0), 1e-4);
  for (const double step : {-0.02, 0.02, -0.1, 0.1, 0.3}) EXPECT_LT(mean(best.shift_mm + step), top + 1e-5);
}

}  // namespace
}  // namespace petzval
