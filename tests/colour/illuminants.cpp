// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/spectra_files.h>

#include <cmath>

namespace petzval {
namespace {

TEST(Illuminants, AIsThePlanckianCurveThatDefinesIt) {
  // CIE 15: S(λ) = 100 (560/λ)⁵ (exp(1.435e7/(2848·560)) − 1)/(exp(1.435e7/(2848 λ)) − 1).
  const auto defined = [](double nm) {
    return 100 * std::pow(560 / nm, 5) * std::expm1(1.435e7 / (2848 * 560)) /
           std::expm1(1.435e7 / (2848 * nm));
  };
  const Spectrum a = illuminant("A");
  for (std::size_t i = 0; i < a.values().size(); ++i)
    EXPECT_NEAR(a.values()[i], defined(a.wavelengths_nm()[i]), 0.0051)
        << a.wavelengths_nm()[i];  // two decimals
}

TEST(Illuminants, D65IsThatOfTheStandard) {
  // CIE standard illuminant D65 (ISO 11664-2), six digits.
  const std::pair<double, double> published[] = {
      {320, 20.2360}, {350, 44.9117}, {370, 52.0891}, {380, 49.9755}, {400, 82.7549},
      {450, 117.008}, {500, 109.354}, {550, 104.046}, {600, 90.0062}, {650, 80.0268},
      {700, 71.6091}, {780, 63.3828}, {800, 59.4519}, {830, 60.3125}};
  const Spectrum d65 = illuminant("D65");
  for (const auto& [nm, power] : published) EXPECT_NEAR(d65.at(nm), power, 6e-6 * power) << nm;
}

TEST(Illuminants, TheTablesOfDaylightAreThoseOf6500And5000K) {
  // Two bundled tables, computed elsewhere without rounding the shares M1 and M2 to three decimals. The
  // components reach 63 and 27 here: half a unit of the third decimal of each makes up to 0.05.
  for (const auto& [table, kelvins] : {std::pair{"illuminant_d65", 6500.0}, {"illuminant_d50", 5000.0}}) {
    const Spectrum given = read_spectrum_set(table).spectra[0].spectrum, computed = daylight(kelvins);
    for (double nm = 300; nm <= 830; nm += 5)
      EXPECT_NEAR(computed.at(nm), given.at(nm), 0.05) << table << ' ' << nm;
  }
}

TEST(Illuminants, DaylightIsKnownFrom4000To25000K) {
  EXPECT_NEAR(daylight(4000).at(560), 100, 1e-9);
  EXPECT_GT(daylight(25000).at(400), daylight(25000).at(700));
  EXPECT_THROW(daylight(3999), InputError);
  EXPECT_THROW(daylight(25001), InputError);
  EXPECT_THROW(daylight(std::nan("")), InputError);
  EXPECT_EQ(illuminant("D5500").values(), illuminant("D55").values());
}

TEST(Blackbody, ObeysTheLawsOfStefanBoltzmannAndWien) {
  const double kelvins = 3200;
  double sum = 0, peak = 0, peak_nm = 0;
  for (double nm = 50; nm < 200000; nm += 1) {
    const double radiance = blackbody_radiance(nm, kelvins);
    sum += radiance;
    if (radiance > peak) peak = radiance, peak_nm = nm;
  }
  // σ T⁴/π; beyond 200 µm lies less than 1e-6 of it, the 1 nm sum of so smooth a curve is exact to that.
  EXPECT_NEAR(sum, 5.670374419e-8 * std::pow(kelvins, 4) / pi, 3e-6 * sum);
  EXPECT_NEAR(peak_nm, 2897.771955e3 / kelvins, 1);  // searched in steps of 1 nm
}

TEST(Illuminants, AreFoundByName) {
  for (const std::string& name : illuminant_names()) EXPECT_FALSE(illuminant(name).empty()) << name;
  EXPECT_EQ(illuminant("E").at(400), illuminant("E").at(700));
  EXPECT_NEAR(illuminant("3200K").at(560), 100, 1e-9);
  EXPECT_NEAR(illuminant("3200K").at(450) / illuminant("3200K").at(650),
              blackbody_radiance(450, 3200) / blackbody_radiance(650, 3200), 1e-12);
}

TEST(Illuminants, UnknownOnesAreRefused) {
  for (const char* name :
       {"", "D", "D-65", "D1e3", "d65", "K", "-5K", "0K", "infK", "D99999", "no/such/file", "B"})
    EXPECT_THROW(illuminant(name), InputError) << name;
}

}  // namespace
}  // namespace petzval
