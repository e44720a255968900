// SPDX-License-Identifier: BSD-3-Clause
// Losses against Fresnel's and Lambert's laws worked by hand.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/glass/catalogue.h>
#include <petzval/lens/lens_file.h>
#include <petzval/trace/losses.h>

#include <cmath>

#include "trace/sample_lenses.h"

namespace petzval {
namespace {

constexpr double lambda_nm = 587.5618;

/// A plane-parallel plate, the stop in front.
Lens plate(Material material, double thickness_mm) {
  Lens lens;
  lens.name = "plate";
  lens.surfaces = {sample::surface(0, thickness_mm, 1), sample::surface(0, 10, 1)};
  lens.surfaces[0].material = std::move(material);
  lens.surfaces[0].stop = true;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 100};
  return lens;
}

Ray tilted(double angle, double roll = 0) {
  return {{0, 0, -1}, {std::sin(angle) * std::sin(roll), std::sin(angle) * std::cos(roll), std::cos(angle)}};
}

double transmittance(const Lens& lens, const Losses& losses, const Ray& ray) {
  const Tracer tracer(lens, lambda_nm);
  std::vector<Intersection> path;
  EXPECT_EQ(tracer.trace(ray, Tracer::Clip::none, &path).status, RayStatus::ok);
  return LensTransmittance(lens, lambda_nm, losses).along(ray, path);
}

Losses fresnel_only() {
  Losses losses;
  losses.fresnel = true;
  return losses;
}

TEST(Losses, NormalIncidenceReflectsTheSquareOfTheIndexStep) {
  const double n = 1.5, reflectance = 0.04;  // (0.5/2.5)²
  EXPECT_NEAR(transmittance(plate(Material(Material::Constant{n}), 5), fresnel_only(), tilted(0)),
              (1 - reflectance) * (1 - reflectance), 1e-15);
}

TEST(Losses, ATiltedPlatePolarises) {
  // Fresnel in the forms of sines and tangents (Born & Wolf 1.5.2, eq. 21), which the code does not use:
  // Rs = sin²(a−b)/sin²(a+b), Rp = tan²(a−b)/tan²(a+b). Two surfaces: (Ts² + Tp²)/2, not ((Ts + Tp)/2)².
  const double n = 1.6;
  for (const double degrees : {20.0, 45.0, 70.0})
    for (const double roll : {0.0, 0.7, 2.0}) {
      const double a = degrees * M_PI / 180, b = std::asin(std::sin(a) / n);
      const double ts = 1 - std::pow(std::sin(a - b) / std::sin(a + b), 2);
      const double tp = 1 - std::pow(std::tan(a - b) / std::tan(a + b), 2);
      EXPECT_NEAR(transmittance(plate(Material(Material::Constant{n}), 5), fresnel_only(), tilted(a, roll)),
                  0.5 * (ts * ts + tp * tp), 1e-14)
          << degrees;
    }
}

TEST(Losses, BrewstersAngleReflectsOneOfTwoPolarisations) {
  const double n = 1.6, brewster = std::atan(n);
  const double ts = 1 - std::pow((n * n - 1) / (n * n + 1), 2);  // of one surface, exactly
  EXPECT_NEAR(transmittance(plate(Material(Material::Constant{n}), 5), fresnel_only(), tilted(brewster)),
              0.5 * (ts * ts + 1), 1e-14);
}

TEST(Losses, AbsorptionIsLamberts) {
  Glass glass;
  glass.catalogue = "TEST";
  glass.name = "GREY";
  glass.formula = 5;
  glass.coefficients = {1.5};
  glass.shortest_nm = 300;
  glass.longest_nm = 2000;
  glass.k_table = {{300, 1e-6}, {2000, 1e-6}};
  Losses losses;
  losses.absorption = true;
  const Lens lens = plate(Material(std::make_shared<const Glass>(glass)), 8);
  const double per_mm = 4 * M_PI * 1e-6 / (lambda_nm * 1e-6);
  EXPECT_NEAR(transmittance(lens, losses, tilted(0)), std::exp(-8 * per_mm), 1e-14);
  const double inside = std::asin(std::sin(0.5) / 1.5);
  EXPECT_NEAR(transmittance(lens, losses, tilted(0.5)), std::exp(-8 * per_mm / std::cos(inside)), 1e-14);
}

TEST(Losses, GlassOfTheCatalogueAbsorbsByItsTable) {
  // SCHOTT:SF6 in the refractiveindex.info database: k = 2.8412e-7 at 400 nm, so exp(−4π k 10 mm/400 nm).
  const Lens lens = plate(Material(GlassCatalogue::bundled().find("SCHOTT:SF6")), 10);
  Losses losses;
  losses.absorption = true;
  const Tracer tracer(lens, 400);
  std::vector<Intersection> path;
  tracer.trace(tilted(0), Tracer::Clip::none, &path);
  EXPECT_NEAR(LensTransmittance(lens, 400, losses).along(tilted(0), path), std::exp(-0.0892589), 1e-6);
}

TEST(Losses, CoatingsBySurfaceTakeTheirShare) {
  Losses losses;
  losses.fresnel = true;
  losses.air_glass = Coating{{{400, 0.03}, {600, 0.01}}};  // 0.011244 at 587.5618 nm
  losses.surfaces[1] = Coating::constant(0.25);
  const double first = 0.03 - 0.02 * (lambda_nm - 400) / 200;
  EXPECT_NEAR(transmittance(plate(Material(Material::Constant{1.6}), 5), losses, tilted(0.3)),
              (1 - first) * 0.75, 1e-14);
  EXPECT_EQ(losses.air_glass->at(300), 0.03);
  EXPECT_EQ(losses.air_glass->at(900), 0.01);
}

TEST(Losses, AirGlassCoatingLeavesCementedSurfacesBare) {
  Lens lens;
  lens.surfaces = {sample::surface(0, 2, 1.5), sample::surface(0, 2, 1.7), sample::surface(0, 10, 1)};
  lens.surfaces[0].stop = true;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 10};
  Losses losses = fresnel_only();
  losses.air_glass = Coating::constant(0);
  EXPECT_NEAR(transmittance(lens, losses, tilted(0)), 1 - std::pow(0.2 / 3.2, 2), 1e-15);
}

