// SPDX-License-Identifier: BSD-3-Clause
// Ray transfers fitted to lenses, against those lenses ray by ray.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/transfer_fit.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/base/context.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/iset_transfer.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace petzval {
namespace {

/// The double Gauss at f/7.2 or so, as ISET's fit of it has it: a stop of 7 mm.
Lens stopped_down() {
  return with_setting(read_lens("dgauss-50mm").lens, "aperture.stop_semi_diameter_mm=3.5");
}

const TransferFit& fit_of_double_gauss() {
  static const TransferFit fit = fit_transfer(stopped_down());
  return fit;
}

TEST(TransferFit, EndsWhenTheContextSaysStop) {
  int questions = 0;
  Context context;
  context.progress = [&](double, const std::string&) { return ++questions < 2; };
  EXPECT_THROW(run_within(context, [](const ProgressCallback&) { fit_transfer(stopped_down()); }), Cancelled);
}

TEST(TransferFit, KeepsItsPromiseOnOtherRays) {
  const Lens lens = stopped_down();
  const TransferFit& fit = fit_of_double_gauss();
  EXPECT_LE(fit.determinant_error, 1e-9);
  EXPECT_NEAR(first_order(fit.lens).efl_mm, first_order(lens).efl_mm, 1e-9);
  for (const double nm : lens.wavelengths_nm) {
    FieldTracer real(lens, nm);
    const Tracer box(fit.lens, nm);
    for (const double field : lens.fields.values) {
      const auto chief = real.chief_ray(field);
      ASSERT_TRUE(chief);
      const auto pupil = real.object_pupil(*chief, 16);
      const Pencil pencil = Pencil::from_object(lens, field);
      for (const PupilNode& node : pupil_nodes(*pupil, 3)) {
        const Ray ray = *pencil.ray(node.u, node.v);
        const Ray a = real.tracer().trace(ray, Tracer::Clip::none), b = box.trace(ray, Tracer::Clip::none);
        ASSERT_EQ(b.status, RayStatus::ok);
        // The tolerance, 1e-4 mm in place and 1e-4 mm/f in direction, carried to the film: twice that at
        // most.
        EXPECT_NEAR(a.point_mm[0], b.point_mm[0], 2e-4);
        EXPECT_NEAR(a.point_mm[1], b.point_mm[1], 2e-4);
      }
    }
  }
}

TEST(TransferFit, GathersTheLightOfItsLens) {
  const Lens lens = stopped_down();
  FieldTracer real(lens, 550), box(fit_of_double_gauss().lens, 550);
  for (const double field : {0.0, 3.0, 6.0, 9.0}) {
    const auto a = real.chief_ray(field), b = box.chief_ray(field);
    ASSERT_TRUE(a && b);
    EXPECT_NEAR(box.g_sensor_sr(*b) / real.g_sensor_sr(*a), 1, 1e-4) << field;
    EXPECT_NEAR(box.g_source_sr(*b) / real.g_source_sr(*a), 1, 1e-3) << field;
  }
}

TEST(TransferFit, HasTheWavesOfItsLens) {
  const Lens lens = stopped_down();
  FieldTableRequest request;
  request.field_kind = lens.fields.kind;
  request.fields = {0, 5, 9};
  request.wavelengths_nm = {550};
  const auto a = wavefront_table(lens, request), b = wavefront_table(fit_of_double_gauss().lens, request);
  ASSERT_EQ(a.size(), b.size());
  // Slopes within 1e-4 mm/f over a pupil of 7 mm are paths within 1.4e-5 mm, 0.026 waves.
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i].rms_waves, b[i].rms_waves, 0.026);
}

TEST(TransferFit, IsTheSameInIsetsFormat) {
  const Lens& box = fit_of_double_gauss().lens;
  const Lens again = read_iset_transfer(JsonDocument(iset_transfer_text(box), "iset")).lens;
  const Tracer a(box, 550), b(again, 550);
  for (const double y : {-2.0, 0.5, 1.5}) {
    const Ray launched{{0.4, y, 0}, {0, 0.06, std::sqrt(1 - 0.0036)}};
    const Ray one = a.trace(launched, Tracer::Clip::none), two = b.trace(launched, Tracer::Clip::none);
    ASSERT_EQ(one.status, RayStatus::ok);
    ASSERT_EQ(two.status, RayStatus::ok);
    EXPECT_NEAR(one.direction[0], two.direction[0], 1e-10);
    EXPECT_NEAR(one.direction[1], two.direction[1], 1e-10);
  }
}

