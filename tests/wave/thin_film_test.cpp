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

// Two layers of given indices that leave nothing: tan² of their phases. (Macleod, ch. 4.)
TEST(ThinFilm, VCoatingLeavesNothing) {
  constexpr double n1 = 1.38, n2 = 2.1, glass = 1.52;
  const double tan_sq_1 = (glass - 1) * (n2 * n2 - glass) * n1 * n1 /
                          ((n1 * n1 * glass - n2 * n2) * (glass - n1 * n1)),
               tan_sq_2 = (glass - 1) * (glass - n1 * n1) * n2 * n2 /
                          ((n1 * n1 * glass - n2 * n2) * (n2 * n2 - glass));
  const double first = pi - std::atan(std::sqrt(tan_sq_1)), second = std::atan(std::sqrt(tan_sq_2));
  const std::vector<ThinFilm> films{{n1, first / (2 * pi * n1) * film_nm},
                                    {n2, second / (2 * pi * n2) * film_nm}};
  EXPECT_NEAR(film_power(1, films, glass, 1, film_nm, Polarisation::s).reflectance, 0, 1e-15);
  EXPECT_NEAR(first / (pi / 2), 1.2698013814610714, 1e-12);  // as data/coatings/v-550.json has them
  EXPECT_NEAR(second / (pi / 2), 0.268484855474908, 1e-12);
}

// Quarter, half and quarter wave on glass of 1.52. The numbers are those of the program tmm 0.2.0 by S.
// Byrnes (coh_tmm with indices 1, 1.38, 2.1, 1.63, 1.52 and wavelength 550 nm for the quarters): reflectances
// of s and p, and the phase of what is let through, which has the other sign there.
TEST(ThinFilm, BroadbandCoatingHasTheCurveOfAnotherProgram) {
  const std::vector<ThinFilm> films{
      {1.38, 550 / (4 * 1.38)}, {2.1, 550 / (2 * 2.1)}, {1.63, 550 / (4 * 1.63)}};
  struct {
    double degrees, nm, s, p;
    FilmComplex t_s, t_p;
  } const rows[] = {{0,
                     420,
                     0.019227065695941,
                     0.019227065695941,
                     {-0.32809223339522453, 0.7332126825836839},
                     {-0.32809223339522453, 0.7332126825836839}},
                    {0,
                     480,
                     0.000043808141130,
                     0.000043808141130,
                     {0.4831487051020148, 0.6514854138465964},
                     {0.4831487051020148, 0.6514854138465964}},
                    {0,
                     680,
                     0.000722295829949,
                     0.000722295829949,
                     {0.27508460991313083, -0.7627240651809013},
                     {0.27508460991313083, -0.7627240651809013}},
                    {45,
                     480,
                     0.012756006427619,
                     0.002359130164787,
                     {0.6937877849844959, 0.19361070932086913},
                     {0.6964419580926403, 0.19813901559495753}},
                    {45,
                     550,
                     0.013936834836538,
                     0.000876143635187,
                     {0.6020047569579927, -0.394710411429642},
                     {0.6114991257783292, -0.3887655385560478}},
                    {45,
                     680,
                     0.015585959362180,
                     0.011585002828732,
                     {-0.1063012173109965, -0.7113644794622329},
                     {-0.07497828601093388, -0.7168125639354285}}};
  for (const auto& row : rows) {
    const double cosine = std::cos(radians(row.degrees));
    const auto of = [&](Polarisation which) { return film_power(1, films, 1.52, cosine, row.nm, which); };
    EXPECT_NEAR(of(Polarisation::s).reflectance, row.s, 1e-12);
    EXPECT_NEAR(of(Polarisation::p).reflectance, row.p, 1e-12);
    for (const auto& [which, other] :
         {std::pair{Polarisation::s, row.t_s}, std::pair{Polarisation::p, row.t_p}}) {
      const FilmComplex t = film_amplitude(1, films, 1.52, cosine, row.nm, which);
      EXPECT_NEAR(std::norm(t), of(which).transmittance, 1e-12);
      EXPECT_NEAR(std::abs(t / std::abs(t) - std::conj(other / std::abs(other))), 0, 1e-9);
    }
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
