// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/surface_order.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_file.h>

#include <string>

namespace petzval {
namespace {

/// What is said of a lens; empty: nothing.
std::string said_of(const Lens& lens) {
  try {
    require_surfaces_in_order(lens);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SurfaceOrder, IsBrokenWhereAPoseCarriesASurfacePastTheNext) {
  // The gap is 6.00755 mm on the axis, and wider towards the rim: nothing crosses until that is used up
  // there.
  Lens lens = read_lens("cooke-triplet").lens;
  lens.surfaces[1].pose.shift_z_mm = 5.5;
  EXPECT_EQ(said_of(lens), "");
  lens.surfaces[1].pose.shift_z_mm = 6.5;
  EXPECT_NE(said_of(lens).find("surfaces[1] and surfaces[2] cross by their poses"), std::string::npos)
      << said_of(lens);
}

TEST(SurfaceOrder, IsBrokenWhereATiltCarriesARimThroughTheNextSurface) {
  Lens lens = read_lens("cooke-triplet").lens;
  lens.surfaces[2].pose.tilt_x_deg = 5;
  EXPECT_EQ(said_of(lens), "");
  lens.surfaces[2].pose.tilt_x_deg = 45;
  EXPECT_NE(said_of(lens).find("surfaces[2] and surfaces[3] cross"), std::string::npos) << said_of(lens);
}

TEST(SurfaceOrder, DoesNotAskPlanesBetweenEqualMediaNorGapsThatTheDesignHasSo) {
  Lens lens = read_lens("cooke-triplet").lens;
  // A plane that bends nothing, drawn 3 mm in front of the surface before it.
  lens.surfaces[1].thickness_mm += 3;
  Surface plane = Surface::sphere(HUGE_VAL, 0);
  lens.surfaces.insert(lens.surfaces.begin() + 2, plane);
  lens.surfaces[2].thickness_mm = -3;
  lens.surfaces[2].pose.shift_z_mm = -12;
  EXPECT_EQ(said_of(lens), "");

  Lens negative = read_lens("cooke-triplet").lens;
  negative.surfaces[3].thickness_mm = -1;
  negative.surfaces[0].pose.tilt_x_deg = 0.01;
  EXPECT_EQ(said_of(negative), "");
}

TEST(SurfaceOrder, HoldsBehindMirrorsWhereLightRunsBack) {
  Lens lens = read_lens("cooke-triplet").lens;
  Surface mirror = Surface::sphere(HUGE_VAL, -10);
  mirror.mirror = true;
  lens.surfaces.back().thickness_mm = 20;
  lens.surfaces.push_back(mirror);
  lens.surfaces.push_back(Surface::sphere(HUGE_VAL, -1, glass_material("SCHOTT:N-BK7")));
  lens.surfaces.push_back(Surface::sphere(HUGE_VAL, -11));
  lens.surfaces.back().pose.tilt_x_deg = 0.5;
  EXPECT_EQ(said_of(lens), "");
  lens.surfaces.back().pose.shift_z_mm = 1.5;
  EXPECT_NE(said_of(lens).find("surfaces[7] and surfaces[8] cross"), std::string::npos) << said_of(lens);
}

}  // namespace
}  // namespace petzval