/// By how much rays of the lens, sent backwards from the film, differ in front from those of a box whose
/// planes stand `beyond_mm` before the first and behind the last vertex: place [mm] and direction.
struct Misses {
  std::vector<double> mm, rad;
};
Misses misses_of(const Lens& lens, const Lens& box, double beyond_mm) {
  const Tracer real(lens, 550), boxed(box, 550);
  const double rear_mm = real.vertex_z_mm(real.surface_count() - 1) + beyond_mm;
  ChiefRayMarch march(lens, real, ChiefRayMarch::From::image);
  Misses misses;
  for (double height = 0.2; height < 9; height += 0.4) {
    const Pencil pencil = Pencil::from_image(real, height);
    const auto pupil = find_pupil(real, pencil, *march.v_at(height), 32);
    for (const PupilNode& node : pupil_nodes(*pupil, 5)) {
      Ray ray = *pencil.ray(node.u, node.v);
      const Ray there = real.trace_backward(ray, Tracer::Clip::none);
      const double way = (rear_mm - ray.point_mm[2]) / ray.direction[2];
      const double back = (-beyond_mm - there.point_mm[2]) / there.direction[2];
      for (std::size_t k = 0; k < 2; ++k) ray.point_mm[k] += way * ray.direction[k];
      ray.point_mm[2] = boxed.vertex_z_mm(1);
      const Ray here = boxed.trace_backward(ray, Tracer::Clip::none);
      if (here.status != RayStatus::ok) continue;
      misses.mm.push_back(std::hypot(there.point_mm[0] + back * there.direction[0] - here.point_mm[0],
                                     there.point_mm[1] + back * there.direction[1] - here.point_mm[1]));
      misses.rad.push_back(
          std::hypot(there.direction[0] - here.direction[0], there.direction[1] - here.direction[1]));
    }
  }
  std::sort(misses.mm.begin(), misses.mm.end());
  std::sort(misses.rad.begin(), misses.rad.end());
  return misses;
}

TEST(TransferFit, IsAHundredTimesNearerThanThePublishedOne) {
  const std::string path = data_directory() +
                           "/../../shared/data/raytransfer/"
                           "dgauss.22deg.50.0mm-offset2mm-poly5-diaphragm7mm-raytransfer.json";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const Lens lens = stopped_down(), published = read_lens(path).lens;
  const TransferFit& fit = fit_of_double_gauss();
  EXPECT_LE(fit.terms, 2 * published.surfaces[0].transfer->terms.size());
  const Misses theirs = misses_of(lens, published, 2), ours = misses_of(lens, fit.lens, 0);
  ASSERT_EQ(theirs.mm.size(), ours.mm.size());
  EXPECT_LT(100 * ours.mm[ours.mm.size() / 2], theirs.mm[theirs.mm.size() / 2]);
  EXPECT_LT(100 * ours.rad[ours.rad.size() / 2], theirs.rad[theirs.rad.size() / 2]);
  EXPECT_LT(100 * ours.mm.back(), theirs.mm.back());
  EXPECT_LT(100 * ours.rad.back(), theirs.rad.back());
}

