// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/footprints.h>
#include <petzval/analysis/vignetting.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cmath>

namespace petzval {
namespace {

FieldTableRequest at_fields(const Lens& lens, std::vector<double> fields) {
  FieldTableRequest request;
  request.fields = std::move(fields);
  request.wavelengths_nm = {lens.reference_wavelength_nm};
  return request;
}

TEST(Footprints, StayWithinEveryClearApertureAndTouchOne) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  const auto all = footprints(lens, at_fields(lens, {0, 12, 22}));
  ASSERT_EQ(all.size(), 3 * lens.surfaces.size());
  for (std::size_t f = 0; f < 3; ++f) {
    double nearest = HUGE_VAL;
    for (std::size_t s = 0; s < lens.surfaces.size(); ++s) {
      const Footprint& each = all[3 * s + f];
      EXPECT_EQ(each.surface, static_cast<int>(s));
      double reach = 0;
      for (std::size_t k = 0; k < each.x_mm.size(); ++k)
        reach = std::max(reach, std::hypot(each.x_mm[k], each.y_mm[k]));
      const double room = lens.surfaces[s].semi_diameter_mm.value() - reach;
      EXPECT_GT(room, -1e-6) << "surface " << s;
      nearest = std::min(nearest, room);
    }
    EXPECT_LT(nearest, 1e-6) << "something ends the light";
  }
}

TEST(Footprints, FillAsMuchOfTheStopAsVignettingSays) {
  // Two ways to one area: outlines by rays along the rim, and the stop's area by its own boundary.
  const Lens lens = read_lens("dgauss-50mm").lens;
  const FieldTableRequest request = at_fields(lens, {0, 7, 15, 22});
  const auto all = footprints(lens, request, 512);
  const auto rows = vignetting_table(lens, request);
  const double radius = lens.surfaces[lens.stop_index()].semi_diameter_mm.value();
  for (std::size_t f = 0; f < rows.size(); ++f)
    EXPECT_NEAR(all[4 * lens.stop_index() + f].area_mm2() / (pi * radius * radius), rows[f].open_share, 1e-3);
}

TEST(Footprints, SayWhatTheyCannotDo) {
  Lens lens = read_lens("dgauss-50mm").lens;
  EXPECT_THROW(footprints(lens, at_fields(lens, {85})), InputError);
}

/// Corresponding points of two lists of footprints are no farther apart than this.
void expect_same(const std::vector<Footprint>& some, const std::vector<Footprint>& others, double within_mm) {
  ASSERT_EQ(some.size(), others.size());
  for (std::size_t i = 0; i < some.size(); ++i) {
    ASSERT_EQ(some[i].x_mm.size(), others[i].x_mm.size());
    for (std::size_t k = 0; k < some[i].x_mm.size(); ++k)
      ASSERT_LT(std::hypot(some[i].x_mm[k] - others[i].x_mm[k], some[i].y_mm[k] - others[i].y_mm[k]),
                within_mm)
          << "surface " << some[i].surface << ", field " << some[i].field;
  }
}

TEST(Footprints, AreThoseOfTheCentredLensWhereItStandsElsewhereAsAWhole) {
  // Light from infinity does not know where a lens stands: its own surfaces see the same.
  Lens lens = read_lens("dgauss-50mm").lens;
  lens.groups = {{.first = 0, .last = lens.surfaces.size(), .pose = {.decentre_x_mm = 1e-12}}};
  const auto near = footprints(lens, at_fields(lens, {0, 12}));
  lens.groups.front().pose = {.decentre_x_mm = 2, .decentre_y_mm = -3, .shift_z_mm = 1};
  expect_same(footprints(lens, at_fields(lens, {0, 12})), near, 1e-6);
}

TEST(Footprints, TurnWithTheFieldButNotWithTheSurfaces) {
  // The field turned by 90 degrees is the lens with its decentre turned back, seen from there.
  Lens lens = read_lens("cooke-triplet").lens;
  FieldTableRequest at = at_fields(lens, {14});
  lens.surfaces[2].pose.decentre_y_mm = 0.3;
  lens.surfaces[3].pose.decentre_y_mm = 0.3;
  const auto along = footprints(lens, at);
  for (const std::size_t s : {2, 3}) lens.surfaces[s].pose = {.decentre_x_mm = -0.3};
  at.azimuth_deg = 90;
  auto across = footprints(lens, at);
  for (Footprint& each : across)
    for (std::size_t k = 0; k < each.x_mm.size(); ++k) {
      const double x = each.x_mm[k], y = each.y_mm[k];
      each.x_mm[k] = y, each.y_mm[k] = -x;
    }
  expect_same(across, along, 1e-6);
}

TEST(Footprints, OnAMirrorThatFoldsCutTheConeOfLightAslant) {
  // Rim rays of the axis make one cone. Planes across it at two places say which; a plane at 45 degrees cuts
  // it at t = r / (cos 45 ± tan a sin 45) from the axis, r the cone's radius there and a its half-angle.
  Lens lens = read_lens("cooke-triplet").lens;
  const double back_mm = lens.surfaces.back().thickness_mm, before_mm = 20;
  const auto radius_behind = [&](double distance_mm) {
    Lens straight = lens;
    straight.surfaces.back().thickness_mm = distance_mm;
    straight.surfaces.push_back(Surface::sphere(HUGE_VAL, back_mm - distance_mm));
    const auto all = footprints(straight, at_fields(straight, {0}));
    return std::hypot(all.back().x_mm.front(), all.back().y_mm.front());
  };
  const double radius = radius_behind(before_mm), slope = radius - radius_behind(before_mm + 1);
  Surface mirror = Surface::sphere(HUGE_VAL, before_mm - back_mm);
  mirror.mirror = true;
  lens.surfaces.back().thickness_mm = before_mm;
  lens.surfaces.push_back(mirror);
  const std::size_t last = lens.surfaces.size();
  lens.groups = {{last - 1, last, {0, 0, 0, 45, 0, 0}, 0},
                 {last, last, {0, 0, 0, 45, 0, 0}, back_mm - before_mm}};
  const Footprint folded = footprints(lens, at_fields(lens, {0}), 512).back();
  const auto [low, high] = std::ranges::minmax(folded.y_mm);
  const double c = std::sqrt(0.5);
  EXPECT_NEAR(std::min(-low, high), radius / (c * (1 + slope)), 1e-4);
  EXPECT_NEAR(std::max(-low, high), radius / (c * (1 - slope)), 1e-4);
}

}  // namespace
}  // namespace petzval
