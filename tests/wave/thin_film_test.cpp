// SPDX-License-Identifier: BSD-3-Clause
// Thin films against closed forms: Fresnel, the quarter wave, Airy's slab; and the laws of energy and
// reversibility.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/wave/thin_film.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace petzval {
namespace {

constexpr double film_nm = 550;
using FilmComplex = std::complex<double>;

/// Amplitude reflected between two media, n cos θ of each given. (Born & Wolf, 1.5.2.)
FilmComplex film_fresnel(FilmComplex n1, FilmComplex c1, FilmComplex n2, FilmComplex c2,
                         Polarisation polarisation) {
  if (polarisation == Polarisation::s) return (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
  return (n1 * c2 - n2 * c1) / (n1 * c2 + n2 * c1);
}

FilmComplex film_cosine(FilmComplex index, double sine_before) {
  const FilmComplex sine = sine_before / index;
  return std::sqrt(1.0 - sine * sine);
}

TEST(ThinFilm, WithoutFilmsIsFresnel) {
  for (const auto polarisation : {Polarisation::s, Polarisation::p})
    for (const double degrees_in : {0.0, 20.0, 56.0, 80.0}) {
      const double cosine = std::cos(radians(degrees_in));
      const FilmComplex r =
          film_fresnel(1, cosine, 1.7, film_cosine(1.7, std::sin(radians(degrees_in))), polarisation);
      const FilmPower power = film_power(1, {}, 1.7, cosine, film_nm, polarisation);
      EXPECT_NEAR(power.reflectance, std::norm(r), 1e-12);
      EXPECT_NEAR(power.transmittance, 1 - std::norm(r), 1e-12);
    }
}

TEST(ThinFilm, QuarterAndHalfWave) {
  const ThinFilm quarter{1.38, film_nm / (4 * 1.38)}, half{2.1, film_nm / (2 * 2.1)};
  const double r = (1.52 - 1.38 * 1.38) / (1.52 + 1.38 * 1.38), bare = 0.52 / 2.52;
  EXPECT_NEAR(film_power(1, {{quarter}}, 1.52, 1, film_nm, Polarisation::s).reflectance, r * r, 1e-12);
  EXPECT_NEAR(film_power(1, {{half}}, 1.52, 1, film_nm, Polarisation::p).reflectance, bare * bare, 1e-12);
}

// The sum of all reflections in a slab, absorbing or not. (Airy 1833.)
TEST(ThinFilm, OneFilmIsAirysSlab) {
  for (const FilmComplex index : {FilmComplex{1.38, 0}, {2.35, 0}, {1.9, -0.3}, {0.2, -3.4}})
    for (const auto polarisation : {Polarisation::s, Polarisation::p})
      for (const double degrees_in : {0.0, 30.0, 70.0}) {
        constexpr double thickness_nm = 137, last = 1.6;
        const double sine = std::sin(radians(degrees_in)), cosine = std::cos(radians(degrees_in));
        const FilmComplex inside = film_cosine(index, sine), behind = film_cosine(last, sine);
        const FilmComplex turn = std::exp(FilmComplex{0, -4 * pi * thickness_nm / film_nm} * index * inside);
        const FilmComplex front = film_fresnel(1, cosine, index, inside, polarisation),
                          back = film_fresnel(index, inside, last, behind, polarisation);
        const FilmComplex r = (front + back * turn) / (1.0 + front * back * turn);
        const ThinFilm film{index, thickness_nm};
        EXPECT_NEAR(film_power(1, {{film}}, last, cosine, film_nm, polarisation).reflectance, std::norm(r),
                    1e-12);
      }
}

TEST(ThinFilm, EnergyIsKeptAndWaysAreReversible) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const bool absorbing = trial % 2 == 1;
    std::vector<ThinFilm> films;
    for (int k = 0; k < 1 + trial % 7; ++k)
      films.push_back(
          {{1.3 + share(random), absorbing ? -0.2 * share(random) : 0.0}, 20 + 300 * share(random)});
    const double cosine = 0.3 + 0.7 * share(random), last = 1.4 + 0.5 * share(random);
    const auto polarisation = trial % 3 == 0 ? Polarisation::p : Polarisation::s;
    const FilmPower there = film_power(1, films, last, cosine, film_nm, polarisation);
    if (absorbing)
      EXPECT_LT(there.reflectance + there.transmittance, 1);
    else
      EXPECT_NEAR(there.reflectance + there.transmittance, 1, 1e-12);
    std::reverse(films.begin(), films.end());
    const double cosine_behind = film_cosine(last, std::sqrt(1 - cosine * cosine)).real();
    const FilmPower back = film_power(last, films, 1, cosine_behind, film_nm, polarisation);
    EXPECT_NEAR(back.transmittance, there.transmittance, 1e-12);
  }
}

TEST(ThinFilm, BeyondTheCriticalAngleAllIsReflected) {
  const ThinFilm film{1.38, 100};
  for (const auto polarisation : {Polarisation::s, Polarisation::p}) {
    const FilmPower power = film_power(1.6, {{film}}, 1, std::cos(radians(50)), film_nm, polarisation);
    EXPECT_NEAR(power.reflectance, 1, 1e-12);
    EXPECT_NEAR(power.transmittance, 0, 1e-12);
  }
}

}  // namespace
}  // namespace petzval
