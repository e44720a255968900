// SPDX-License-Identifier: BSD-3-Clause
// Gratings, ideal lenses and immersed objects in files.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/lens/formats/native.h>
#include <petzval/lens/formats/seq.h>
#include <petzval/lens/formats/zmx.h>

#include <string>

namespace petzval {
namespace {

Lens bent_lens() {
  Lens lens;
  lens.name = "bent";
  lens.object_distance_mm = 120;
  lens.object_material = Material(Material::Constant{1.33});
  lens.aperture = {Aperture::Kind::entrance_pupil_diameter_mm, 6};
  lens.wavelengths_nm = {550};
  lens.reference_wavelength_nm = 550;
  lens.surfaces = {Surface::sphere(60, 4, glass_material("SCHOTT:N-BK7")), Surface::sphere(-80, 5),
                   Surface::sphere(300, 6), Surface::sphere(INFINITY, 40)};
  lens.surfaces[0].stop = true;
  lens.surfaces[2].grating = Grating{600, -2, 0};
  lens.surfaces[3].ideal_lens = IdealLens{45};
  return lens;
}

void expect_same_bends(const Lens& a, const Lens& b) {
  EXPECT_NEAR(a.object_material.index(550), b.object_material.index(550), 1e-15);
  ASSERT_EQ(a.surfaces.size(), b.surfaces.size());
  for (std::size_t i = 0; i < a.surfaces.size(); ++i) {
    const Surface &left = a.surfaces[i], &right = b.surfaces[i];
    ASSERT_EQ(left.grating.has_value(), right.grating.has_value());
    if (left.grating) {
      EXPECT_NEAR(left.grating->lines_per_mm, right.grating->lines_per_mm,
                  1e-12 * left.grating->lines_per_mm);
      EXPECT_EQ(left.grating->order, right.grating->order);
      EXPECT_NEAR(left.grating->rotation_deg, right.grating->rotation_deg, 1e-12);
    }
    ASSERT_EQ(left.ideal_lens.has_value(), right.ideal_lens.has_value());
    if (left.ideal_lens) {
      EXPECT_EQ(left.ideal_lens->focal_length_mm, right.ideal_lens->focal_length_mm);
    }
  }
}

TEST(BendFiles, NativeHoldsAll) {
  Lens lens = bent_lens();
  lens.surfaces[2].grating->rotation_deg = 30;
  expect_same_bends(lens_from_json(lens_to_json(lens), "a.json", {}), lens);
  const std::string text = lens_to_json(lens);
  EXPECT_NE(text.find("\"grating\": {\"lines_per_mm\": 600.0, \"order\": -2.0, \"rotation_deg\": 30.0}"),
            std::string::npos)
      << text;
}

TEST(BendFiles, ZmxHoldsAll) {
  const std::string text = zmx_text(bent_lens());
  expect_same_bends(read_zmx(text, "a.zmx", {}).lens, bent_lens());
  // Zemax counts lines per micrometre.
  EXPECT_NE(text.find("TYPE DGRATING\n  PARM 1 0.6\n  PARM 2 -2"), std::string::npos) << text;
  Lens turned = bent_lens();
  turned.surfaces[2].grating->rotation_deg = 30;
  EXPECT_THROW(zmx_text(turned), InputError);
}

TEST(BendFiles, SeqHoldsGratings) {
  Lens lens = bent_lens();
  EXPECT_THROW(seq_text(lens), InputError);  // CODE V's ideal lens is a module, which is not read
  lens.surfaces[3].ideal_lens.reset();
  lens.surfaces[2].grating->rotation_deg = 30;
  expect_same_bends(read_seq(seq_text(lens), "a.seq", {}).lens, lens);
}

}  // namespace
}  // namespace petzval
