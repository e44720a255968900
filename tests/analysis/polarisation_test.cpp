// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/polarisation.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/numeric/quadrature.h>

#include <cmath>
#include <complex>

namespace petzval {
namespace {

using Complex = std::complex<double>;

/// A plane-parallel plate behind a stop: all rays of a field meet it under the same angle.
Lens plate(double index) {
  Lens lens;
  lens.name = "plate";
  lens.wavelengths_nm = {550};
  lens.reference_wavelength_nm = 550;
  lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, 2};
  lens.fields = {Fields::Kind::angle_deg, {0, 50}};
  Surface front, back;
  front.stop = true;
  front.thickness_mm = 3;
  front.material = Material(Material::Constant{index});
  back.thickness_mm = 10;
  lens.surfaces = {front, back};
  return lens;
}

FieldTableRequest at(double field, const Losses& losses) {
  FieldTableRequest request;
  request.field_kind = Fields::Kind::angle_deg;
  request.fields = {field};
  request.wavelengths_nm = {550};
  request.losses = losses;
  return request;
}

double share(double from, double to) {
  const double r = (from - to) / (from + to);
  return 1 - r * r;
}

TEST(Polarisation, OfAPlateIsFresnels) {
  const double index = 1.6, field = 50, sine = std::sin(radians(field)) / index;
  const double outside = std::cos(radians(field)), inside = std::sqrt(1 - sine * sine);
  const double s = std::pow(share(outside, index * inside), 2),
               p = std::pow(share(index * outside, inside), 2);
  for (const PolarisationRow& row : polarisation_table(plate(index), at(field, {}))) {
    EXPECT_NEAR(row.transmittance, (s + p) / 2, 1e-12);
    EXPECT_NEAR(row.diattenuation, (p - s) / (p + s), 1e-12);
    EXPECT_NEAR(row.largest_diattenuation, row.diattenuation, 1e-12);
    EXPECT_NEAR(row.largest_retardance_nm, 0, 1e-4);    // the arc cosine of nearly 1
    EXPECT_NEAR(row.strehl, (s + p) / (s + p), 1e-12);  // all rays alike
  }
}

/// A film between air and glass by Airy's sum of all that is reflected in it, each polarisation for itself.
Complex airy(double first, double film, double last, double turn) {
  const auto r = [](double a, double b) { return (a - b) / (a + b); };
  const double t = std::sqrt(share(first, film) * share(film, last));
  return t * std::polar(1.0, -turn) / (1.0 + r(first, film) * r(film, last) * std::polar(1.0, -2 * turn));
}

TEST(Polarisation, OfAFilmIsThatOfAirysSum) {
  const double glass = 1.6, film = 1.38, field = 50, nm = 140;
  Losses losses;
  losses.fresnel = true;
  losses.surfaces[0].layers = {{Material(Material::Constant{film}), nm}};
  const double k = std::sin(radians(field)), outside = std::cos(radians(field));
  const double in_film = std::sqrt(film * film - k * k), in_glass = std::sqrt(glass * glass - k * k);
  const double turn = 2 * pi * in_film * nm / 550;
  // Admittances n cos θ and n/cos θ; the film's front alone, then the bare back.
  const auto admittance = [](double n, double normal) { return n * n / normal; };
  const Complex s = airy(outside, in_film, in_glass, turn) * std::sqrt(share(in_glass, outside));
  const Complex p = airy(1 / outside, admittance(film, in_film), admittance(glass, in_glass), turn) *
                    std::sqrt(share(admittance(glass, in_glass), 1 / outside));
  const double retardance_nm = std::abs(std::arg(s / p)) / (2 * pi) * 550;
  ASSERT_GT(retardance_nm, 0.5);
  const PolarisationRow row = polarisation_table(plate(glass), at(field, losses)).front();
  EXPECT_NEAR(row.transmittance, (std::norm(s) + std::norm(p)) / 2, 1e-12);
  EXPECT_NEAR(row.diattenuation, std::abs(std::norm(p) - std::norm(s)) / (std::norm(p) + std::norm(s)),
              1e-12);
  EXPECT_NEAR(row.rms_retardance_nm, retardance_nm, 1e-9);
}

// Measured reflectances of s and p, for the angle in air on either side.
TEST(Polarisation, OfMeasuredReflectancesIsTheirs) {
  Losses losses;
  losses.air_glass.emplace();
  losses.air_glass->angles_deg = {0, 40, 60};
  losses.air_glass->table = {{500, 0.01}, {600, 0.02}};
  losses.air_glass->by_angle = {{{0.01, 0.01}, {0.03, 0.02}, {0.09, 0.01}},
                                {{0.02, 0.02}, {0.05, 0.01}, {0.12, 0.02}}};
  // Halfway between 40 and 60 degrees and between 500 and 600 nm, at both surfaces.
  const double s = std::pow(1 - (0.03 + 0.09 + 0.05 + 0.12) / 4, 2),
               p = std::pow(1 - (0.02 + 0.01 + 0.01 + 0.02) / 4, 2);
  const PolarisationRow row = polarisation_table(plate(1.6), at(50, losses)).front();
  EXPECT_NEAR(row.transmittance, (s + p) / 2, 1e-12);
  EXPECT_NEAR(row.diattenuation, (p - s) / (p + s), 1e-12);
}

TEST(Polarisation, HasThePowerOfTheTransmittance) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  Losses losses;
  losses.absorption = true;
  losses.air_glass = read_coating("quarter-half-quarter");
  losses.fresnel = true;
  const LensTransmittance transmittance(lens, 480, losses);
  const Tracer tracer(lens, 480);
  const Pencil pencil = Pencil::from_object(lens, 12);
  std::vector<Intersection> path;
  int passed = 0;
  for (const double u : {-5.0, 0.0, 3.0})
    for (const double v : {-14.0, -9.0, -4.0, 0.0}) {
      path.clear();
      const Ray launched = *pencil.ray(u, v);
      if (tracer.trace(launched, Tracer::Clip::none, &path).status != RayStatus::ok) continue;
      const Jones jones = transmittance.jones(launched, path);
      double sum = 0;
      for (const auto& row : jones)
        for (const Complex& element : row) sum += std::norm(element);
      // Directions of real rays are unit vectors to some 1e-12 at each of a dozen surfaces.
      EXPECT_NEAR(sum / 2, transmittance.along(launched, path), 1e-10);
      ++passed;
    }
  EXPECT_GE(passed, 6);
}

