// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/build.h>

#include <cmath>

namespace petzval {
namespace {

TableOptions small(std::vector<double> wavelengths_nm, double max_image_height_mm) {
  TableOptions options;
  options.wavelengths_nm = std::move(wavelengths_nm);
  options.max_image_height_mm = max_image_height_mm;
  options.field_count = 5;
  options.psf_size = 32;
  return options;
}

TEST(BuildTable, ReachesTheAskedHeightAndAPsfRadiusMore) {
  const Lens lens = read_lens("edmund-54852").lens;
  const LensDataTable table = build_lens_data_table(lens, small({486.13, 587.56, 656.27}, 2.5));
  ASSERT_EQ(table.fields.size(), 5u);
  EXPECT_EQ(table.fields.front(), 0);
  for (std::size_t w = 0; w < 3; ++w) {
    EXPECT_GT(table.real_image_height_mm[table.index(4, w)], 2.5);
    EXPECT_LT(table.real_image_height_mm[table.index(4, w)], 2.65);
    EXPECT_EQ(table.real_image_height_mm[table.index(0, w)], 0);
  }
  EXPECT_TRUE(table.finite_object());
  EXPECT_DOUBLE_EQ(table.vertex_to_sensor_mm, lens.total_track_mm());
  EXPECT_EQ(table.stop_semi_diameter_mm, stop_radius_mm(lens));
  EXPECT_GT(std::abs(*table.stop_semi_diameter_mm - table.first_order.stop_semi_diameter_mm), 1e-6)
      << "the paraxial one is another";
}

TEST(BuildTable, HoldsWhatTheFieldTracerSays) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  const LensDataTable table = build_lens_data_table(lens, small({550}, 10));
  FieldTracer tracer(lens, 550);
  for (std::size_t f = 0; f < table.fields.size(); ++f) {
    const ChiefRay chief = *tracer.chief_ray(table.fields[f]);
    EXPECT_NEAR(table.real_image_height_mm[f], chief.image_height_mm, 1e-9);
    EXPECT_NEAR(table.g_sensor_sr[f], tracer.g_sensor_sr(chief), 1e-9);
    // The tracer's boundary of 256 azimuths cuts the corners of a vignetted pupil.
    EXPECT_NEAR(table.g_source_sr[f] / tracer.g_source_sr(chief), 1, f == 0 ? 1e-7 : 5e-5);
  }
}

TEST(BuildTable, CountsLosses) {
  const Lens lens = read_lens("cooke-triplet").lens;
  TableOptions options = small({550}, 8);
  const LensDataTable clear = build_lens_data_table(lens, options);
  options.losses.air_glass = Coating::constant(0.01);
  const LensDataTable coated = build_lens_data_table(lens, options);
  options.losses = {};
  options.losses.fresnel = true;
  const LensDataTable bare = build_lens_data_table(lens, options);
  for (std::size_t f = 0; f < clear.fields.size(); ++f) {
    EXPECT_NEAR(coated.g_source_sr[f] / clear.g_source_sr[f], std::pow(0.99, 6), 1e-9);
    EXPECT_NEAR(coated.g_sensor_sr[f] / clear.g_sensor_sr[f], std::pow(0.99, 6), 1e-5)
        << "nodes for the area";
    FieldTracer tracer(lens, 550);
    tracer.set_losses(options.losses);
    const ChiefRay chief = *tracer.chief_ray(bare.fields[f]);
    EXPECT_NEAR(bare.g_source_sr[f] / tracer.g_source_sr(chief), 1, 1e-4);
    EXPECT_NEAR(bare.g_sensor_sr[f] / tracer.g_sensor_sr(chief), 1, 1e-11) << "chief rays to rounding";
    EXPECT_LT(bare.g_source_sr[f], 0.75 * clear.g_source_sr[f]) << "five per cent and more at six surfaces";
  }
  EXPECT_NE(coated.provenance, clear.provenance);
}

TEST(BuildTable, HoldsTheLightOfADefocusedLens) {
  // Focused at infinity, object at 2 m: blur discs of 0.6 mm and more, which must not be cut to a window.
  Lens lens = read_lens("dgauss-50mm").lens;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, stop_radius_mm(lens)};
  lens.object_distance_mm = 2000;
  lens.fields = {Fields::Kind::object_height_mm, {0, 400}};
  for (const int size : {0, 64}) {
    TableOptions options = small({500, 600}, 8);
    options.psf_size = size;
    const LensDataTable table = build_lens_data_table(lens, options);
    for (const Psf& psf : table.psf) {
      EXPECT_GE(psf.captured, 0.99);
      EXPECT_LE(psf.size, size > 0 ? size : options.largest_psf_size);
      EXPECT_GT(2 * psf.half_width_um(), 600);
    }
  }
}

TEST(BuildTable, EndsAtTheLastFieldThatPasses) {
  // 60 mm lies far outside the image circle of the 22 mm wide-angle lens.
  const Lens lens = read_lens("wide-22mm").lens;
  const LensDataTable table = build_lens_data_table(lens, small({550}, 60));
  EXPECT_LT(table.real_image_height_mm.back(), 60);
  EXPECT_GT(table.g_sensor_sr.back(), 0);
  FieldTracer tracer(lens, 550);
  const std::optional<ChiefRay> beyond = tracer.chief_ray(table.fields.back() * 1.02);
  EXPECT_TRUE(!beyond || tracer.g_sensor_sr(*beyond) < 0.2 * table.g_sensor_sr.back());
}

// The image of this lens turns back at 35.2 degrees for 400 nm, at 35.6 for 550, says `petzval lens
// distortion`.
TEST(BuildTable, EndsBeforeTheImageTurnsBack) {
  Lens lens = read_lens("edmund-54852").lens;
  lens.object_distance_mm.reset();
  TableOptions options = small({400, 410, 420, 430, 440, 450, 550, 700}, 3);
  for (const double height_mm : {3.24, 3.6, 5.0}) {
    options.max_image_height_mm = height_mm;
    const LensDataTable table = build_lens_data_table(lens, options);  // whose heights rise, or it says so
    EXPECT_GT(table.fields.back(), 34);
    for (const double g_sr : table.g_source_sr) EXPECT_LE(g_sr, 4 * pi);
  }
}

TEST(BuildTable, IsTheSameForAnyNumberOfThreads) {
  const Lens lens = read_lens("edmund-54852").lens;
  const TableOptions options = small({500, 600}, 1.5);
  const LensDataTable many = build_lens_data_table(lens, options);
  const ThreadLimit one(1);
  const LensDataTable single = build_lens_data_table(lens, options);
  EXPECT_EQ(many.fields, single.fields);
  EXPECT_EQ(many.g_source_sr, single.g_source_sr);
  for (std::size_t i = 0; i < many.psf.size(); ++i) EXPECT_EQ(many.psf[i].values, single.psf[i].values);
}

TEST(BuildTable, SaysWhenNoRayPasses) {
  Lens lens = read_lens("edmund-54852").lens;
  lens.surfaces[5].semi_diameter_mm = 0;  // not even a pinhole
  EXPECT_THROW(build_lens_data_table(lens, small({550}, 1)), InputError);
  TableOptions options = small({-5}, 1);
  EXPECT_THROW(build_lens_data_table(read_lens("edmund-54852").lens, options), InputError);
}

}  // namespace
}  // namespace petzval
