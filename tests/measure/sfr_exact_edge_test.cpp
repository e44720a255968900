// SPDX-License-Identifier: BSD-3-Clause
// The ruler on edges of exactly known sharpness, with and without noise.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/colour/display.h>
#include <petzval/measure/sfr/iso_esfr.h>
#include <petzval/measure/sfr/measure_edge.h>
#include <petzval/target/render_target.h>

#include <cmath>
#include <random>

namespace petzval {
namespace {

struct Case {
  double angle_deg, f_number, w020, w040;
  int width = 100, height = 100;
};

struct EdgeShot {
  Plane plane;
  std::unique_ptr<RadialOtf> otf;
  TargetOptions options;
  Case c;

  double truth(double f) const {
    const double angle = c.angle_deg * M_PI / 180;
    return std::abs(transfer(*otf, options, f * std::cos(angle), f * std::sin(angle)));
  }
  double true_mtf50() const {
    double high = 0;
    while (truth(high) > 0.5) high += 0.0005;
    double low = high - 0.0005;
    for (int i = 0; i < 50; ++i) (truth(0.5 * (low + high)) > 0.5 ? low : high) = 0.5 * (low + high);
    return low;
  }
  EdgeMeasurement measure(const SfrOptions& sfr = {}) const {
    return measure_edge(samples_in(plane, {0, 0, c.width, c.height}), 1, sfr);
  }
};

EdgeShot shoot(const Case& c) {
  TargetScene scene;
  scene.polygons.push_back({{half_plane({c.width / 2 + 0.3, c.height / 2 + 0.1}, c.angle_deg)}, 0, 0});
  EdgeShot shot{{}, radial_pupil_otf({{c.w020, c.w040}, 0}, 550, c.f_number), {}, c};
  shot.options.columns = c.width, shot.options.rows = c.height, shot.options.pitch_um = 4.73;
  const TargetImage image = render_target(scene, *shot.otf, shot.options);
  shot.plane = {image.columns(), image.rows(), image.values()};
  return shot;
}

void expect_exact(const Case& c) {
  const EdgeShot shot = shoot(c);
  const EdgeMeasurement m = shot.measure();
  double worst = 0;
  for (std::size_t i = 2; i <= 50; ++i)
    worst = std::max(worst, std::abs(m.sfr[i] - shot.truth(m.frequencies_cpp[i])));
  const auto name = testing::Message()
                    << c.angle_deg << " deg f/" << c.f_number << " W " << c.w020 << " " << c.w040;
  EXPECT_LT(worst, 1e-3) << name;
  EXPECT_LT(std::abs(m.mtf50().frequency_cpp / shot.true_mtf50() - 1), 1e-3) << name;
  // Close to the pixel grid a tilt and what the profile cannot follow are hard to tell apart: 2e-3 px at the
  // ends.
  EXPECT_NEAR(m.line.angle_deg(), c.angle_deg, c.angle_deg < 1 ? 2.5e-3 : 1e-3) << name;
}

// 1e-3 in SFR and 0.1 % in MTF50 are what the ruler promises. A blur of 30 pixels radius needs as much room:
// ±80 pixels.
TEST(MeasureEdge, SharpEdgesAtAnyAngle) {
  for (const double f_number : {4.0, 8.0, 16.0})
    for (const double angle : {0.5, 3.0, 12.0, 30.0, 43.0})
      expect_exact({angle, f_number, 0, 0, 100, angle < 1 ? 130 : 100});
}

TEST(MeasureEdge, AberratedEdges) {
  for (const auto& [w020, w040] :
       {std::pair{1.0, 0.0}, {0.0, 0.75}, {2.0, -2.0}, {-2.0, 2.0}, {0.0, 2.0}, {2.0, 0.0}, {0.0, -2.0}}) {
    expect_exact({5, 4, w020, w040});
    expect_exact({20, 8, w020, w040});
    expect_exact({5, 16, w020, w040, 200, 100});
  }
}

TEST(MeasureEdge, HeavyBlurIsMeasured) {
  const EdgeShot shot = shoot({5, 4, 10, 0, 200, 100});
  const EdgeMeasurement m = shot.measure();
  for (std::size_t i = 2; i <= 50; ++i) EXPECT_NEAR(m.sfr[i], shot.truth(m.frequencies_cpp[i]), 1e-3);
}

TEST(MeasureEdge, EveryQuadrantAndBothPolarities) {
  for (const double angle : {-175.0, -95.0, 85.0, 100.0, 185.0}) {
    const EdgeShot shot = shoot({angle, 8, 0, 0});
    const EdgeMeasurement m = shot.measure();
    EXPECT_NEAR(m.mtf50().frequency_cpp / shot.true_mtf50(), 1, 1e-3) << angle;
    EXPECT_NEAR(std::remainder(m.line.angle_deg() - angle, 90), 0, 1e-3);
    // The half-plane is dark on the side that the angle points to.
    EXPECT_NEAR(std::remainder(m.line.normal_rad * 180 / M_PI - angle - 180, 360), 0, 1e-3);
  }
}

TEST(MeasureEdge, NoiseStaysWithinItsConfidence) {
  // 200 seeds: the mean lies within 4 standard errors of the truth, and the scatter is what each measurement
  // says of itself, to 20 % (the standard deviation of 200 draws is known to 5 %; the stated one varies by
  // some per cent itself).
  const EdgeShot clean = shoot({5, 8, 0, 0, 60, 80});
  for (const double sigma : {0.002, 0.01, 0.05}) {
    double sum = 0, square = 0, stated = 0, sfr_sum = 0, sfr_square = 0, sfr_stated = 0;
    constexpr int seeds = 200;
    for (int seed = 0; seed < seeds; ++seed) {
      std::mt19937 random(static_cast<unsigned>(seed + 1));
      std::normal_distribution<double> normal(0, sigma);
      Plane noisy = clean.plane;
      for (double& value : noisy.values) value += normal(random);
      SfrOptions options;
      options.frequencies_cpp = {0, 0.25, 0.5};
      const EdgeMeasurement m = measure_edge(samples_in(noisy, {0, 0, 60, 80}), 1, options);
      const double error = m.mtf50().frequency_cpp - clean.true_mtf50(),
                   sfr_error = m.sfr[1] - clean.truth(0.25);
      sum += error / seeds, square += error * error / seeds, stated += m.mtf50().deviation_cpp / seeds;
      sfr_sum += sfr_error / seeds, sfr_square += sfr_error * sfr_error / seeds,
          sfr_stated += m.sfr_deviation[1] / seeds;
    }
    EXPECT_LT(std::abs(sum), 4 * stated / std::sqrt(seeds)) << "sigma " << sigma;
    EXPECT_NEAR(std::sqrt(square - sum * sum) / stated, 1, 0.2) << "sigma " << sigma;
    EXPECT_LT(std::abs(sfr_sum), 4 * sfr_stated / std::sqrt(seeds)) << "sigma " << sigma;
    EXPECT_NEAR(std::sqrt(sfr_square - sfr_sum * sfr_sum) / sfr_stated, 1, 0.2) << "sigma " << sigma;
  }
}

/// The light of code values of 8 bits.
std::vector<double> eight_bit_levels(bool srgb) {
  std::vector<double> levels;
  for (int code = 0; code < 256; ++code) levels.push_back(srgb ? srgb_decoded(code / 255.0) : code / 255.0);
  return levels;
}

TEST(MeasureEdge, RoundingToEightBitsStaysWithinItsConfidence) {
  // 200 seeds, each with its own levels, place and angle, half of them with noise of up to half a step, half
  // of each in sRGB: the errors over what each measurement states of itself have a root mean square of 1.
  // That of 100 draws is known to 7 %; errors of rounding are no Gaussian, and what is stated rests on an
  // estimate of where in a step light lies.
  const std::vector<double> levels[2] = {eight_bit_levels(false), eight_bit_levels(true)};
  double square[2] = {0, 0}, sfr_square[2] = {0, 0};
  constexpr int seeds = 200;
  for (int seed = 0; seed < seeds; ++seed) {
    const int noisy = seed % 2, srgb = seed / 2 % 2;
    std::mt19937 random(static_cast<unsigned>(seed + 1));
    std::uniform_real_distribution<double> share(0, 1);
    std::normal_distribution<double> normal(0, 1);
    const double black = 0.02 + 0.1 * share(random), white = 0.6 + 0.35 * share(random);
    EdgeShot shot = shoot({3 + 8 * share(random), 8, 0, 0, 60, 80});
    const double noise_steps = noisy ? 0.5 * share(random) : 0;
    for (double& value : shot.plane.values) {
      const double light = black + (white - black) * value, code = 255 * (srgb ? srgb_encoded(light) : light);
      const double rounded = std::round(code + noise_steps * normal(random));
      value = levels[srgb][static_cast<std::size_t>(std::clamp(rounded, 0.0, 255.0))];
    }
    SfrOptions options;
    options.frequencies_cpp = {0, 0.25};
    options.code_levels = levels[srgb];
    const EdgeMeasurement m = shot.measure(options);
    const double error = (m.mtf50().frequency_cpp - shot.true_mtf50()) / m.mtf50().deviation_cpp;
    const double sfr_error = (m.sfr[1] - shot.truth(0.25)) / m.sfr_deviation[1];
    square[noisy] += error * error / (seeds / 2), sfr_square[noisy] += sfr_error * sfr_error / (seeds / 2);
  }
  for (const int noisy : {0, 1}) {
    EXPECT_NEAR(std::sqrt(square[noisy]), 1, 0.3) << "noise " << noisy;
    EXPECT_NEAR(std::sqrt(sfr_square[noisy]), 1, 0.3) << "noise " << noisy;
  }
}

TEST(MeasureEdge, EdgesAlongTheGridSayWhatTheyDoNotKnow) {
  // Rows of samples 1 or 1/√2 pixels apart leave a frequency and its alias mixed: stated, and noted, and not
  // refused.
  for (const double angle : {0.0, 90.0, 45.0}) {
    const EdgeShot shot = shoot({angle, 8, 0, 0});
    const EdgeMeasurement m = shot.measure();
    EXPECT_EQ(m.notes.size(), 1u) << angle;
    for (std::size_t i = 2; i <= 50; ++i)
      EXPECT_LT(std::abs(m.sfr[i] - shot.truth(m.frequencies_cpp[i])), 3 * m.sfr_deviation[i])
          << angle << " " << i;
  }
  // A little tilt lets the samples fill the pixel.
  for (const double angle : {0.3, 0.5, 44.5})
    EXPECT_TRUE(shoot({angle, 8, 0, 0, 100, 120}).measure().notes.empty()) << angle;
}

/// An edge that is an arc of a circle.
EdgeShot shoot_arc(double radius_px) {
  TargetScene scene;
  scene.polygons.push_back({{regular_polygon({52 - radius_px, 52}, radius_px, 60000, 3)}, 0, 0});
  EdgeShot shot = shoot({0, 8, 0, 0});
  const TargetImage image = render_target(scene, *shot.otf, shot.options);
  shot.plane.values = image.values();
  return shot;
}

TEST(MeasureEdge, BentEdgesAreMeasuredAsTheyAre) {
  // Over 100 px arcs of these radii leave their tangents by 1.8, 1.25 and 0.3 px. The normal turns by up to
  // ±4°, over which the photosite's own response changes by 1e-3.
  for (const double radius : {700.0, 1000.0, 4000.0}) {
    const EdgeShot shot = shoot_arc(radius);
    const EdgeMeasurement m = shot.measure();
    EXPECT_LT(std::abs(m.mtf50().frequency_cpp / shot.true_mtf50() - 1), 3e-3) << radius;
    EXPECT_NEAR(std::abs(m.line.bend[1]), m.line.half_length * m.line.half_length / (2 * radius), 0.02)
        << radius;
    SfrOptions straight;
    straight.edge_order = 1;
    EXPECT_GT(shot.measure(straight).noise_bright, 10 * m.noise_bright) << radius;
  }
}

TEST(MeasureEdge, StraightEdgesStayStraightUnderNoise) {
  const EdgeShot clean = shoot({5, 8, 0, 0, 60, 80});
  int bent = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 0.02);
    Plane noisy = clean.plane;
    for (double& value : noisy.values) value += normal(random);
    bent += measure_edge(samples_in(noisy, {0, 0, 60, 80}), 1, {}).line.bend.size() > 1;
  }
  EXPECT_LE(bent, 1);  // five deviations: one in a million
}

