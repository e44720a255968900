// SPDX-License-Identifier: BSD-3-Clause
// Pupils of any shape and wavefront against other methods: areas of clipped polygons, the radial quadrature,
// and the Fourier pair of a plain sum over the pupil.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/wave/pupil_otf.h>

#include <cmath>

#include "clipped_blades.h"

namespace petzval {
namespace {

GeneralPupil blades(int count, double rotation_deg = 0, double curvature = 0, double obstruction = 0) {
  GeneralPupil pupil;
  pupil.shape = {count, rotation_deg * pi / 180, curvature, obstruction};
  return pupil;
}

/// λN = 1 µm: frequencies in cycles/µm are those of the cut-off.
std::unique_ptr<Otf> unit_otf(const GeneralPupil& pupil) {
  return general_pupil_otf(pupil, 1000, 1);
}

TEST(PupilOtf, OfRadialWavefrontsIsTheRadialOne) {
  // Fringe 4 is 2ρ² − 1 and Fringe 9 is 6ρ⁴ − 6ρ² + 1: W020 = 2c₄ − 6c₉ and W040 = 6c₉.
  for (const double obstruction : {0.0, 0.35}) {
    GeneralPupil pupil;
    pupil.shape.obstruction = obstruction;
    pupil.zernike_waves = {0, 0, 0, 0.7, 0, 0, 0, 0, -0.25};
    pupil.w_waves = {0.4, 0.1};
    const RadialPupil same{{0.4 + 1.4 + 1.5, 0.1 - 1.5}, obstruction};
    for (const double s : {0.02, 0.17, 0.33, 0.5, 0.66, 0.83, 0.97})
      for (const double theta : {0.0, 0.7, -2.1}) {
        const std::complex<double> otf = pupil_otf_at(pupil, s, theta);
        EXPECT_NEAR(otf.real(), radial_otf(same, std::vector<double>{s})[0], 1e-9) << s << " " << theta;
        EXPECT_NEAR(otf.imag(), 0, 1e-9);
      }
  }
}

TEST(PupilOtf, OfBladesIsTheAreaOfOverlap) {
  for (const int count : {3, 5, 6, 7, 8})
    for (const double s : {0.01, 0.2, 0.45, 0.7, 0.9})
      for (const double theta_deg : {0.0, 11.0, 30.0, 77.3, 144.0, -60.0})
        EXPECT_NEAR(std::abs(pupil_otf_at(blades(count, 13), s, theta_deg * pi / 180) -
                             test::blade_otf(count, 13, s, theta_deg)),
                    0, 1e-10)
            << count << " blades, " << s << " at " << theta_deg;
}

TEST(PupilOtf, TableMeetsTheQuadrature) {
  GeneralPupil comatic = blades(7, 20, 0.4), round = blades(0), obstructed = blades(8, 0, 0, 0.3);
  comatic.zernike_waves = {0, 0, 0, 0.3, 0.2, 0, 0, 0.25, 0.1};
  comatic.w_waves = {0.5};
  round.zernike_waves = {0, 0, 0, 0, 0.5, -0.3, 0.3, 0, 0.2};
  struct Bound {
    GeneralPupil pupil;
    double rms, largest;
  };
  // Where corners pass edges the sixth order falls to the second, and where an obstruction touches a rim to
  // 3/2: the largest error is that within a step of such places, the RMS says how few they are.
  for (const auto& [pupil, rms, largest] : {Bound{blades(6, 5), 1e-6, 1e-5},
                                            {blades(5), 1e-6, 1e-5},
                                            {obstructed, 1e-5, 1e-4},
                                            {comatic, 5e-6, 2e-5},
                                            {round, 1e-6, 5e-6}}) {
    const auto otf = unit_otf(pupil);
    double square = 0;
    constexpr int places = 100;
    for (int i = 0; i < places; ++i) {
      const double s = 0.95 * std::fmod(0.37 + i * 0.618034, 1), theta = 2 * pi * std::fmod(i * 0.754877, 1);
      // The picture's x runs against x'.
      const double error = std::abs(otf->at(-1e3 * s * std::cos(theta), 1e3 * s * std::sin(theta)) -
                                    pupil_otf_at(pupil, s, theta));
      EXPECT_LT(error, largest) << pupil.shape.blades << " blades, s " << s << " theta " << theta;
      square += error * error / places;
    }
    EXPECT_LT(std::sqrt(square), rms) << pupil.shape.blades << " blades";
  }
}

TEST(PupilOtf, ManyBladesAndRoundBladesAreACircle) {
  for (const double s : {0.05, 0.4, 0.8}) {
    const double circle = radial_otf({}, std::vector<double>{s})[0];
    for (const double theta : {0.0, 0.3}) {
      EXPECT_NEAR(std::abs(pupil_otf_at(blades(6, 0, 1), s, theta)), circle, 1e-9);
      EXPECT_NEAR(std::abs(pupil_otf_at(blades(8, 0, 1, 0), s, theta)), circle, 1e-9);
      // The polygon's radius falls short of the circle's by π²/2n² at the most.
      double before = 1;
      for (const int count : {10, 40, 160}) {
        const double off = std::abs(std::abs(pupil_otf_at(blades(count), s, theta)) - circle);
        EXPECT_LT(off, pi * pi / (count * count));
        EXPECT_LT(off, before / 4) << "falls with the square of the number";
        before = off;
      }
    }
  }
}

/// U by a plain sum: the shape as triangles from its middle, each by a product rule; nothing in common with
/// strips.
std::complex<double> plain_amplitude(const GeneralPupil& pupil, double x, double y) {
  static const QuadratureRule rule = gauss_legendre(40);
  const int sides = pupil.shape.is_round() ? 12 : pupil.shape.blades;
  std::complex<double> sum = 0;
  double area = 0;
  for (int side = 0; side < sides; ++side) {
    const double from = pupil.shape.rotation_rad + 2 * pi * side / sides, to = from + 2 * pi / sides;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      // A ray from the middle to the rim: an arc, or the chord between two corners.
      const double angle = from + (to - from) * rule.nodes[i];
      const double rim =
          pupil.shape.is_round() ? 1 : std::cos(pi / sides) / std::cos(angle - 0.5 * (from + to));
      for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
        const double inner = pupil.shape.obstruction, rho = inner + (rim - inner) * rule.nodes[j];
        const double px = rho * std::cos(angle), py = rho * std::sin(angle);
        const double weight = rule.weights[i] * (to - from) * rule.weights[j] * (rim - inner) * rho;
        sum += weight * std::polar(1.0, -2 * pi * pupil.aberration(px, py) - pi * (px * x + py * y));
        area += weight;
      }
    }
  }
  return sum / area;
}

