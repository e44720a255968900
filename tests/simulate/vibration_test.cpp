// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/clip.h>
#include <petzval/simulate/vibration.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace petzval {
namespace {

// 4000 clips: their mean square is known to √(2/4000), 2.2 %.
TEST(Vibration, HasTheVarianceOfItsSpectrum) {
  const VibrationSpectrum spectrum({{1, 2e-5, 0}, {10, 8e-5, 4e-5}, {20, 0, 4e-5}});
  const double pan2 = 9 * 5e-5 + 10 * 4e-5, pitch2 = 9 * 2e-5 + 10 * 4e-5;
  EXPECT_NEAR(spectrum.rms_pan_deg(), std::sqrt(pan2), 1e-12);
  double pan = 0, pitch = 0, together = 0;
  constexpr int clips = 4000;
  for (int seed = 0; seed < clips; ++seed) {
    const SceneAim aim = spectrum.shaken({}, 1e-3, static_cast<std::uint64_t>(seed)).at(0);
    pan += aim.pan_deg * aim.pan_deg / clips;
    pitch += aim.pitch_deg * aim.pitch_deg / clips;
    together += aim.pan_deg * aim.pitch_deg / clips;
  }
  EXPECT_NEAR(pan / pan2, 1, 0.09);
  EXPECT_NEAR(pitch / pitch2, 1, 0.09);
  EXPECT_NEAR(together / std::sqrt(pan2 * pitch2), 0, 4.5 / std::sqrt(double(clips)));
}

// The periodogram of one path, summed over two bands.
TEST(Vibration, HasThePowerOfEachBand) {
  const VibrationSpectrum spectrum({{0, 1e-4, 0}, {10, 1e-4, 0}, {10.001, 3e-4, 0}, {30, 3e-4, 0}});
  constexpr double seconds = 20;
  const MotionPath path = spectrum.shaken({}, seconds, 7);
  const auto power = [&](double from_hz, double to_hz) {
    double sum = 0;
    const std::size_t count = path.keys().size() - 1;
    for (double f = from_hz; f < to_hz; f += 1 / seconds) {
      std::complex<double> transform;
      for (std::size_t i = 0; i < count; ++i)
        transform += path.keys()[i].aim.pan_deg * std::polar(1.0, -2 * pi * f * path.keys()[i].t_s);
      sum += 2 * std::norm(transform / double(count));
    }
    return sum;
  };
  EXPECT_NEAR(power(1, 9) / (8 * 1e-4), 1, 0.1);
  EXPECT_NEAR(power(12, 28) / (16 * 3e-4), 1, 0.1);
}

// The MTF of a long exposure: the mean of exp(2πifx) over a Gaussian x. 30 s of 45 Hz are 2700 independent
// angles: known to 0.014.
TEST(Vibration, BlursByTheGaussianLaw) {
  constexpr double sigma_deg = 0.02;
  const MotionPath path = VibrationSpectrum::parse("0.02@5-50").shaken({}, 30, 3);
  for (const double exponent : {0.1, 0.5, 1.0, 2.0}) {
    const double cycles_per_deg = std::sqrt(exponent / 2) / (pi * sigma_deg);
    std::complex<double> mean;
    for (const MotionPath::Key& key : path.keys())
      mean += std::polar(1.0 / double(path.keys().size()), 2 * pi * cycles_per_deg * key.aim.pan_deg);
    EXPECT_NEAR(std::abs(mean), std::exp(-exponent), 0.045) << exponent;
  }
}

// A frame of a bar against one at rest: each frequency is weaker by |∫exp(2πifx(t))dt|/T of the very path.
// The lens's scale off the axis, and light in straight lines in between, cost less than 1 %.
TEST(Vibration, BlursAFrameAsItsPathSays) {
  Camera camera;
  camera.lens = read_lens("edmund-54852").lens;
  Sensor sensor = read_sensor("third-inch-1280x960", {"columns=64", "rows=16"});
  sensor.electronics->channels = {{"grey", Spectrum({400, 700}, {0.5, 0.5})}};
  sensor.electronics->mosaic = {};
  camera.sensor = sensor;
  Scene scene(1200, 120, {550}, 20, {});
  for (int row = 0; row < scene.rows(); ++row)
    for (int column = 590; column < 610; ++column)
      scene.band(0)[static_cast<std::size_t>(row * scene.columns() + column)] = 1;
  ImageOptions unblurred;
  unblurred.imaging.method = BlurMethod::none;
  constexpr double exposure_s = 0.03;
  ClipOptions options;
  for (int i = 0; i < static_cast<int>(noise_source_names().size()); ++i)
    options.expose.without.insert(static_cast<NoiseSource>(i));
  // As much light as that exposure takes.
  const double bright_s = Clip(plan_image(scene, camera, unblurred), sensor, options).exposure_s();
  for (float& value : scene.band(0)) value *= static_cast<float>(bright_s / exposure_s);
  const ImagePlan plan = plan_image(scene, camera, unblurred);
  options.expose.exposure = Exposure::seconds(exposure_s);

  const double px_per_deg = plan.table.first_order.efl_mm * radians(1) / (sensor.geometry.pitch_um * 1e-3);
  constexpr double sigma_px = 1.5, from_hz = 20, to_hz = 80;
  const double density = std::pow(sigma_px / px_per_deg, 2) / (to_hz - from_hz);
  const MotionPath path =
      VibrationSpectrum({{from_hz, density, 0}, {to_hz, density, 0}}).shaken({}, exposure_s, 5);
  const auto frame_of = [&](const MotionPath& motion) {
    options.motion = motion;
    return Clip(plan, sensor, options).frame(0);
  };
  const RawImage shaken = frame_of(path), still = frame_of({});
  EXPECT_LT(*std::ranges::max_element(still.samples), still.white_level);
  const auto transform = [&](const RawImage& frame, double f_cpp) {
    std::complex<double> sum;
    for (int c = 0; c < frame.columns; ++c)
      sum += (frame.pixel(8, c) - frame.black_level) * std::polar(1.0, 2 * pi * f_cpp * c);
    return std::abs(sum);
  };
  for (const double f_cpp : {0.03, 0.05}) {
    std::complex<double> mean;
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i)
      mean += std::polar(1.0 / steps,
                         2 * pi * f_cpp * px_per_deg * path.at(exposure_s * (i + 0.5) / steps).pan_deg);
    EXPECT_NEAR(transform(shaken, f_cpp) / transform(still, f_cpp) / std::abs(mean), 1, 0.01) << f_cpp;
  }
}

TEST(Vibration, RefusesWhatIsNoSpectrum) {
  EXPECT_THROW(VibrationSpectrum({{1, 1, 1}}), InputError);
  EXPECT_THROW(VibrationSpectrum({{2, 1, 1}, {1, 1, 1}}), InputError);
  EXPECT_THROW(VibrationSpectrum({{1, -1, 1}, {2, 1, 1}}), InputError);
  for (const char* text : {"", "0.02", "0@1-20", "0.02@20-1", "x@1-20", "none.csv"})
    EXPECT_THROW(VibrationSpectrum::parse(text), InputError) << text;
  EXPECT_THROW(VibrationSpectrum::parse("0.02@1-1e6").shaken({}, 1000, 1), InputError);
}

}  // namespace
}  // namespace petzval