// On the axis J = R(φ) diag(p, s) R(−φ): over all azimuths half the sum of p and s is left, whatever their
// phases. p and s by rays of one meridian, over the square of the radius.
TEST(Polarisation, OnTheAxisIsAMeanOverTheRadius) {
  const Lens lens = read_lens("dgauss-50mm").lens;
  Losses losses;
  losses.air_glass = read_coating("quarter-half-quarter");
  losses.fresnel = true;
  FieldTableRequest request = at(0, losses);
  const PolarisationRow row = polarisation_table(lens, request).front();
  FieldTracer field(lens, 550);
  const ChiefRay chief = *field.chief_ray(0);
  const double radius = field.object_pupil(chief)->radius.front();
  const LensTransmittance transmittance(lens, 550, losses);
  const Pencil pencil = Pencil::from_object(lens, 0);
  const QuadratureRule rule = gauss_legendre(24);
  Complex mean = 0;
  double power = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    std::vector<Intersection> path;
    const Ray launched = *pencil.ray(0, radius * std::sqrt(rule.nodes[i]));
    field.tracer().trace(launched, Tracer::Clip::none, &path);
    const Jones jones = transmittance.jones(launched, path);
    EXPECT_NEAR(std::abs(jones[0][1]), 0, 1e-12);  // y is p, x is s
    // Without the phase that both share: half of each is left.
    const Complex turn = std::polar(1.0, -0.5 * (std::arg(jones[0][0]) + std::arg(jones[1][1])));
    mean += rule.weights[i] * 0.5 * turn * (jones[0][0] + jones[1][1]);
    power += rule.weights[i] * 0.5 * (std::norm(jones[0][0]) + std::norm(jones[1][1]));
  }
  EXPECT_LT(row.strehl, 1);
  EXPECT_NEAR(row.strehl, std::norm(mean) / power, 1e-6);
  EXPECT_NEAR(row.transmittance, power, 1e-6);
}

}  // namespace
}  // namespace petzval