TEST(PupilOtf, IsTheFourierPairOfThePsf) {
  GeneralPupil comatic;
  comatic.zernike_waves = {0, 0, 0, 0.2, 0.1, 0, 0.3, 0.4};
  GeneralPupil hexagon = blades(6, 7, 0, 0.25);
  hexagon.zernike_waves = {0, 0, 0, 0.3, 0, 0.2, 0, -0.3, 0, 0.2};
  for (const GeneralPupil& pupil : {comatic, hexagon, blades(5, 4)}) {
    const auto otf = unit_otf(pupil);
    // A sum over a lattice of frequencies 1/256 apart is the PSF with its copies 256 λN apart, each below
    // 5e-7 of the peak even on a spike.
    constexpr int steps = 256;
    const std::vector<std::pair<double, double>> places{
        {0, 0}, {0.9, 0.4}, {-2.3, 1.7}, {3.1, -4.2}, {0.2, 6.5}};
    std::vector<std::complex<double>> sums(places.size());
    std::vector<double> fy;
    for (int l = -steps; l <= steps; ++l) fy.push_back(1e3 * l / steps);
    std::vector<std::complex<double>> values(fy.size());
    for (int k = -steps; k <= steps; ++k) {
      otf->evaluate(-1e3 * k / steps, fy, values);
      for (std::size_t p = 0; p < places.size(); ++p) {
        const std::complex<double> step = std::polar(1.0, 2 * pi * places[p].second / steps);
        std::complex<double> turn =
            std::polar(1.0, 2 * pi * (places[p].first * k - places[p].second * steps) / steps);
        for (const std::complex<double>& value : values) {
          sums[p] += value * turn;
          turn *= step;
        }
      }
    }
    for (std::size_t p = 0; p < places.size(); ++p) {
      const double psf = sums[p].real() / (steps * steps) * 4 / pupil.shape.area();
      const auto [x, y] = places[p];
      EXPECT_NEAR(psf, std::norm(plain_amplitude(pupil, x, y)), 3e-6) << x << " " << y;
      EXPECT_NEAR(std::abs(pupil_amplitude_at(pupil, x, y) - plain_amplitude(pupil, x, y)), 0, 1e-9);
    }
  }
}

TEST(PupilOtf, TiltMovesThePicture) {
  // W = a y (Fringe 3) puts the PSF at y' = −2aλN; a stored picture has y down, along y'.
  GeneralPupil pupil;
  pupil.zernike_waves = {0, 0.1, 0.35};
  const std::complex<double> otf = unit_otf(pupil)->at(50, 100);
  const double clear = radial_otf({}, std::vector<double>{std::hypot(0.05, 0.1)})[0];
  const std::complex<double> expected = clear * std::polar(1.0, -2 * pi * (0.05 * 0.2 + 0.1 * -0.7));
  EXPECT_NEAR(std::abs(otf - expected), 0, 1e-6);
}

TEST(PupilOtf, RefusesWhatIsNoPupil) {
  EXPECT_THROW(unit_otf(blades(2)), InputError);
  EXPECT_THROW(unit_otf(blades(6, 0, 1.5)), InputError);
  EXPECT_THROW(unit_otf(blades(6, NAN)), InputError);
  EXPECT_THROW(unit_otf(blades(3, 0, 0, 0.51)), InputError) << "an obstruction that reaches the blades";
  GeneralPupil pupil;
  pupil.zernike_waves = {0, 0, 0, 0, NAN};
  EXPECT_THROW(unit_otf(pupil), InputError);
  pupil.zernike_waves = {0, 0, 0, 0, 1000};
  EXPECT_THROW(unit_otf(pupil), InputError);
  pupil.zernike_waves.assign(38, 0.01);
  EXPECT_THROW(unit_otf(pupil), InputError) << "Fringe ends at 37";
  pupil.zernike_waves = {0, 0, 0, 0, 0.1};
  EXPECT_THROW(general_pupil_otf(pupil, 550, 0), InputError);
}

}  // namespace
}  // namespace petzval