// Light that falls off linearly over the picture takes the same share of both sides.
TEST(MeasureEdge, UnevenLightIsToldFromTheEdge) {
  for (const double fall : {0.01, 0.05, 0.1})
    for (const double direction_deg : {0.0, 60.0, 90.0, 180.0}) {
      EdgeShot shot = shoot({5, 8, 0, 0});
      const double c = std::cos(direction_deg * M_PI / 180), s = std::sin(direction_deg * M_PI / 180);
      for (int row = 0; row < 100; ++row)
        for (int column = 0; column < 100; ++column) {
          double& value = shot.plane.values[static_cast<std::size_t>(100 * row + column)];
          value = (0.05 + 0.9 * value) * (1 - fall * ((column - 50) * c + (row - 50) * s) / 100);
        }
      const EdgeMeasurement m = shot.measure();
      EXPECT_NEAR(m.mtf50().frequency_cpp / shot.true_mtf50(), 1, 5e-3) << fall << " at " << direction_deg;
      // 80 of the 100 pixels, as far as every distance is well covered, are a part of the fall.
      if (fall > 0.04) {
        EXPECT_NEAR(m.light_variation, fall, 0.4 * fall) << fall << " at " << direction_deg;
      }
    }
}

// Light as vignetting leaves it, a parabola about a point beyond the picture. Along the pixel grid the
// profile must not take it up by steps between the rows of samples; the bounds are those of even light
// (docs/SFR.md).
TEST(MeasureEdge, LightOfVignettingIsToldFromEdgesAlongTheGrid) {
  for (const double fall : {0.02, 0.08})
    for (const double angle_deg : {0.0, 0.1, 0.25, 5.0}) {
      EdgeShot shot = shoot({angle_deg, 8, 0, 0});
      for (int row = 0; row < 100; ++row)
        for (int column = 0; column < 100; ++column) {
          const double x = (column - 130) / 100.0, y = (row + 20) / 100.0;
          double& value = shot.plane.values[static_cast<std::size_t>(100 * row + column)];
          value = (0.05 + 0.9 * value) * (1 - fall * (x * x + y * y));
        }
      const EdgeMeasurement m = shot.measure();
      EXPECT_NEAR(m.mtf50().frequency_cpp / shot.true_mtf50(), 1, angle_deg == 0 ? 0.05 : 5e-3)
          << fall << " at " << angle_deg;
      EXPECT_NEAR(m.line.angle_deg(), angle_deg, 0.03) << fall;
    }
}