TEST(Losses, OwnCoatingsStandBeforeThoseOfAllAndBehindThoseGiven) {
  Lens lens = plate(Material(Material::Constant{1.6}), 5);
  lens.surfaces[0].coating = Coating::constant(0.2);
  EXPECT_NEAR(transmittance(lens, {}, tilted(0.3)), 0.8, 1e-14) << "without being asked for";
  Losses losses;
  losses.air_glass = Coating::constant(0.05);
  EXPECT_NEAR(transmittance(lens, losses, tilted(0.3)), 0.8 * 0.95, 1e-14);
  losses.surfaces[0] = Coating::constant(0.5);
  EXPECT_NEAR(transmittance(lens, losses, tilted(0.3)), 0.5 * 0.95, 1e-14);
}

/// Reciprocity: a skew ray through a real lens and the same ray back lose the same. \returns what passes.
double passing_both_ways(const Losses& losses, const Pose& sensor = {}) {
  Lens lens = read_lens("dgauss-50mm").lens;
  lens.sensor_pose = sensor;
  const Tracer tracer(lens, lambda_nm);
  const LensTransmittance transmittance(lens, lambda_nm, losses);
  const Ray there{{6, -4, -5}, {0.1, 0.15, std::sqrt(1 - 0.0325)}};
  std::vector<Intersection> path, path_back;
  const Ray end = tracer.trace(there, Tracer::Clip::none, &path);
  EXPECT_EQ(end.status, RayStatus::ok);
  Ray back = end;
  for (double& cosine : back.direction) cosine = -cosine;
  EXPECT_EQ(tracer.trace_backward(back, Tracer::Clip::none, &path_back).status, RayStatus::ok);
  const double forward = transmittance.along(there, path);
  EXPECT_NEAR(transmittance.along(tracer.from_image(back), path_back, true), forward, 1e-13);
  return forward;
}

