// SPDX-License-Identifier: BSD-3-Clause
// Tables that are made for an image, over the frame and by height: against the same light by other ways.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/pupil_rays.h>
#include <petzval/base/error.h>
#include <petzval/base/scratch_folder.h>
#include <petzval/base/units.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/image_table.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/build.h>
#include <petzval/optics/table_file.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "counted_light.h"

namespace petzval {
namespace {

constexpr double nm = 550;
using Places = TableOptions::Places;

Lens far_gauss() {
  MountedLens camera(read_lens("dgauss-50mm").lens);
  camera.focus_at_m({});
  return camera.lens();
}

LensDataTable table_of(const Lens& lens, const SensorGeometry& sensor, Places places = Places::automatic) {
  TableOptions options;
  options.wavelengths_nm = {nm};
  options.max_image_height_mm = sensor.half_diagonal_mm() + 1;
  options.half_frame_mm = {sensor.width_mm() / 2 + 0.5, sensor.height_mm() / 2 + 0.5};
  options.places = places;
  return build_lens_data_table(lens, options);
}

Scene checkerboard(double angle_deg) {
  Scene scene(900, 600, {nm}, angle_deg, std::nullopt);
  for (int row = 0; row < 600; ++row)
    for (int column = 0; column < 900; ++column)
      scene.band(0)[static_cast<std::size_t>(row * 900 + column)] =
          (row / 30 + column / 30) % 2 == 0 ? 1.0F : 0.05F;
  return scene;
}

double difference(const SpectralImage& a, const SpectralImage& b, int right = 0, int down = 0) {
  double square = 0, total = 0;
  for (int row = 8; row < b.rows() - 8; ++row)
    for (int column = 8; column < b.columns() - 8; ++column) {
      const double value = b.at(0, row, column);
      square += std::pow(double(a.at(0, row + down, column + right)) - value, 2);
      total += value * value;
    }
  return std::sqrt(square / total);
}

TEST(TableOverFrame, OfACentredLensIsThatByHeight) {
  const Lens lens = far_gauss();
  const SensorGeometry sensor{180, 120, 200};
  const Scene scene = checkerboard(48);
  ImagingOptions options;
  const SpectralImage by_height =
      form_image(scene, table_of(lens, sensor, Places::by_height), sensor, options);
  const SpectralImage over_frame =
      form_image(scene, table_of(lens, sensor, Places::over_frame), sensor, options);
  const double off = difference(over_frame, by_height);
  std::printf("over the frame against by height: %.2e\n", off);
  EXPECT_LT(off, options.product.tolerance);
}

TEST(TableOverFrame, ALensDecentredAsAWholeMovesThePicture) {
  Lens lens = far_gauss();
  const SensorGeometry sensor{150, 100, 200};
  const Scene scene = checkerboard(44);
  const SpectralImage centred = form_image(scene, table_of(lens, sensor), sensor, {});
  // By +0.6 mm along x' and −0.4 mm along y': three pixels to the left and two up.
  lens.groups = {{0, lens.surfaces.size() - 1, {0.6, -0.4, 0, 0, 0, 0}, 0}};
  const LensDataTable table = table_of(lens, sensor);
  ASSERT_TRUE(table.frame);
  const SpectralImage moved = form_image(scene, table, sensor, {});
  const double off = difference(moved, centred, -3, -2);
  std::printf("decentred as a whole against the centred lens: %.2e\n", off);
  // Both keep 1e-3; PSFs of the one are summed waves, of the other counted rays where waves would take long.
  EXPECT_LT(off, 2e-3);
  EXPECT_GT(difference(moved, centred), 0.1);
}

Lens bladed_gauss(double f_number, int blades, double rotation_deg) {
  MountedLens camera(read_lens("dgauss-50mm").lens);
  camera.set_f_number(f_number);
  camera.focus_at_m({});
  camera.set_blades({blades, rotation_deg});
  return camera.lens();
}

TEST(TableOverFrame, PlacesThatALensTreatsAlikeHaveTheSamePsf) {
  // The least turn of the blades leaves no mirror image: every place is computed then.
  TableOptions options;
  options.wavelengths_nm = {nm};
  options.max_image_height_mm = 12;
  options.half_frame_mm = {10, 7};
  options.frame_places = 7;
  for (const int blades : {6, 7}) {
    const LensDataTable alike = build_lens_data_table(bladed_gauss(5.6, blades, 0), options),
                        each = build_lens_data_table(bladed_gauss(5.6, blades, 1e-6), options);
    ASSERT_EQ(alike.places(), each.places());
    for (std::size_t place = 0; place < alike.places(); ++place) {
      const Psf &a = alike.psf[place], &b = each.psf[place];
      ASSERT_EQ(a.size, b.size) << place;
      double square = 0, total = 0;
      for (std::size_t i = 0; i < a.values.size(); ++i) {
        square += std::pow(double(a.values[i]) - double(b.values[i]), 2);
        total += std::pow(double(b.values[i]), 2);
      }
      // The error of the quadrature, of which stop_blades_test allows 3e-4 of the peak.
      EXPECT_LT(std::sqrt(square / total), 3e-4) << blades << " blades, " << alike.frame->name(place);
      EXPECT_NEAR(alike.g_source_sr[place] / each.g_source_sr[place], 1, 1e-5);
      // In the middle any direction will do.
      const double turned = alike.frame->psf_azimuth_deg[place] - each.frame->psf_azimuth_deg[place];
      EXPECT_NEAR(place == alike.places() / 2 ? 0 : std::remainder(turned, 360), 0, 1e-6);
    }
  }
}

TEST(TableOverFrame, FewPsfsSayWhatADenseLatticeDoes) {
  const Scene scene = checkerboard(48);
  // PSFs far smaller than pixels, and at f/5.6 a spot at the rim as wide as one.
  for (const auto& [f_number, sensor] :
       {std::pair{11.0, SensorGeometry{180, 120, 200}}, std::pair{5.6, SensorGeometry{360, 240, 100}}}) {
    const Lens lens = bladed_gauss(f_number, 7, 0);
    TableOptions options;
    options.wavelengths_nm = {nm};
    options.max_image_height_mm = sensor.half_diagonal_mm() + 1;
    options.half_frame_mm = {sensor.width_mm() / 2 + 0.5, sensor.height_mm() / 2 + 0.5};
    TableOptions many = options;
    many.frame_places = 33;
    const LensDataTable dense = build_lens_data_table(lens, many);
    for (const double tolerance : {1e-2, 1e-3}) {
      const LensDataTable few = build_image_table(lens, options, {sensor.pitch_um / 2, tolerance});
      const auto psfs = [](const LensDataTable& table) {
        return std::ranges::count_if(table.psf, [](const Psf& psf) { return psf.size > 0; });
      };
      ImagingOptions imaging;
      imaging.product.tolerance = tolerance;
      const double off =
          difference(form_image(scene, few, sensor, imaging), form_image(scene, dense, sensor, imaging));
      std::printf("f/%g to %g: %td PSFs of %td, off by %.2e\n", f_number, tolerance, psfs(few), psfs(dense),
                  off);
      EXPECT_LT(off, tolerance);
      EXPECT_LT(psfs(few), psfs(dense) / 8);
    }
  }
}

/// One element decentred, a surface tilted, the sensor askew.
Lens askew_gauss() {
  Lens lens = far_gauss();
  lens.surfaces[3].pose.tilt_x_deg = 0.2;
  lens.groups = {{0, 1, {0.12, 0.07, 0, 0.05, -0.08, 0}, 0}};
  lens.sensor_pose.tilt_y_deg = 0.15;
  return lens;
}

struct WallPixel {
  int row, column;
};

void expect_wall(const Lens& lens, const std::vector<WallPixel>& pixels, int side, double tolerance) {
  const SensorGeometry sensor{180, 120, 200};
  Scene wall(8, 6, {nm}, 50, std::nullopt);
  std::fill(wall.band(0).begin(), wall.band(0).end(), 1.0F);
  ImagingOptions options;
  options.surround = Surround::extend;
  const SpectralImage image = form_image(wall, table_of(lens, sensor), sensor, options);
  const Tracer tracer(lens, nm);
  for (const auto& [row, column] : pixels) {
    const double counted = counted_light_sr(tracer, sensor.x_mm(column + 0.5), sensor.y_mm(row + 0.5), side);
    EXPECT_NEAR(double(image.at(0, row, column)) / counted, 1, tolerance) << row << " " << column;
  }
}

TEST(TableOverFrame, AWallThroughALensWithPosesIsThatOfCountedRays) {
  std::vector<WallPixel> pixels;
  for (const int row : {6, 41, 77, 113})
    for (const int column : {7, 60, 121, 172}) pixels.push_back({row, column});
  // 1e-3 of the picture and the rays that the rim cuts: 2 · 1500^-1.5 of the hemisphere's share, up to 5e-4.
  expect_wall(askew_gauss(), pixels, 1500, 1.5e-3);
}

TEST(TableOverFrame, AWallThroughABladedStopIsThatOfCountedRays) {
  Lens lens = far_gauss();
  lens.surfaces[lens.stop_index()].blades = {6, 10};
  // Straight edges cut whole rows of rays: the grid is twice as fine for half a thousandth again.
  expect_wall(lens, {{6, 7}, {41, 121}, {60, 90}, {77, 60}, {113, 60}, {113, 172}}, 3000, 1.5e-3);
}

/// Centre and spread of kernels against rays traced from the object point, at places that nothing makes
/// alike.
TEST(TableOverFrame, KernelsLieAsTracedSpotsDo) {
  const Lens lens = askew_gauss();
  const SensorGeometry sensor{180, 120, 200};
  const LensDataTable table = table_of(lens, sensor);
  constexpr double cell_um = 8;
  const PsfField psfs(table, nm, cell_um);
  for (const auto& [field, azimuth] :
       {std::pair{8.0, 0.0}, std::pair{8.0, 90.0}, std::pair{8.0, 180.0}, std::pair{8.0, 270.0},
        std::pair{13.0, 35.0}, std::pair{13.0, 215.0}}) {
    FieldTracer tracer(lens, nm, Tracer::Clip::apertures, azimuth);
    const ChiefRay chief = *tracer.chief_ray(field);
    const double c = std::cos(radians(azimuth)), n = std::sin(radians(azimuth));
    const double x_mm = c * chief.image_x_mm - n * chief.image_height_mm,
                 y_mm = n * chief.image_x_mm + c * chief.image_height_mm;
    double light = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    const auto pupil = tracer.object_pupil(chief);
    const Pencil pencil = Pencil::from_object(lens, field);
    for (const PupilNode& node : pupil_nodes(*pupil, 24)) {
      const Ray ray = tracer.tracer().trace(*pencil.ray(node.u, node.v), Tracer::Clip::none);
      if (ray.status != RayStatus::ok) continue;
      const double a = (ray.point_mm[0] - chief.image_x_mm) / cell_um * um_per_mm,
                   b = (ray.point_mm[1] - chief.image_height_mm) / cell_um * um_per_mm;
      const double u = c * a - n * b, v = n * a + c * b, w = node.weight;
      light += w, x += w * u, y += w * v, xx += w * u * u, xy += w * u * v, yy += w * v * v;
    }
    const Moments kernel = psfs.kernel_at(x_mm, y_mm).moments();  // columns along −x'
    const double spread = std::sqrt((xx + yy) / light);
    EXPECT_NEAR(-kernel.mean[0], x / light, 0.03 * spread) << field << " " << azimuth;
    EXPECT_NEAR(kernel.mean[1], y / light, 0.03 * spread) << field << " " << azimuth;
    const auto variance = [](double square, double one, double other) { return square - one * other; };
    const double window = 0.65 * 0.65;  // smooth_psf.h
    const double kernel_difference = variance(kernel.uu, kernel.mean[0], kernel.mean[0]) -
                                     variance(kernel.vv, kernel.mean[1], kernel.mean[1]),
                 traced_difference =
                     variance(xx / light, x / light, x / light) - variance(yy / light, y / light, y / light);
    const double size =
        variance(xx / light, x / light, x / light) + variance(yy / light, y / light, y / light) + window;
    // A twentieth of the spread: diffraction and the window's corners.
    EXPECT_NEAR(kernel_difference, traced_difference, 0.05 * size) << field << " " << azimuth;
    EXPECT_NEAR(-variance(kernel.uv, kernel.mean[0], kernel.mean[1]),
                variance(xy / light, x / light, y / light), 0.05 * size)
        << field << " " << azimuth;
  }
}

TEST(TableOverFrame, ComesBackFromItsFile) {
  const LensDataTable table = table_of(askew_gauss(), {60, 40, 200});
  const ScratchFolder folder;
  const std::string path = folder.path() + "/over_frame.h5";
  write_table(table, path);
  const LensDataTable read = read_table(path);
  ASSERT_TRUE(read.frame);
  EXPECT_EQ(read.frame->x_mm, table.frame->x_mm);
  EXPECT_EQ(read.frame->y_mm, table.frame->y_mm);
  EXPECT_EQ(read.frame->object_x, table.frame->object_x);
  EXPECT_EQ(read.frame->object_y, table.frame->object_y);
  EXPECT_EQ(read.frame->psf_azimuth_deg, table.frame->psf_azimuth_deg);
  EXPECT_EQ(read.g_source_sr, table.g_source_sr);
  EXPECT_EQ(read.psf.back().values, table.psf.back().values);
}

TEST(TableOverFrame, ByHeightPosesAndBladesAreRefusedByName) {
  TableOptions options;
  options.places = Places::by_height;
  const auto complaint = [&](const Lens& lens) {
    try {
      build_lens_data_table(lens, options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(complaint(askew_gauss()).find("surfaces[3].pose is set"), std::string::npos);
  Lens bladed = far_gauss();
  bladed.surfaces[bladed.stop_index()].blades.count = 6;
  EXPECT_NE(complaint(bladed).find("6 blades"), std::string::npos);
}

// PSFs that grow fast towards the rim, and such that hardly change.
TEST(TableByHeight, ChosenFieldsSayWhatADenseTableDoes) {
  for (const auto& [name, sensor] : {std::pair{"edmund-54852", SensorGeometry{320, 240, 15}},
                                     std::pair{"double-gauss", SensorGeometry{360, 240, 100}}}) {
    MountedLens camera(read_lens(name).lens);
    camera.focus_at_m({});
    TableOptions options;
    options.wavelengths_nm = {550};
    options.max_image_height_mm = sensor.half_diagonal_mm() + 0.1;
    TableOptions many = options;
    many.field_count = 241;
    const LensDataTable dense = build_lens_data_table(camera.lens(), many);
    const Scene scene = checkerboard(48);
    ImagingOptions imaging;
    imaging.surround = Surround::extend;
    const SpectralImage truth = form_image(scene, dense, sensor, imaging);
    const LensDataTable chosen = build_image_table(
        camera.lens(), options,
        {sensor.pitch_um / 2, imaging.product.tolerance, imaging.tail_pixels * sensor.pitch_um});
    const double off = difference(form_image(scene, chosen, sensor, imaging), truth);
    EXPECT_LT(off, imaging.product.tolerance) << name;
    EXPECT_GT(chosen.interpolation_error, 0) << name;
    EXPECT_LT(chosen.interpolation_error, imaging.product.tolerance) << name;
  }
}

// The image turns back inwards a little beyond the frame. Fields lie as close within it as where it does not.
TEST(TableByHeight, ChoosesFieldsUpToWhereTheImageTurnsBack) {
  MountedLens camera(read_lens("edmund-54852").lens);
  camera.focus_at_m({});
  const SensorGeometry sensor{160, 120, 30};
  TableOptions options;
  options.wavelengths_nm = {550};
  options.max_image_height_mm = 3.39;
  options.half_frame_mm = {sensor.width_mm() / 2 + 0.24, sensor.height_mm() / 2 + 0.24};
  TableOptions within = options;
  within.max_image_height_mm = 3.1;
  within.field_count = 241;
  ImagingOptions imaging;
  imaging.surround = Surround::extend;
  imaging.supersample = 2;
  const Scene scene = checkerboard(48);
  const SpectralImage truth =
      form_image(scene, build_lens_data_table(camera.lens(), within), sensor, imaging);
  const LensDataTable chosen = build_image_table(
      camera.lens(), options,
      {sensor.pitch_um / 2, imaging.product.tolerance, imaging.tail_pixels * sensor.pitch_um});
  const SpectralImage picture = form_image(scene, chosen, sensor, imaging);
  double off = 0, all = 0;
  for (int row = 0; row < sensor.rows; ++row)
    for (int column = 0; column < sensor.columns; ++column) {
      const double height_mm = std::hypot(sensor.x_mm(column + 0.5), sensor.y_mm(row + 0.5));
      if (height_mm > 2.5) continue;  // light from beyond the smaller table comes no farther
      const auto at = static_cast<std::size_t>(row * sensor.columns + column);
      off += std::pow(double(picture.band(0)[at]) - double(truth.band(0)[at]), 2);
      all += std::pow(double(truth.band(0)[at]), 2);
    }
  EXPECT_LT(std::sqrt(off / all), imaging.product.tolerance);
  EXPECT_GT(chosen.interpolation_error, 0);
  EXPECT_LT(chosen.interpolation_error, imaging.product.tolerance);
}

}  // namespace
}  // namespace petzval
