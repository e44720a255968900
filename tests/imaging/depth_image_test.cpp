// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/base/error.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/imaging/depth_image.h>
#include <petzval/imaging/image_table.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

namespace petzval {
namespace {

using namespace testing;

const SensorGeometry frame{96, 64, 60};

/// The double Gauss, focused; its image reaches the corners of the frame.
DepthCamera camera_at(std::optional<double> focus_m, double f_number = 2.1) {
  MountedLens camera(read_lens("dgauss-50mm").lens);
  camera.set_f_number(f_number);
  camera.focus_at_m(focus_m);
  TableOptions table;
  table.wavelengths_nm = {550};
  table.max_image_height_mm = frame.half_diagonal_mm();
  table.field_count = 11;  // 3.5 degrees: enough for them
  return {camera.lens(), table};
}

/// As wide as the frame and a little more, at this distance.
Scene blank_scene(double distance_m, int columns = 192, int rows = 128) {
  return Scene(columns, rows, {550}, 7.5, distance_m);
}

template <typename Value>
void fill(Scene& scene, const Value& value) {
  const auto band = scene.band(0);
  const auto width = static_cast<std::size_t>(scene.columns());
  for (std::size_t i = 0; i < band.size(); ++i)
    band[i] = static_cast<float>(
        value(double(i % width) + 0.5 - double(width) / 2, double(i / width) + 0.5 - scene.rows() / 2.0));
}

template <typename Value>
void fill_depth(Scene& scene, const Value& value) {
  const auto width = static_cast<std::size_t>(scene.columns());
  scene.depth_m.resize(scene.band_size());
  for (std::size_t i = 0; i < scene.depth_m.size(); ++i)
    scene.depth_m[i] = static_cast<float>(
        value(double(i % width) + 0.5 - double(width) / 2, double(i / width) + 0.5 - scene.rows() / 2.0));
}

void fill_noise(Scene& scene) {
  std::mt19937 random(5);
  fill(scene, [&](double, double) { return std::generate_canonical<double, 32>(random); });
}

ImagingOptions edges_go_on() {
  ImagingOptions options;
  options.surround = Surround::extend;
  return options;
}

double worst_difference(const SpectralImage& a, const SpectralImage& b) {
  double worst = 0, peak = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) {
    worst = std::max(worst, std::abs(double(a.values()[i]) - double(b.values()[i])));
    peak = std::max(peak, std::abs(double(b.values()[i])));
  }
  return worst / peak;
}

double relative_distance(const SpectralImage& a, const SpectralImage& b) {
  double error = 0, size = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) {
    error += std::pow(double(a.values()[i]) - double(b.values()[i]), 2);
    size += std::pow(double(b.values()[i]), 2);
  }
  return std::sqrt(error / size);
}

// One depth is a plane, whether it is in focus or not.
TEST(DepthImage, OfOneDepthIsThatOfThePlane) {
  for (const double focus_m : {1.25, 1.0}) {
    const DepthCamera camera = camera_at(focus_m);
    Scene scene = blank_scene(1.25);
    fill_noise(scene);
    MountedLens at(camera.lens);
    at.place_object_at_m(1.25);
    const double tolerance = edges_go_on().product.tolerance;
    const SpectralImage plane =
        form_image(scene, build_image_table(at.lens(), camera.table, {frame.pitch_um / 2, tolerance}), frame,
                   edges_go_on());
    fill_depth(scene, [](double, double) { return 1.25; });
    const SpectralImage deep = form_depth_image(scene, camera, frame, edges_go_on(), {});
    EXPECT_EQ(worst_difference(deep, plane), 0) << focus_m;
  }
}