// What a board through a wide lens shows in its middle: a ramp of 1.56 pixels, as lines between the samples
// of a scene are, averaged over pixels, exactly along the grid, in light that falls as cos⁴. Its response is
// sinc(f) sinc(1.56 f).
TEST(MeasureEdge, LinesAlongTheGridStayThereUnderTheLightOfAWideLens) {
  constexpr double ramp = 1.5625;
  // The integral of the ramp from 0 to 1 between ±ramp/2.
  const auto integral = [](double x) {
    const double u = std::clamp(x, -ramp / 2, ramp / 2) + ramp / 2;
    return u * u / (2 * ramp) + std::max(0.0, x - ramp / 2);
  };
  double low = 0.1, high = 0.5;
  const auto sinc = [](double x) { return std::sin(M_PI * x) / (M_PI * x); };
  for (int i = 0; i < 40; ++i) {
    const double f = 0.5 * (low + high);
    (sinc(f) * sinc(ramp * f) > 0.5 ? low : high) = f;
  }
  for (const double place : {0.0, 0.35})
    for (const auto& [width, height] : {std::pair{30, 60}, {96, 152}}) {
      Plane plane{width, height, {}};
      for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
          const double x = column - width / 2 - place, r = std::hypot(x + 20, row + 10) / 1100;
          plane.values.push_back((integral(x + 1) - integral(x)) / std::pow(1 + r * r, 2));
        }
      const EdgeMeasurement m = measure_edge(samples_in(plane, {0, 0, width, height}), 1, {});
      EXPECT_NEAR(m.line.angle_deg(), 0, 0.03) << place << " of " << width;
      // Rows a pixel apart do not tell what lies between them, and it is stated by how much.
      EXPECT_LT(std::abs(m.mtf50().frequency_cpp - low), 2 * m.mtf50().deviation_cpp)
          << place << " of " << width;
      EXPECT_LT(m.mtf50().deviation_cpp, 0.4 * low) << place << " of " << width;
    }
}

