// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/distortion_grid.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>

#include <cmath>

namespace petzval {
namespace {

TEST(DistortionGrid, HasTheDistortionOfItsFields) {
  // Along radii it is the table's, which knows nothing of grids: (real − ideal)/ideal about the centre.
  for (const char* name : {"dgauss-50mm", "wide-22mm", "telecentric-0.5x"}) {
    const Lens lens = read_lens(name).lens;
    const double nm = lens.reference_wavelength_nm;
    const FrameSize frame = *frame_of_fields(lens);
    const DistortionGrid grid = distortion_grid(lens, frame, nm, 9);
    for (std::size_t i = 0; i < grid.x_mm.size(); ++i) {
      const double ideal = std::hypot(grid.ideal_x_mm[i], grid.ideal_y_mm[i]);
      if (ideal < 1e-9) continue;
      FieldTableRequest request;
      request.wavelengths_nm = {nm};
      // The field of an ideal image at this height.
      const double per_mm = lens.object_distance_mm ? 1 / std::abs(first_order(lens, nm).magnification) : 0;
      const double efl = first_order(lens, nm).efl_mm;
      request.fields = {lens.object_distance_mm ? ideal * per_mm : degrees(std::atan(ideal / efl))};
      request.field_kind = lens.object_distance_mm ? Fields::Kind::object_height_mm : Fields::Kind::angle_deg;
      request.clip = Tracer::Clip::none;
      const DistortionRow row = distortion_table(lens, request)[0];
      // The grid's ideal is the real magnification of the middle, the first-order one its paraxial limit.
      EXPECT_NEAR(std::hypot(grid.x_mm[i], grid.y_mm[i]) / ideal - 1, row.distortion_percent / 100, 5e-4)
          << name << ' ' << i;
      EXPECT_NEAR(std::atan2(grid.y_mm[i], grid.x_mm[i]), std::atan2(grid.ideal_y_mm[i], grid.ideal_x_mm[i]),
                  1e-9);
    }
  }
}

TEST(DistortionGrid, OfALensMovedAsAWholeIsTheSameBesideItsPlace) {
  const Lens lens = read_lens("wide-22mm").lens;
  Lens moved = lens;
  moved.groups = {{0, lens.surfaces.size() - 1, {0.5, -0.3, 0, 0, 0, 0}, 0}};
  const FrameSize frame = *frame_of_fields(lens);
  const DistortionGrid own = distortion_grid(lens, frame, 550, 5),
                       other = distortion_grid(moved, frame, 550, 5);
  for (std::size_t i = 0; i < own.x_mm.size(); ++i) {
    EXPECT_NEAR(other.x_mm[i], own.x_mm[i] + 0.5, 1e-7);
    EXPECT_NEAR(other.y_mm[i], own.y_mm[i] - 0.3, 1e-7);
  }
}

TEST(DistortionGrid, RefusesWhatIsNone) {
  const Lens lens = read_lens("wide-22mm").lens;
  EXPECT_THROW(distortion_grid(lens, {30, 20}, 550, 4), InputError);
  EXPECT_THROW(distortion_grid(lens, {0, 20}, 550), InputError);
}

}  // namespace
}  // namespace petzval