TEST(Losses, TheSameForwardsAndBackwards) {
  Losses losses;
  losses.fresnel = losses.absorption = true;
  const double forward = passing_both_ways(losses);
  EXPECT_LT(forward, 0.7) << "ten air-glass surfaces";
  EXPECT_GT(forward, 0.4);
  // A sensor that is tilted sees the same light, from another side.
  EXPECT_NEAR(passing_both_ways(losses, {0, 0, 0, 8, -5, 30}), forward, 1e-13);
}

/// Scatter sends light out of the plane of incidence. Its fields stay across it: a surface between air and
/// air has nothing to take, however it stands.
TEST(Losses, FieldsStayAcrossLightThatScattered) {
  const Lens lens = plate(Material(Material::Constant{1.8}), 3);
  Lens longer = lens;
  longer.surfaces.push_back(sample::surface(0, 5, 1));
  const Ray ray = tilted(0.9);
  const Tracer tracer(lens, lambda_nm);
  for (const double out_of_plane : {0.1, 0.5, 0.9}) {
    std::vector<Intersection> path;
    ASSERT_EQ(tracer.trace(ray, Tracer::Clip::none, &path).status, RayStatus::ok);
    path[1].direction_after = {out_of_plane, 0.3, std::sqrt(1 - 0.09 - out_of_plane * out_of_plane)};
    const double alone = LensTransmittance(lens, lambda_nm, fresnel_only()).along(ray, path);
    std::vector<Intersection> more(path.begin(), path.begin() + 2);
    more.push_back({{1, 1, 13}, path[1].direction_after, {0, 0, 1}});
    EXPECT_NEAR(LensTransmittance(longer, lambda_nm, fresnel_only()).along(ray, more) / alone, 1, 1e-12);
    more.back().normal = {0.6, 0, 0.8};
    EXPECT_NEAR(LensTransmittance(longer, lambda_nm, fresnel_only()).along(ray, more) / alone, 1, 1e-12);
  }
}

TEST(Losses, FilmsOfAPlateAreThoseOfBothPolarisations) {
  constexpr double index = 1.6;
  Losses losses;
  losses.air_glass = read_coating("mgf2");
  for (const double angle : {0.0, 0.4, 0.9}) {
    double expected = 0;
    for (const auto polarisation : {Polarisation::s, Polarisation::p}) {
      const ThinFilm film{1.38, 550 / (4 * 1.38)};
      const double share =
          film_power(1, {{film}}, index, std::cos(angle), lambda_nm, polarisation).transmittance;
      expected += 0.5 * share * share;
    }
    EXPECT_NEAR(transmittance(plate(Material(Material::Constant{index}), 5), losses, tilted(angle)), expected,
                1e-13);
  }
}

TEST(Losses, FilmsAreTheSameForwardsAndBackwards) {
  Losses losses;
  losses.fresnel = true;
  losses.air_glass = read_coating("quarter-half-quarter");
  losses.air_glass->layers[1].material = Material(Material::Constant{2.2});  // whose order counts
  passing_both_ways(losses);
}

// A quarter wave of 1.38 leaves 0.30 of bare glass's reflection at its wavelength, by its closed form, and
// more towards the ends of the visible; of three layers one asks that they do better than that everywhere.
TEST(Losses, BundledFilmsReflectLittle) {
  const Coating single = read_coating("mgf2"), triple = read_coating("quarter-half-quarter");
  const double bare = std::pow(0.52 / 2.52, 2);
  for (double nm = 450; nm <= 650; nm += 10) {
    EXPECT_LT(single.reflectance(nm, 1, 1.52), 0.6 * bare) << nm;
    EXPECT_LT(triple.reflectance(nm, 1, 1.52), 0.2 * bare) << nm;
    EXPECT_NEAR(triple.reflectance(nm, 1, 1.52), triple.reflectance(nm, 1.52, 1), 1e-14) << nm;
  }
}