// A wall of even radiance is g_sensor, and that does not ask how far away the wall is.
TEST(DepthImage, OfAWallOfAnyDepthsIsTheWall) {
  const DepthCamera camera = camera_at(1.0);
  ImagingOptions fine = edges_go_on();
  fine.product.tolerance = 1e-4;  // RMS, where single pixels are held against each other below
  Scene scene = blank_scene(1.0);
  fill(scene, [](double, double) { return 2.0; });
  const SpectralImage wall = form_image(scene, build_lens_data_table(camera.lens, camera.table), frame, fine);
  std::mt19937 random(7);
  const auto any = [&](double, double) { return 0.6 + 3 * std::generate_canonical<double, 32>(random); };
  const auto blocks = [](double x, double y) {
    return x * x + y * y < 900 ? 0.7 : std::fmod(std::abs(x) + 3 * std::abs(y), 40.0) < 20 ? 1.1 : INFINITY;
  };
  // Tables of different distances find g_sensor to 1e-3 each (physics/image_wall_test.cpp).
  fill_depth(scene, any);
  EXPECT_LT(worst_difference(form_depth_image(scene, camera, frame, fine, {9}), wall), 2e-3);
  fill_depth(scene, blocks);
  EXPECT_LT(worst_difference(form_depth_image(scene, camera, frame, fine, {}), wall), 2e-3);
}

// Stopped down so far that nothing is out of focus by a pixel, the layers must add up to the plane: whatever
// the depths are, light that is hidden in one layer is in another.
TEST(DepthImage, WithoutDefocusIsTheSameWhateverTheDepths) {
  const DepthCamera camera = camera_at(1.0, 22);
  Scene scene = blank_scene(1.0);
  fill(scene, [](double x, double y) { return 1 + 0.8 * std::sin(x / 3) * std::cos(y / 4); });
  const SpectralImage plane =
      form_image(scene, build_lens_data_table(camera.lens, camera.table), frame, edges_go_on());
  fill_depth(scene, [&](double x, double y) { return 1 + 0.01 * std::sin(x / 11 + y / 17); });
  const SpectralImage deep = form_depth_image(scene, camera, frame, edges_go_on(), {5});
  // The blur differs by a hundredth of a pixel, the distortion by less; what is left are the tolerance
  // of the blur and what guesses weigh (LayerScene::guess_weight / 20).
  EXPECT_LT(relative_distance(deep, plane), 2e-3);
}

/// Second moments of a spot about its centre of gravity along x [µm²].
double moment_x(const SpectralImage& image, int from_column, int to_column) {
  double light = 0, first = 0, second = 0;
  for (int row = 0; row < image.rows(); ++row)
    for (int column = from_column; column < to_column; ++column) {
      const double value = double(image.at(0, row, column)), x = column * image.pitch_um();
      light += value, first += value * x, second += value * x * x;
    }
  return second / light - std::pow(first / light, 2);
}

