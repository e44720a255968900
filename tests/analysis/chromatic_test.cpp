// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/chromatic.h>
#include <petzval/analysis/seidel.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>

#include <cmath>

#include "golden_lenses.h"

namespace petzval {
namespace {

class GoldenColour : public GoldenLensTest {};

TEST_P(GoldenColour, AgreesWithAnotherProgram) {
  FieldTableRequest request = FieldTableRequest::of(lens);
  request.clip = Tracer::Clip::stop_only;
  const std::vector<LateralColourRow> rows = lateral_colour_table(lens, request);
  const std::size_t wavelengths = request.wavelengths_nm.size();
  int compared = 0;
  for (const nlohmann::json& field : reference["chief_rays"]["rows"])
    for (std::size_t i = 0; i < rows.size(); i += wavelengths) {
      if (rows[i].field != field["field_deg"].get<double>()) continue;
      ++compared;
      const double difference = rows[i].lateral_colour_um - rows[i + wavelengths - 1].lateral_colour_um;
      EXPECT_NEAR(difference * mm_per_um, field["lateral_colour_first_minus_last_mm"], 1e-9);
    }
  EXPECT_EQ(compared, 5);
  const std::vector<AxialFocusRow> axial = axial_focus_table(lens, request.wavelengths_nm, {0});
  const double back_mm = lens.surfaces.back().thickness_mm;
  for (std::size_t w = 0; w < wavelengths; ++w)
    EXPECT_NEAR(axial[w].focus_mm + back_mm, reference["first_order_per_wavelength"][w]["BFL"], 1e-9);
}

TEST_P(GoldenColour, OfRealZonesLiesOnTheReferenceRays) {
  // Rays of the axial point at (0, ±1) and (0, ±0.7…) of the stop cross the axis where their straight line
  // does.
  int compared = 0;
  for (const nlohmann::json& ray : reference["rays"]["rows"]) {
    const double zone = ray["stop_py"];
    if (ray["field_deg"] != 0 || ray["stop_px"] != 0 || !(zone > 0)) continue;
    ++compared;
    const double wavelength = ray["wavelength_um"].get<double>() * 1000;
    const double expected = -ray["image_xyz"][1].get<double>() * ray["image_dir"][2].get<double>() /
                            ray["image_dir"][1].get<double>();
    const AxialFocusRow row = axial_focus_table(lens, {wavelength}, {zone}, Tracer::Clip::stop_only).front();
    EXPECT_NEAR(row.focus_mm, expected, 1e-7);  // the reference's aim, times f/5
  }
  EXPECT_GE(compared, 3);
}

INSTANTIATE_TEST_SUITE_P(Lenses, GoldenColour, golden_lenses());

TEST(AxialFocus, TendsToTheParaxialOne) {
  // Longitudinal spherical aberration grows with the square of the zone: extrapolated from two small zones.
  const Lens lens = read_lens("cooke-triplet").lens;
  const std::vector<AxialFocusRow> rows = axial_focus_table(lens, {550}, {0, 0.05, 0.1});
  const double limit = rows[1].focus_mm - (rows[2].focus_mm - rows[1].focus_mm) / 3;
  EXPECT_NEAR(limit, rows[0].focus_mm, 1e-3 * std::abs(rows[2].focus_mm - rows[0].focus_mm));
  EXPECT_THROW(axial_focus_table(lens, {550}, {1.5}), InputError);
}

TEST(SeidelColour, IsTheParaxialFocalShift) {
  // CL = 2 W020 between the first and the last wavelength: δz = −CL/(n'u'²), for thin dispersion. Secondary
  // terms in δn/n are shares of a hundredth.
  const Lens lens = read_lens("petzval-lens").lens;
  const SeidelSums sums = seidel_sums(lens);
  const std::vector<AxialFocusRow> rows = axial_focus_table(
      lens, {lens.wavelengths_nm.front(), lens.wavelengths_nm.back()}, {0}, Tracer::Clip::stop_only);
  const double slope = first_order(lens).image_space_na;
  double largest = 0;
  for (const SeidelTerms& surface : sums.surfaces) largest = std::max(largest, std::abs(surface.cl));
  EXPECT_NEAR(rows[0].focus_mm - rows[1].focus_mm, -sums.sum.cl / (slope * slope),
              0.02 * largest / (slope * slope));
}

}  // namespace
}  // namespace petzval
