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
  lens.surfaces[1].pose.tilt_x_deg = 1;
  EXPECT_THROW(footprints(lens, at_fields(lens, {0})), InputError);
}

}  // namespace
}  // namespace petzval