// A star at each of three depths, on black cards at its depth: each as blurred as `lens psf` says for an
// object at that distance, and as the law of defocus says.
TEST(DepthImage, BlursEachDepthAsTheLensDoesAtThatDistance) {
  const DepthCamera camera = camera_at(1.0);
  const DefocusLaw law(camera.lens);
  Scene scene = blank_scene(1.0, 288, 96);
  const auto depth_of = [](double x) { return x < -48 ? 0.8 : x < 48 ? 1.0 : 1.5; };
  fill_depth(scene, [&](double x, double) { return depth_of(x); });
  // Round stars of Gaussian profile, 3 samples of standard deviation, smooth enough for the cells.
  const double sigma = 3;
  fill(scene, [&](double x, double y) {
    const double from = std::fmod(x + 144, 96) - 48;
    return std::exp(-(from * from + y * y) / (2 * sigma * sigma));
  });
  const SensorGeometry wide{192, 64, 30};
  DepthCamera used = camera;
  used.table.max_image_height_mm = wide.half_diagonal_mm();
  ImagingOptions options = edges_go_on();
  options.supersample = 3;
  const SpectralImage image = form_depth_image(scene, used, wide, options, {});
  // Samples lie on lines of sight, and are as large in the image at every depth.
  const double sample_um =
      1e6 * std::abs(first_order(camera.lens).magnification) * scene.tangent_per_sample();
  for (int star = 0; star < 3; ++star) {
    const double depth_m = depth_of(96.0 * (star - 1));
    MountedLens at(camera.lens);
    at.place_object_at_m(depth_m);
    FieldTracer tracer(at.lens(), 550);
    // The line of sight, from the entrance pupil.
    const double tangent = 96 * (star - 1) * scene.tangent_per_sample() *
                           widening_from_pupil(scene.distance_m(), law.pupil_to_sensor_mm());
    const double height_mm = tangent * (depth_m * 1e3 - law.pupil_to_sensor_mm());
    const Psf psf = *point_spread(tracer, *tracer.chief_ray(height_mm));
    double light = 0, first = 0, second = 0;  // along x: the stars stand beside the axis, so along t
    for (int i = 0; i < psf.size; ++i)
      for (int j = 0; j < psf.size; ++j) {
        const double value = double(psf.at(i, j)), t = (i - psf.size / 2) * psf.spacing_um;
        light += value, first += value * t, second += value * t * t;
      }
    const double psf_um2 = second / light - std::pow(first / light, 2);
    // Its own, of the bilinear light between samples, and of the pixel.
    const double star_um2 =
        (sigma * sigma + 1.0 / 6) * sample_um * sample_um + wide.pitch_um * wide.pitch_um / 12;
    const double measured = moment_x(image, 64 * star + 2, 64 * star + 62);
    std::printf("%g m: variance %.0f um2, PSF and star %.0f, law %.0f\n", depth_m, measured,
                psf_um2 + star_um2, std::pow(law.blur_um(law.vergence(depth_m)), 2) / 16 + star_um2);
    // Cells, and tails between the stars.
    EXPECT_NEAR(measured, psf_um2 + star_um2, 0.01 * (psf_um2 + star_um2)) << depth_m;
    // A disc of diameter b has the variance b²/16; spherical aberration and diffraction are the rest.
    EXPECT_NEAR(measured, std::pow(law.blur_um(law.vergence(depth_m)), 2) / 16 + star_um2, 0.05 * measured);
  }
}

// Behind the edge of something near and sharp lies an even wall, far out of focus. It goes on behind the
// edge: beside it nothing is darker.
TEST(DepthImage, HasNoHalosBesideWhatIsInFocus) {
  const DepthCamera camera = camera_at(0.8);
  Scene scene = blank_scene(0.8);
  fill(scene, [](double x, double) { return x < 0.5 ? 0.2 : 1.0; });
  fill_depth(scene, [](double x, double) { return x < 0.5 ? 0.8 : 4.0; });
  DepthReport report;
  const SpectralImage image = form_depth_image(scene, camera, frame, edges_go_on(), {}, {}, &report);
  ASSERT_GT(std::abs(report.layers.front().blur_um), 8 * frame.pitch_um);  // the wall is far out of focus
  const double wall = double(image.at(0, 32, 90)), card = double(image.at(0, 32, 5));
  EXPECT_NEAR(card / wall, 0.2, 0.002);  // relative illumination of 90 and 5 differs by less
  for (int column = 0; column < 96; ++column) {
    if (std::abs(column - 48) < 3) continue;  // the edge itself, and what the lens in focus makes of it
    const double even = column < 48 ? card : wall;
    EXPECT_NEAR(double(image.at(0, 32, column)), even, 0.01 * wall) << column;
  }
}

