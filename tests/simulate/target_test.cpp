// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/simulate/expose.h>
#include <petzval/simulate/target.h>
#include <petzval/target/exact_sfr.h>
#include <petzval/target/test_charts.h>

#include <cmath>

namespace petzval {
namespace {

TargetRequest square_target(int size = 64) {
  TargetRequest request;
  request.columns = request.rows = size;
  request.scene.polygons = {{{rectangle({0.5 * size, 0.5 * size}, 0.4 * size, 0.4 * size, 5)}, 0, 0}};
  return request;
}

// Shorter waves are spread less by the same pupil: each band has its own blur, and its share of the light.
TEST(Target, BandsAddUpToTheRelativePicture) {
  TargetRequest request = square_target();
  request.wavelengths_nm = {650, 450, 550};
  request.weights = {1, 2, 5};
  const SpectralImage light = target(request);
  EXPECT_EQ(light.wavelengths_nm(), (std::vector<double>{450, 550, 650}));
  const TargetImage relative = relative_target(request);
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 64; ++column) {
      double sum = 0;
      for (int band = 0; band < 3; ++band) sum += static_cast<double>(light.at(band, row, column));
      ASSERT_NEAR(sum, relative.at(row, column), 3e-6);
    }
  EXPECT_NEAR(light.at(0, 1, 1), 2.0 / 8, 1e-3);
  EXPECT_NEAR(light.at(1, 1, 1), 5.0 / 8, 1e-3);
  const auto middle = [&](int band, double share) {
    return static_cast<double>(light.at(band, 32, 32)) / share;
  };
  EXPECT_LT(middle(0, 2.0 / 8), middle(1, 5.0 / 8));
  EXPECT_LT(middle(1, 5.0 / 8), middle(2, 1.0 / 8));
}

TEST(Target, LevelsAreThoseOfBlackAndWhite) {
  TargetRequest request = square_target();
  request.blur = GaussianBlur{2};
  request.black = 0.1, request.white = 0.9;
  const TargetImage image = relative_target(request);
  EXPECT_NEAR(image.at(0, 0), 0.9, 1e-6);
  EXPECT_NEAR(image.at(32, 32), 0.1, 1e-6);
}

TEST(Target, IsMadeForItsSensor) {
  TargetRequest request = square_target();
  request.sensor = read_sensor("third-inch-1280x960");
  request.blur = PupilBlur{.f_number = 5.6};
  const SpectralImage light = target(request);
  EXPECT_EQ(light.pitch_um(), request.sensor->geometry.pitch_um);
  ASSERT_TRUE(light.lens);
  EXPECT_EQ(light.lens->f_number, 5.6);
  request.columns = 1281;
  EXPECT_THROW(target(request), InputError);
}

// One wavelength that red pixels see better than blue ones: the raw image says so.
TEST(Target, OneWavelengthOnColourPixelsIsWhatSuchLightGives) {
  TargetRequest request = square_target();
  request.sensor = read_sensor("third-inch-1280x960");
  request.wavelengths_nm = {620};
  ExposeOptions options;
  options.exposure = Exposure::seconds(1e-7);
  for (const char* source : {"shot", "read", "dark", "dsnu", "prnu", "column", "row", "defects", "linearity"})
    options.without.insert(noise_source(source));
  const RawImage raw = expose(target(request), *request.sensor, options);
  const auto& channels = request.sensor->electronics->channels;
  // The ground, where every pixel is evenly lit: level 1, 1 W/m².
  const double joule = 6.62607015e-34 * 299792458 / 620e-9, side_m = request.sensor->geometry.pitch_um * 1e-6;
  for (int row = 1; row < 3; ++row)
    for (int column = 1; column < 3; ++column) {
      const auto channel = static_cast<std::size_t>(raw.mosaic.channel(row, column));
      const double electrons = side_m * side_m / joule * 1e-7 * channels[channel].quantum_efficiency.at(620);
      EXPECT_NEAR((raw.pixel(row, column) - raw.black_level) / raw.dn_per_e, electrons,
                  2e-3 * electrons + 1 / raw.dn_per_e);
    }
}

TEST(Target, LevelsThatASensorRecordsKeepTheirScale) {
  TargetRequest request = square_target();
  request.sensor = read_sensor("third-inch-1280x960");
  request.black = 0.05, request.white = 0.8;
  const TargetImage levels = relative_target(request);
  ExposeOptions options;
  for (const char* source : {"shot", "read", "dark", "dsnu", "prnu", "column", "row", "defects", "linearity"})
    options.without.insert(noise_source(source));
  const TargetImage recorded = recorded_levels(levels, *request.sensor, options);
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 64; ++column)
      ASSERT_NEAR(recorded.at(row, column), levels.at(row, column), 0.51 / 3920);
}

TEST(Target, RefusesWhatIsNoRequest) {
  TargetRequest request = square_target();
  request.wavelengths_nm = {550, 550};
  EXPECT_THROW(target(request), InputError);
  request.wavelengths_nm = {};
  EXPECT_THROW(target(request), InputError);
  request.wavelengths_nm = {450, 550};
  request.weights = {1};
  EXPECT_THROW(relative_target(request), InputError);
  request.weights = {0, 0};
  EXPECT_THROW(target(request), InputError);
  request = square_target();
  request.white = 0;
  EXPECT_THROW(target(request), InputError);
  EXPECT_THROW(mosaic_target(square_target(), "rggb"), InputError);
}

TEST(Target, CanBeStopped) {
  TargetRequest request = square_target(512);
  request.scene = test_chart("siemens", 512, 512);
  request.wavelengths_nm = {450, 500, 550, 600, 650};
  Context context;
  context.progress = [](double, const std::string&) { return false; };
  EXPECT_THROW(target(request, context), Cancelled);
  EXPECT_THROW(relative_target(request, context), Cancelled);
}

// A square photosite passes sinc(f) along the grid, and a Gaussian exp(−2π²σ²f²).
TEST(Target, ExactSfrOfAGaussianIsItsTransform) {
  TargetRequest request;
  request.columns = request.rows = 64;
  request.pitch_um = 5;
  request.blur = GaussianBlur{2};
  request.scene.polygons = {{{rectangle({32, 32}, 20, 10, 0)}, 0, 0}};
  const auto edges = exact_sfr(request.scene, *target_otf(request), target_options(request));
  ASSERT_EQ(edges.size(), 4U);
  constexpr double pi = 3.14159265358979323846;
  for (const ExactSfr& edge : edges)
    for (const std::size_t step : {10U, 50U, 90U}) {
      const double f = static_cast<double>(step) / 100;
      EXPECT_NEAR(edge.sfr[step], std::sin(pi * f) / (pi * f) * std::exp(-2 * pi * pi * 0.16 * f * f), 1e-9);
    }
}

}  // namespace
}  // namespace petzval
