// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/optics/build.h>
#include <petzval/simulate/image.h>
#include <petzval/simulate/lens_on_sensor.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace petzval {
namespace {

Camera small_camera() {
  Camera camera;
  camera.lens = read_lens("dgauss-50mm").lens;
  camera.sensor = read_sensor("48x36@200");
  return camera;
}

SceneRequest wall_request() {
  return {.name = "wall", .options = {.wavelengths_nm = {500, 550, 600}}};
}

// On the axis E = π L sin²U'. A lens that is corrected keeps Abbe's sine condition, so sin U' is 1/2N, N its
// paraxial working f-number; what is left of the aberrations at this aperture is some per cent of the
// marginal slope.
TEST(Image, OfAWallHasTheIrradianceOfTheCone) {
  const ImagePlan plan = plan_image(wall_request(), small_camera());
  const SpectralImage light = image(plan);
  for (int band = 0; band < light.bands(); ++band) {
    const double radiance = plan.scene.mean_radiance()[static_cast<std::size_t>(band)];
    const double n = plan.table.first_order.working_f_number;
    EXPECT_NEAR(light.at(band, 18, 24) / (M_PI * radiance / (4 * n * n)), 1, 0.02);
  }
}

TEST(Image, SaysWhatItWasMadeOf) {
  ImageReport report;
  std::vector<std::string> notes;
  Context context;
  context.note = [&](const std::string& text) { notes.push_back(text); };
  const SpectralImage light = image(wall_request(), small_camera(), {}, context, &report);
  EXPECT_NE(light.provenance.find("wall"), std::string::npos) << light.provenance;
  EXPECT_NE(light.provenance.find(report.method), std::string::npos);
  ASSERT_TRUE(light.lens);
  EXPECT_NEAR(light.lens->focal_length_mm, 50, 1);
  EXPECT_TRUE(light.illuminant);
  EXPECT_GE(report.imaging.cells_per_pixel, 2);
  for (const std::string& note : notes) ADD_FAILURE() << "nothing to act on: " << note;
}

TEST(Image, OfASceneInMemoryIsThatOfTheSceneRead) {
  const Camera camera = small_camera();
  SceneRequest request = wall_request();
  request.options.horizontal_angle_deg = 30;
  const SpectralImage read = image(request, camera);
  const SpectralImage kept = image(read_scene(request.name, request.options), camera);
  EXPECT_TRUE(std::ranges::equal(read.values(), kept.values()));
}

TEST(Image, ThroughAStoredTableIsThatThroughItsLens) {
  const Camera camera = small_camera();
  const ImagePlan plan = plan_image(wall_request(), camera);
  const SpectralImage direct = image(plan);
  SceneRequest same = wall_request();
  same.options.horizontal_angle_deg = plan.scene.horizontal_angle_deg();
  const SpectralImage stored = image(same, TableCamera{plan.table, camera.sensor});
  EXPECT_TRUE(std::ranges::equal(direct.values(), stored.values()));
}

TEST(Image, HandsOverTheBandsThatItWouldKeep) {
  const ImagePlan plan = plan_image(wall_request(), small_camera());
  const SpectralImage light = image(plan);
  std::vector<float> bands;
  image_bands(
      plan, [&](std::span<const float> pixels) { bands.insert(bands.end(), pixels.begin(), pixels.end()); });
  EXPECT_TRUE(std::ranges::equal(light.values(), bands));
}

TEST(Image, LossesOfTheCameraTakeLight) {
  Camera coated = small_camera();
  coated.losses.fresnel = true;
  const SpectralImage clear = image(wall_request(), small_camera()), lossy = image(wall_request(), coated);
  // Twelve air-glass surfaces or so of 4 to 6 % each.
  EXPECT_LT(lossy.at(1, 18, 24), 0.75 * clear.at(1, 18, 24));
  EXPECT_GT(lossy.at(1, 18, 24), 0.3 * clear.at(1, 18, 24));
}

TEST(Image, IsTheSameOnAnyNumberOfThreads) {
  Context one, two;
  one.threads = 1, two.threads = 2;
  SceneRequest chart = wall_request();
  chart.name = "studio";
  const SpectralImage a = image(chart, small_camera(), {}, one), b = image(chart, small_camera(), {}, two);
  EXPECT_TRUE(std::ranges::equal(a.values(), b.values()));
}

/// The relative L2 difference of a picture from a reference.
double relative_difference(const SpectralImage& picture, const SpectralImage& reference) {
  double difference = 0, light = 0;
  for (std::size_t i = 0; i < reference.values().size(); ++i) {
    const double here = double(reference.values()[i]);
    difference += std::pow(double(picture.values()[i]) - here, 2);
    light += here * here;
  }
  return std::sqrt(difference / light);
}

struct ChartCase {
  const char *chart, *lens, *sensor;
};
class Charts : public testing::TestWithParam<ChartCase> {};

// The edges of a chart's figures have no end of detail. Against 12 × 12 cells a pixel and kernels at a tenth
// of the finest tolerance.
TEST_P(Charts, AreWithinTheTolerance) {
  Camera camera;
  camera.lens = read_lens(GetParam().lens).lens;
  camera.sensor = read_sensor(GetParam().sensor);
  const SceneRequest chart{.name = GetParam().chart, .options = {.wavelengths_nm = {550}}};
  ImageOptions fine;
  fine.imaging.product.tolerance = 1e-4;
  fine.imaging.supersample = 12;
  const SpectralImage reference = image(chart, camera, fine);
  for (const double tolerance : {1e-2, 1e-3}) {
    ImageOptions options;
    options.imaging.product.tolerance = tolerance;
    ImageReport report;
    const double off = relative_difference(image(chart, camera, options, {}, &report), reference);
    EXPECT_LT(off, tolerance) << report.imaging.cells_per_pixel;
    EXPECT_LT(off, report.imaging.estimated_error()) << report.imaging.cells_per_pixel;
    EXPECT_LT(report.imaging.estimated_error(), tolerance) << report.imaging.cells_per_pixel;
  }
}
INSTANTIATE_TEST_SUITE_P(Bundled, Charts,
                         testing::Values(ChartCase{"checkerboard", "achromat-50mm", "80x60@30"},
                                         ChartCase{"studio", "edmund-54852", "160x120@15"},
                                         ChartCase{"iso12233", "dgauss-50mm", "320x240@15"}),
                         [](const auto& of) { return std::string(of.param.chart); });

/// Lenses whose PSFs change little, much, and at the rim above all, over their whole fields.
struct PreviewCase {
  const char *lens, *sensor;
};
class Previews : public testing::TestWithParam<PreviewCase> {};

// A preview makes fewer PSFs and coarser kernels than a finer picture; what it promises is its tolerance.
TEST_P(Previews, KeepTheirTolerance) {
  Camera camera;
  camera.lens = read_lens(GetParam().lens).lens;
  camera.sensor = read_sensor(GetParam().sensor);
  SceneRequest chart{.name = "studio", .options = {.wavelengths_nm = {460, 540, 610}}};
  chart.options.horizontal_angle_deg = 120;
  // Samples, whose detail ends: this is about PSFs and kernels.
  chart.options.columns = 768, chart.options.rows = 576;
  ImageOptions options;
  options.imaging.surround = Surround::extend;
  options.imaging.product.tolerance = 3e-4;
  const SpectralImage reference = image(chart, camera, options);
  const auto off = [&](ImageReport* report = nullptr) {
    return relative_difference(image(chart, camera, options, {}, report), reference);
  };
  for (const double tolerance : {1e-2, 5e-3, 3e-3}) {
    options.imaging.product.tolerance = tolerance;
    EXPECT_LT(off(), tolerance) << GetParam().lens;
  }
  // One cell a pixel, whatever that costs: it is told.
  options.imaging.product.tolerance = 2e-2;
  options.imaging.supersample = 1;
  ImageReport report;
  const double error = off(&report);
  EXPECT_LT(error, report.imaging.estimated_error()) << GetParam().lens;
  EXPECT_GT(error, 0.1 * report.imaging.estimated_error()) << GetParam().lens;
}
INSTANTIATE_TEST_SUITE_P(Bundled, Previews,
                         testing::Values(PreviewCase{"dgauss-50mm", "90x60@400"},
                                         PreviewCase{"edmund-54852", "96x72@50"},
                                         PreviewCase{"wide-22mm", "90x60@400"}),
                         [](const auto& of) {
                           std::string name = of.param.lens;
                           std::erase(name, '-');
                           return name;
                         });

// Source cells are how a picture is computed, not what it shows.
TEST(Image, FramesTheSceneAlikeWithAnyNumberOfCells) {
  Camera camera = small_camera();
  camera.sensor = read_sensor("example-vga");  // whose photosites have a size of their own
  for (const BlurMethod method : {BlurMethod::product, BlurMethod::none}) {
    const auto plan = [&](int cells) {
      ImageOptions options;
      options.imaging.method = method;
      options.imaging.supersample = cells;
      return plan_image({.name = "checkerboard", .options = {.wavelengths_nm = {550}}}, camera, options);
    };
    const double chosen_deg = plan(0).scene.horizontal_angle_deg();
    for (const int cells : {1, 2, 4}) {
      // Without blur, but for the cells about the frame that photosites and the low-pass filter share in: at
      // most a pixel on either side.
      EXPECT_NEAR(plan(cells).scene.horizontal_angle_deg() / chosen_deg, 1,
                  method == BlurMethod::none ? 2.0 / camera.sensor->geometry.columns : 0);
      EXPECT_NO_THROW(image(plan(cells)));  // the scene covers what these cells see
    }
  }
}

TEST(Image, MakesPsfsWhereTheyChange) {
  Camera camera = small_camera();
  const auto psfs = [&](double tolerance) {
    ImageOptions options;
    options.imaging.product.tolerance = tolerance;
    const LensDataTable table = plan_image(wall_request(), camera, options).table;
    return std::ranges::count_if(table.psf, [](const Psf& psf) { return psf.size > 0; });
  };
  EXPECT_LT(psfs(1e-3), 31 * 3 / 2);
  EXPECT_LE(psfs(1e-2), psfs(1e-3));
  EXPECT_LT(psfs(1e-3), psfs(1e-5));
}

TEST(Image, FramesTheFieldsOfALensWithoutASensor) {
  struct Case {
    const char* lens;
    double height_mm;  // of the last field's image: f tan θ, or half of the image circle in the lens's name
    double tolerance;  // relative
  };
  for (const Case& of : {Case{"cooke-triplet", 50 * std::tan(20 * pi / 180), 0.02},
                         {"m12-4.5mm", 2.8, 0.02},
                         {"telecentric-0.25x", 4.0, 0.02},
                         {"telecentric-0.5x", 5.5, 0.02}}) {
    Camera camera;
    camera.lens = read_lens(of.lens).lens;
    const SceneRequest chart{.name = "checkerboard", .options = {.wavelengths_nm = {550}}};
    const ImagePlan plan = plan_image(chart, camera);
    EXPECT_EQ(plan.frame.columns, 640) << of.lens;
    EXPECT_EQ(plan.frame.rows, 480) << of.lens;
    // The corner, at 400 pixels, lies at 95 % of the last field.
    EXPECT_NEAR(plan.frame.pitch_um * 1e-3 * 400, 0.95 * of.height_mm, of.tolerance * of.height_mm)
        << of.lens;
    if (const auto object_mm = camera.lens.object_distance_mm;
        object_mm && is_afocal(first_order(camera.lens))) {
      // A lens of no power sees what stands where its designer put it.
      ASSERT_TRUE(plan.scene.distance_m()) << of.lens;
      EXPECT_NEAR(*plan.scene.distance_m(), 1e-3 * (*object_mm + camera.lens.total_track_mm()), 1e-4);
    }
  }
}

TEST(Image, CanBeStopped) {
  Camera camera = small_camera();
  camera.sensor = read_sensor("640x480@15");
  SceneRequest chart = wall_request();
  chart.name = "studio";
  // Whenever it is asked: in the table, in the fitting, in the blur.
  for (const int answers : {0, 3, 20}) {
    std::atomic<int> asked = 0;
    Context context;
    context.progress = [&](double, const std::string&) { return asked++ < answers; };
    EXPECT_THROW(image(chart, camera, {}, context), Cancelled) << answers;
  }
}

TEST(Image, RefusesWhatDoesNotFit) {
  ImageOptions layered;
  layered.depth.layers = 3;
  EXPECT_THROW(image(wall_request(), small_camera(), layered), InputError);
  ImageOptions widened;
  widened.least_scene_angle_deg = 20;
  SceneRequest fixed = wall_request();
  fixed.options.horizontal_angle_deg = 30;
  EXPECT_THROW(image(fixed, small_camera(), widened), InputError);
}

TEST(FillingAngle, IsNearlyThatOfTheImage) {
  const Camera camera = small_camera();
  const double angle = filling_angle_deg(wall_request(), camera, {}).value();
  EXPECT_NEAR(angle / plan_image(wall_request(), camera).scene.horizontal_angle_deg(), 1, 0.01);
  SceneRequest fixed = wall_request();
  fixed.options.horizontal_angle_deg = 30;
  EXPECT_FALSE(filling_angle_deg(fixed, camera, {}));
}

}  // namespace
}  // namespace petzval