// The edge of something near, out of focus, before an even wall in focus: a half-plane seen through a disc.
TEST(DepthImage, FadesOverWhatIsBehindAsAHalfPlaneThroughADiscDoes) {
  const DepthCamera camera = camera_at(2.0, 2.8);
  const DefocusLaw law(camera.lens);
  Scene scene = blank_scene(2.0);
  fill(scene, [](double x, double) { return x < 0 ? 0.1 : 1.0; });
  fill_depth(scene, [](double x, double) { return x < 0 ? 0.9 : 2.0; });
  const SpectralImage image = form_depth_image(scene, camera, frame, edges_go_on(), {});
  const double radius_um = std::abs(law.blur_um(law.vergence(0.9))) / 2;
  ASSERT_GT(radius_um, 3 * frame.pitch_um);
  const double card = double(image.at(0, 32, 2)), wall = double(image.at(0, 32, 93));
  for (int column = 30; column < 66; ++column) {
    const double u = std::clamp((column + 0.5 - 48) * frame.pitch_um / radius_um, -1.0, 1.0);
    const double share = 0.5 + (std::asin(u) + u * std::sqrt(1 - u * u)) / std::numbers::pi;
    // The spot of this lens is no even disc: spherical aberration moves light within it.
    EXPECT_NEAR((double(image.at(0, 32, column)) - card) / (wall - card), share, 0.04) << column;
  }
}

// A textured plane that recedes through all of the layers: more of them change it by less and less, and no
// border of a layer shows.
TEST(DepthImage, OfAPlaneThatRecedesHasNoSeams) {
  const DepthCamera camera = camera_at(1.0);
  Scene scene = blank_scene(1.0);
  fill(scene, [](double x, double y) { return 1 + 0.9 * std::sin(0.7 * x) * std::sin(0.5 * y + 0.1 * x); });
  fill_depth(scene, [](double x, double) { return 1 / (1 - 0.3 * x / 96); });
  const auto with = [&](int layers) {
    return form_depth_image(scene, camera, frame, edges_go_on(), {layers});
  };
  const SpectralImage many = with(49);
  DepthReport report;
  const SpectralImage usual = form_depth_image(scene, camera, frame, edges_go_on(), {}, {}, &report);
  const double coarse = relative_distance(with(4), many), fine = relative_distance(usual, many);
  std::printf("%zu layers against 49: %.4f; 4: %.4f\n", report.layers.size(), fine, coarse);
  // Halfway between two layers a pixel of blur apart, the mixture of both has a variance 1/64 of a pixel²
  // larger than the blur that it stands for: from waves of 4.5 pixels that takes up to
  // 1/2 (2π/4.5)²/64 = 1.5 %.
  EXPECT_LT(fine, 0.015);
  EXPECT_LT(fine, coarse / 2);
  // Columns where the error jumps would be seams.
  double jump = 0, largest = 0;
  for (int column = 1; column < 96; ++column) {
    double sum = 0;
    for (int row = 0; row < 64; ++row) {
      const auto error = [&](int at) { return double(usual.at(0, row, at)) - double(many.at(0, row, at)); };
      sum += std::pow(error(column) - error(column - 1), 2);
    }
    jump += sum / 95, largest = std::max(largest, sum);
  }
  EXPECT_LT(std::sqrt(largest), 4 * std::sqrt(jump));  // blur itself, and with it the error, varies by column
}

TEST(DepthImage, RefusesWhatItCannotImage) {
  const DepthCamera camera = camera_at(1.0);
  Scene scene = blank_scene(1.0);
  fill(scene, [](double, double) { return 1; });
  EXPECT_THROW(form_depth_image(scene, camera, frame, edges_go_on(), {}), InputError);  // no map
  scene.depth_m.assign(7, 1.0F);
  EXPECT_THROW(form_depth_image(scene, camera, frame, edges_go_on(), {}), InputError);
  fill_depth(scene, [](double x, double) { return x == 0.5 ? NAN : 1.0; });
  EXPECT_THROW(form_depth_image(scene, camera, frame, edges_go_on(), {}), InputError);
  fill_depth(scene, [](double, double) { return 1.0; });
  scene.set_horizontal_angle_deg(4);
  EXPECT_THROW(form_depth_image(scene, camera, frame, {}, {}), InputError);  // it does not cover the frame
}

}  // namespace
}  // namespace petzval