/// Rays of the double Gauss as another program would send them: from object points through the entrance
/// pupil, a grid, and a little beyond the stop's rim.
RayTable rays_of_double_gauss() {
  const Lens lens = stopped_down();
  const Tracer tracer(lens, 550);
  RayTable table;
  table.name = "Double Gauss by rays";
  const std::size_t last = tracer.surface_count() - 1, stop = lens.stop_index();
  table.length_mm = tracer.vertex_z_mm(last), table.film_mm = tracer.image_z_mm() - table.length_mm;
  table.aperture_radii_mm = {3.5};
  FieldTracer fields(lens, 550);
  for (int degree = 0; degree <= 10; ++degree) {
    const Pencil pencil = Pencil::from_object(lens, degree);
    const double chief = fields.chief_ray(degree)->v;
    for (int i = 0; i <= 11; ++i)
      for (int k = -11; k <= 11; ++k) {
        const Ray in = *pencil.ray(5.3 * i / 11, chief + 5.3 * k / 11);
        std::vector<Intersection> path;
        const Ray end = tracer.trace(in, Tracer::Clip::none, &path);
        if (end.status != RayStatus::ok) continue;
        const auto& at = path[stop].point_mm;
        if (std::hypot(at[0], at[1]) > 1.04 * 3.5) continue;
        const auto place = [](const Ray& ray, double z) {
          const double way = (z - ray.point_mm[2]) / ray.direction[2];
          return TransferRay{ray.point_mm[0] + way * ray.direction[0],
                             ray.point_mm[1] + way * ray.direction[1], -ray.direction[0], -ray.direction[1]};
        };
        table.rows.push_back({550, place(in, 0), place(end, table.length_mm), {{at[0], at[1]}}});
      }
  }
  return table;
}

TEST(TransferFit, NeedsRaysAloneAndNoLens) {
  const Lens lens = stopped_down();
  const RayTable table = ray_table_of(ray_table_text(rays_of_double_gauss()), "rays.csv");
  const TransferFit fit = fit_transfer(table);
  EXPECT_LE(fit.determinant_error, 1e-9);
  EXPECT_LE(fit.accuracy.worst_mm, 1e-4);
  EXPECT_FALSE(fit.accuracy.worst_light);
  // Its power is that of rays to the tenth of a micrometre over a stop of 10 mm.
  EXPECT_NEAR(first_order(fit.lens).efl_mm, first_order(lens).efl_mm, 1e-4 * 50);
  const Misses of = misses_of(lens, fit.lens, 0);
  EXPECT_LT(of.mm.back(), 2e-4);
  Lens by_angle = fit.lens;
  by_angle.fields = lens.fields;
  FieldTracer real(lens, 550), box(by_angle, 550);
  for (const double field : {0.0, 5.0, 9.0})
    EXPECT_NEAR(box.g_sensor_sr(*box.chief_ray(field)) / real.g_sensor_sr(*real.chief_ray(field)), 1, 1e-3);
}

// Nothing beyond the first order is wanted of a fit that may miss by a decimetre.
TEST(TransferFit, OfTheFirstOrderHasOneTerm) {
  const RayTable table = ray_table_of(ray_table_text(rays_of_double_gauss()), "rays.csv");
  const TransferFit fit = fit_transfer(table, {.tolerance_mm = 100});
  EXPECT_EQ(fit.lens.surfaces.front().transfer->terms.size(), 1U);
  EXPECT_LE(fit.determinant_error, 1e-9);
}

TEST(TransferFit, TablesThatAreWrongSayWhere) {
  const std::string text = ray_table_text(rays_of_double_gauss());
  const auto refused = [](const std::string& bad, const char* what) {
    try {
      fit_transfer(ray_table_of(bad, "rays.csv"));
      ADD_FAILURE() << what << " was taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  const std::size_t rows = text.find("\n550.0,") + 1;
  refused("", "holds no rays");
  refused(text.substr(0, rows), "holds no rays");
  refused(text.substr(text.find("wavelength_nm")), "length_mm");
  refused(text.substr(0, rows) + "550,1,2,3\n", "rays.csv:6: has 4 numbers for 11 columns");
  refused(text.substr(0, rows) + "550,0,0,x,0,0,0,0,0,0,0\n", "\"x\" is not a number");
  refused(text.substr(0, rows) + "550,0,0,1,0,0,0,0,0,0,0\n", "less than 1");
  refused(text.substr(0, rows) + "550,0,0,0,0,0,0,0,0,0,0\n", "some hundreds");
  refused(text.substr(0, text.find('\n', rows + 20000)), "rays");
}

TEST(TransferFit, RefusesWhatItCannotFit) {
  EXPECT_THROW(fit_transfer(fit_of_double_gauss().lens), InputError);
  TransferFitRequest request;
  request.tolerance_mm = 0;
  EXPECT_THROW(fit_transfer(stopped_down(), request), InputError);
  request.wavelengths_nm = {550};
  request.tolerance_mm = 1e-13;
  EXPECT_THROW(fit_transfer(stopped_down(), request), InputError);
}

}  // namespace
}  // namespace petzval
