// SPDX-License-Identifier: BSD-3-Clause
// Rays bent at the stop against the Airy disc: how near an approximation without phases comes, and that it
// stays so.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/numeric/sobol.h>
#include <petzval/render/camera/lens_camera.h>

#include <cmath>

namespace petzval::render {
namespace {

constexpr double wavelength_nm = 550, f_number = 22;
constexpr int directions = 1 << 16;

/// Where on the film the light of a far point lands that a ray from the film's middle finds [λN], and its
/// weight.
struct Landed {
  double x, y, weight;
};

std::vector<Landed> spread_of(const StopBlades& blades, bool diffraction, double scale = 1) {
  MountedLens camera(read_lens("dgauss-50mm").lens);
  camera.set_f_number(f_number);
  camera.focus_at_m({});
  LensCameraOptions options;
  camera.set_blades(blades);
  options.diffraction = diffraction;
  const SensorGeometry pixel{1, 1, 1};
  const WavelengthGroups groups({wavelength_nm * scale});
  const LensCamera lens(camera.lens(), pixel, groups, options);
  std::vector<FilmSample> samples(directions);
  for (std::uint32_t i = 0; i < directions; ++i) {
    SobolSample numbers(7, i);
    const auto [u, v, a, b] = numbers.next4();
    samples[i].column = samples[i].row = 0.5;
    samples[i].u = u, samples[i].v = v, samples[i].bend = {a, b};
  }
  std::vector<CameraRay> rays(directions);
  lens.trace(0, FilmSampling(PixelWindow{0, 0, 1, 1}), samples, rays);
  const double unit = wavelength_nm * mm_per_nm * f_number / first_order(camera.lens()).efl_mm;
  std::vector<Landed> landed;
  for (const CameraRay& ray : rays)
    if (ray.passes)
      landed.push_back({ray.direction.x / ray.direction.z / unit, ray.direction.y / ray.direction.z / unit,
                        static_cast<double>(ray.weight[0])});
  return landed;
}

double within(const std::vector<Landed>& landed, double radius) {
  double inside = 0, all = 0;
  for (const Landed& each : landed) {
    all += each.weight;
    if (std::hypot(each.x, each.y) < radius) inside += each.weight;
  }
  return inside / all;
}

double contrast(const std::vector<Landed>& landed, double per_unit, double azimuth = 0) {
  double sum = 0, all = 0;
  for (const Landed& each : landed) {
    all += each.weight;
    sum +=
        each.weight * std::cos(2 * pi * per_unit * (each.x * std::cos(azimuth) + each.y * std::sin(azimuth)));
  }
  return sum / all;
}

/// Lord Rayleigh's.
double airy_within(double radius) {
  const double j0 = std::cyl_bessel_j(0, pi * radius), j1 = std::cyl_bessel_j(1, pi * radius);
  return 1 - j0 * j0 - j1 * j1;
}

double airy_contrast(double s) {
  return 2 / pi * (std::acos(s) - s * std::sqrt(1 - s * s));
}

/// The law of Freniere, Gregory and Hassler (1999) by itself, without a lens or random numbers: a ray that
/// crosses a round stop of radius 1 at the distance d from its edge is bent by a normal distribution of
/// standard deviation λ/(4π d), which is 1/(2π d) in units of λN. Mean over the stop of `value`(σ across, σ
/// along).
template <class Value>
double by_law(const Value& value) {
  constexpr int nodes = 600;
  const QuadratureRule rule = gauss_legendre(nodes);
  double sum = 0;
  for (int i = 0; i < nodes; ++i) {
    // Crowded towards the edge, where bends change fastest.
    const auto k = static_cast<std::size_t>(i);
    const double q = rule.nodes[k], rho = 1 - q * q * q, d_rho = 3 * q * q * rule.weights[k];
    const double across = 1 - rho, along = std::sqrt(1 - rho * rho);
    sum += 2 * rho * d_rho * value(1 / (2 * pi * across), 1 / (2 * pi * along));
  }
  return sum;
}

double within_by_law(double radius) {
  const QuadratureRule rule = gauss_legendre(64);
  return by_law([&](double across, double along) {
    // Strips of the narrower distribution, and how much of the wider one each holds.
    const double reach = std::min(radius, 9 * along);
    double share = 0;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double b = reach * rule.nodes[i];
      share += 2 * reach * rule.weights[i] * std::exp(-b * b / (2 * along * along)) /
               (along * std::sqrt(2 * pi)) * std::erf(std::sqrt((radius * radius - b * b) / 2) / across);
    }
    return share;
  });
}

double contrast_by_law(double per_unit) {
  constexpr int azimuths = 64;
  return by_law([&](double across, double along) {
    double sum = 0;
    for (int i = 0; i < azimuths; ++i) {
      const double c = std::cos(2 * pi * (i + 0.5) / azimuths), s = std::sin(2 * pi * (i + 0.5) / azimuths);
      const double k = 2 * pi * per_unit;
      sum += std::exp(-0.5 * k * k * (across * across * c * c + along * along * s * s)) / azimuths;
    }
    return sum;
  });
}

/// Through a lens and at random it is the law that it should be.
TEST(StopDiffraction, FollowsTheLaw) {
  const std::vector<Landed> landed = spread_of({}, true);
  // The lens itself is sharp to a twentieth of λN, so that what is seen is diffraction.
  EXPECT_GT(within(spread_of({}, false), 0.05), 0.999);
  // Three standard errors of 65,536 directions at random: 3 √(¼/65536) = 0.006.
  for (const double radius : {0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0})
    EXPECT_NEAR(within(landed, radius), within_by_law(radius), 0.006) << radius;
  for (int i = 1; i < 10; ++i) EXPECT_NEAR(contrast(landed, 0.1 * i), contrast_by_law(0.1 * i), 0.006) << i;
}

/// How far the law is from the Airy disc can be said without a measurement. Far out, only rays beside the
/// edge count: their share is 2 ∫ erfc(√2 π d r) dd = √2/(π^1.5 r), Airy's (Rayleigh) 2/(π² r): √(π/2) = 1.25
/// times as much.
TEST(StopDiffraction, TheLawIsSoFarFromTheAiryDisc) {
  // The next term of both is smaller by 1/r² or so.
  EXPECT_NEAR((1 - within_by_law(30)) * 30, std::sqrt(2) / std::pow(pi, 1.5), 0.002);
  EXPECT_NEAR((1 - airy_within(30)) * 30, 2 / (pi * pi), 0.005);
  // What docs/RENDERING.md says of the MTF, and that it knows no highest frequency.
  for (int i = 1; i <= 5; ++i) EXPECT_NEAR(contrast_by_law(0.1 * i), airy_contrast(0.1 * i), 0.05) << i;
  EXPECT_GT(contrast_by_law(0.8), 0.2);
  EXPECT_LT(airy_contrast(0.8), 0.11);
  EXPECT_GT(contrast_by_law(1.1), 0.05);
}

TEST(StopDiffraction, GrowsWithTheWavelengthAndLosesNoLight) {
  const std::vector<Landed> green = spread_of({}, true), red = spread_of({}, true, 1.25);
  for (const double radius : {0.5, 1.0, 2.0})
    EXPECT_NEAR(within(red, 1.25 * radius), within(green, radius), 0.003);
  double sum = 0, sharp = 0;
  for (const Landed& each : green) sum += each.weight;
  for (const Landed& each : spread_of({}, false)) sharp += each.weight;
  EXPECT_GT(sum / sharp, 0.995);  // what is bent out of the lens
}

/// Light goes across the edges: a square stop spreads it in a cross, which turns with the blades.
TEST(StopDiffraction, SpreadsAcrossTheBlades) {
  const auto in_cross = [](const std::vector<Landed>& landed, double turned) {
    double arms = 0, all = 0;
    for (const Landed& each : landed) {
      const double r = std::hypot(each.x, each.y), azimuth = std::atan2(each.y, each.x) - turned;
      if (r < 3) continue;
      all += each.weight;
      if (std::abs(std::remainder(azimuth, pi / 2)) < pi / 16) arms += each.weight;
    }
    return arms / all;
  };
  // Corners at the top and the sides; turned by 45 degrees the edges face them.
  const std::vector<Landed> square = spread_of({4, 45}, true), diamond = spread_of({4, 0}, true);
  EXPECT_GT(in_cross(square, 0), 0.6);  // of a quarter of all azimuths
  EXPECT_LT(in_cross(square, pi / 4), 0.1);
  EXPECT_GT(in_cross(diamond, pi / 4), 0.6);
}

}  // namespace
}  // namespace petzval::render