TEST(MeasureEdge, IsoMethodIsNearAndLow) {
  // The taper and the box of the bin cost some per cent, no more, on a compact PSF.
  const EdgeShot shot = shoot({5, 8, 0, 0});
  const IsoEsfr iso = iso_esfr(shot.plane, {0, 0, 100, 100});
  EXPECT_NEAR(iso.mtf50_cpp / shot.true_mtf50(), 1, 0.03);
  EXPECT_NEAR(iso.angle_deg, 5, 0.2);
}

TEST(MeasureEdge, RefusesWhatIsNoEdge) {
  const auto message = [](const Plane& plane, const PixelBox& box,
                          const SfrOptions& options = {}) -> std::string {
    try {
      measure_edge(samples_in(plane, box), 1, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  Plane flat{60, 60, std::vector<double>(3600, 0.5)};
  EXPECT_NE(message(flat, {0, 0, 60, 60}).find("no edge"), std::string::npos);
  EXPECT_NE(message(flat, {0, 0, 0, 60}).find("empty"), std::string::npos);
  EXPECT_NE(message(flat, {30, 30, 60, 60}).find("leaves the picture"), std::string::npos);
  EXPECT_NE(message(flat, {2147483647, 0, 60, 60}).find("leaves the picture"), std::string::npos);
  EXPECT_NE(message(flat, {0, 0, 7, 7}).find("at least 64"), std::string::npos);
  std::mt19937 random(3);
  for (double& value : flat.values) value = std::uniform_real_distribution<double>(0, 1)(random);
  EXPECT_NE(message(flat, {0, 0, 60, 60}).find("no edge"), std::string::npos);
  flat.values[100] = NAN;
  EXPECT_NE(message(flat, {0, 0, 60, 60}).find("not a finite number"), std::string::npos);
  // An overexposed edge: the bright side is cut off at 0.7.
  EdgeShot shot = shoot({5, 8, 1, 0});
  for (double& value : shot.plane.values) value = std::min(value, 0.7);
  SfrOptions options;
  options.clip_high = 0.7;
  EXPECT_NE(message(shot.plane, {0, 0, 100, 100}, options).find("clipped"), std::string::npos);
  // Extreme values and shapes end in an answer or a refusal, never in a crash or NaN.
  for (const double scale : {1e-300, 1e300}) {
    Plane odd = shoot({5, 8, 0, 0}).plane;
    for (double& value : odd.values) value *= scale;
    message(odd, {0, 0, 100, 100});
    message(odd, {40, 0, 20, 4});
  }
}

}  // namespace
}  // namespace petzval