// The design of Furman and Tikhonravov 1992, fig. 2.5: optical thicknesses are published beside the geometric
// ones, each rounded to 0.1 nm, and the figure's reflectance ends at 0.4 %. Between three zeros that are not
// quite reached stand two humps. Numbers of s and p by the program tmm 0.2.0 by S. Byrnes (coh_tmm).
TEST(Losses, APublishedBroadbandCoatingHasItsCurve) {
  const Coating coating = read_coating("broadband-8");
  const std::vector<double> optical_nm{131.5, 38.9, 13.4, 239.4, 9.3, 18.6, 36.4, 32.4};
  const std::vector<ThinFilm> films = coating.films(550, 1);
  ASSERT_EQ(films.size(), optical_nm.size());
  for (std::size_t i = 0; i < films.size(); ++i) {
    const double index = films[i].index.real();
    EXPECT_NEAR(index * films[i].thickness_nm, optical_nm[i], 0.05 * index + 0.05) << i;
  }
  int minima = 0, maxima = 0;
  const auto reflectance = [&](double nm) { return coating.reflectance(nm, 1, 1.52); };
  for (double nm = 420; nm <= 760; nm += 5) {
    const double here = reflectance(nm), before = reflectance(nm - 5), after = reflectance(nm + 5);
    EXPECT_LT(here, 0.004) << nm;
    minima += here < before && here < after;
    maxima += here > before && here > after;
  }
  EXPECT_EQ(minima, 3);
  EXPECT_EQ(maxima, 2);
  struct {
    double degrees, nm, s, p;
  } const rows[] = {
      {0, 400, 0.017933214182341, 0.017933214182341},  {0, 480, 0.001846976669569, 0.001846976669569},
      {0, 700, 0.000618526881088, 0.000618526881088},  {0, 800, 0.010329530709692, 0.010329530709692},
      {30, 440, 0.002029970397474, 0.000205461144479}, {30, 620, 0.006164201931476, 0.001848034427903},
      {45, 480, 0.008452165164024, 0.005053247354603}, {45, 760, 0.026544408778337, 0.016493074538990}};
  for (const auto& row : rows) {
    const double cosine = std::cos(row.degrees * M_PI / 180);
    const auto of = [&](Polarisation which) { return film_power(1, films, 1.52, cosine, row.nm, which); };
    EXPECT_NEAR(of(Polarisation::s).reflectance, row.s, 1e-12);
    EXPECT_NEAR(of(Polarisation::p).reflectance, row.p, 1e-12);
  }
}

TEST(Losses, RefusesFilmsBetweenGlasses) {
  Lens lens;
  lens.surfaces = {sample::surface(0, 2, 1.5), sample::surface(0, 2, 1.7), sample::surface(0, 10, 1)};
  lens.surfaces[0].stop = true;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 10};
  Losses losses;
  losses.surfaces[1] = read_coating("mgf2");
  EXPECT_THROW(losses.validate(lens), InputError);
  losses.surfaces.clear();
  losses.surfaces[2] = read_coating("mgf2");
  EXPECT_NO_THROW(losses.validate(lens));
  losses.surfaces[2].table = {{500, 0.1}};
  EXPECT_THROW(losses.validate(lens), InputError);
}

TEST(Losses, RefusesNonsense) {
  const Lens lens = plate(Material(Material::Constant{1.5}), 5);
  Losses losses;
  losses.surfaces[2] = Coating::constant(0.1);
  EXPECT_THROW(LensTransmittance(lens, lambda_nm, losses), InputError);
  losses.surfaces.clear();
  losses.air_glass = Coating::constant(1.1);
  EXPECT_THROW(LensTransmittance(lens, lambda_nm, losses), InputError);
  losses.air_glass = Coating{{{500, 0.1}, {400, 0.1}}};
  EXPECT_THROW(LensTransmittance(lens, lambda_nm, losses), InputError);
  losses.air_glass = Coating{};
  EXPECT_THROW(LensTransmittance(lens, lambda_nm, losses), InputError);
}

TEST(Losses, SayWhatIsNotKnown) {
  Losses losses;
  losses.absorption = true;
  const Lens lens = plate(Material(Material::Constant{1.5}), 5);
  EXPECT_EQ(LensTransmittance(lens, lambda_nm, losses).clear_for_want_of_data().size(), 1u);
}

}  // namespace
}  // namespace petzval
