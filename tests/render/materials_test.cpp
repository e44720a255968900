// SPDX-License-Identifier: BSD-3-Clause
// Materials by the laws that all of them must keep: sampling follows its density, no more light leaves than
// came, both directions may be exchanged, and a body in even light from everywhere is as bright as its albedo
// says.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/render/materials/coating_albedo.h>
#include <petzval/render/materials/fresnel.h>

#include <complex>

#include "scene_text.h"
#include "sphere_cells.h"

namespace petzval::render {
namespace {

struct NamedBsdf {
  std::string name;
  Bsdf bsdf;
  bool lossless;  ///< nothing absorbed, no light lost between facets
};

const CoatingAlbedo& coating() {
  static const CoatingAlbedo albedo(1.5);
  return albedo;
}

std::vector<NamedBsdf> rough_and_diffuse() {
  const Lanes eta = Lanes::all(1.5), white = Lanes::all(1);
  return {{"diffuse", Bsdf::diffuse(white), true},
          {"diffuse transmission", Bsdf::diffuse(Lanes::all(0.6), Lanes::all(0.4)), true},
          {"coated, smooth", Bsdf::coated_diffuse(white, 1.5, {0, 0}, coating()), true},
          {"coated, rough", Bsdf::coated_diffuse(white, 1.5, {0.3, 0.3}, coating()), true},
          {"conductor, rough", Bsdf::conductor(Lanes::all(0.2), Lanes::all(3), {0.3, 0.5}), false},
          {"dielectric, rough", Bsdf::dielectric(eta, 0, {0.3, 0.3}), false}};
}

Vector3 direction(double cos, double phi) {
  const double sin = std::sqrt(1 - cos * cos);
  return {sin * std::cos(phi), sin * std::sin(phi), cos};
}

/// χ² of the samples over cells of the sphere against the integral of the density; mirror samples left out.
TEST(Bsdf, SamplesFollowTheirDensity) {
  constexpr int samples = 200000;
  for (const NamedBsdf& each : rough_and_diffuse())
    for (const double cos : {0.9, 0.4, -0.7}) {
      const Bsdf& bsdf = each.bsdf;
      const Vector3 wo = direction(cos, 0.3);
      SphereCells cells;
      for (int i = 0; i < samples; ++i) {
        SobolSample sample(hashed(99, static_cast<std::uint32_t>(i)), 0);  // independent, for χ²
        const auto [choice, u, v, none] = sample.next4();
        (void)none;
        const auto chosen = bsdf.sample(wo, choice, u, v);
        if (chosen && !chosen->mirror) cells.count(chosen->wi);
      }
      // The midpoint rule over a cell is good to half a percent where the density is steep.
      cells.expect_density(samples, 24, 0.005, each.name + " at cos " + std::to_string(cos),
                           [&](Vector3 wi) { return bsdf.pdf(wo, wi); });
    }
}

/// The mean weight of samples is the albedo; it must agree with the integral of f cos and must not exceed 1.
TEST(Bsdf, GivesBackWhatItsValueSays) {
  constexpr int rings = 400, sectors = 200, samples = 1 << 15;
  for (const auto& [name, bsdf, lossless] : rough_and_diffuse()) {
    for (const double cos : {0.95, 0.5, -0.6}) {
      const Vector3 wo = direction(cos, 1.1);
      double sampled = 0, mirrored = 0, integral = 0;
      for (std::uint32_t i = 0; i < samples; ++i) {
        SobolSample sample(5, i);
        const auto [choice, u, v, none] = sample.next4();
        (void)none;
        const auto chosen = bsdf.sample(wo, choice, u, v);
        if (!chosen) continue;
        const double radiance = chosen->transmitted ? chosen->index_ratio * chosen->index_ratio : 1;
        (chosen->mirror ? mirrored : sampled) += static_cast<double>(chosen->weight[0]) * radiance / samples;
      }
      for (int ring = 0; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector) {
          const double z = -1 + 2 * (ring + 0.5) / rings;
          const Vector3 wi = direction(z, 2 * pi * (sector + 0.5) / sectors);
          const bool through = wi.z * wo.z < 0 && name == "dielectric, rough";
          const double ratio = wo.z > 0 ? 1.5 : 1 / 1.5;
          integral += static_cast<double>(bsdf.value(wo, wi)[0]) * std::abs(z) * 4 * pi / (rings * sectors) *
                      (through ? ratio * ratio : 1);
        }
      // 2^15 Sobol points and the midpoint rule over 80000 cells: a few parts in a thousand each.
      EXPECT_NEAR(sampled, integral, 4e-3) << name << " at cos " << cos;
      EXPECT_LT(sampled + mirrored, 1 + 2e-3) << name << " at cos " << cos;
      if (lossless) {
        EXPECT_NEAR(sampled + mirrored, 1, 3e-3) << name << " at cos " << cos;
      }
    }
  }
}

TEST(Bsdf, MayExchangeItsDirections) {
  for (const auto& [name, bsdf, lossless] : rough_and_diffuse())
    for (int i = 0; i < 200; ++i) {
      SobolSample sample(3, static_cast<std::uint32_t>(i));
      const auto [a, b, c, d] = sample.next4();
      const Vector3 wo = direction(2 * a - 1, 2 * pi * b), wi = direction(2 * c - 1, 2 * pi * d);
      const double there = static_cast<double>(bsdf.value(wo, wi)[0]),
                   back = static_cast<double>(bsdf.value(wi, wo)[0]);
      // Through a boundary f/n² is what may be exchanged (Veach 1997, 5.3).
      const double factor =
          name == "dielectric, rough" && wo.z * wi.z < 0 ? (wo.z > 0 ? 1.5 * 1.5 : 1 / (1.5 * 1.5)) : 1;
      EXPECT_NEAR(there * factor, back, 1e-4 * (there * factor + back)) << name;
    }
}

/// Numbers of Fresnel's equations that can be worked out by hand.
TEST(Fresnel, KnownValues) {
  EXPECT_NEAR(dielectric_reflectance(1, 1.5), 0.04, 1e-15);
  EXPECT_NEAR(dielectric_reflectance(std::cos(std::atan(1.5)), 1.5),
              0.5 * std::pow((1 - 2.25) / (1 + 2.25), 2), 1e-15);
  EXPECT_EQ(dielectric_reflectance(0.5, 1 / 1.5), 1);  // beyond the critical angle
  EXPECT_NEAR(conductor_reflectance(1.0, 0.5, 3.0), (0.25 + 9) / (2.25 + 9), 1e-15);
  EXPECT_NEAR(conductor_reflectance(0.3, 1.5, 0.0), dielectric_reflectance(0.3, 1.5), 1e-15);
  // Fresnel's equations as they stand, with a complex index.
  for (const double cos : {1e-3, 0.1, 0.5, 0.9, 1.0})
    for (const std::complex<double> n :
         {std::complex<double>{0.2, 3.4}, {1.3, 7}, {2, 0.1}, {0.05, 0}, {4, 4}}) {
      const std::complex<double> far = std::sqrt(1.0 - (1 - cos * cos) / (n * n));
      const double s = std::norm((cos - n * far) / (cos + n * far)),
                   p = std::norm((n * cos - far) / (n * cos + far));
      EXPECT_NEAR(conductor_reflectance(cos, n.real(), n.imag()), (s + p) / 2, 1e-14) << cos << " " << n;
    }
  // 0.0918 from outside and 0.5963 from inside at 1.5: Egan & Hilgeman, Appl. Opt. 12 (1973) 1816.
  EXPECT_NEAR(mean_dielectric_reflectance(1.5), 0.0918, 1e-4);
  EXPECT_NEAR(mean_dielectric_reflectance(1 / 1.5), 0.5963, 1e-4);
  EXPECT_NEAR((1 - mean_dielectric_reflectance(1.5)) / 2.25, 1 - mean_dielectric_reflectance(1 / 1.5), 1e-6);
}

/// A sphere in light of radiance 1 from everywhere, seen along a ray through its middle and along one near
/// its edge: what is not absorbed comes back as 1, and the sphere cannot be seen.
class Furnace : public testing::TestWithParam<const char*> {};

double furnace_radiance(const std::string& material, double height, PathOptions::Lights lights,
                        int samples = 4096) {
  const auto world =
      world_of(std::string(white_furnace) + material + "\nShape \"sphere\" \"float radius\" 1");
  PathOptions options;
  options.max_depth = 64;
  options.lights = lights;
  const PathTracer tracer(*world, options);
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    SobolSample sample(17, static_cast<std::uint32_t>(i));
    const PathLight light = tracer.trace({0, height, -3}, {0, 0, 1}, 0, 1, sample);
    sum += static_cast<double>(light.shared[1] + light.alone);  // the hero's own light
  }
  return sum / samples;
}

TEST_P(Furnace, LosesNothing) {
  // Sobol points; paths of up to 64 reflections inside glass, and as many lights asked: 3e-3 covers the
  // scatter seen over seeds.
  EXPECT_NEAR(furnace_radiance(GetParam(), 0.1, PathOptions::Lights::both, 16384), 1, 3e-3);
  EXPECT_NEAR(furnace_radiance(GetParam(), 0.8, PathOptions::Lights::both, 16384), 1, 3e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Materials, Furnace,
    testing::Values("Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]",
                    "Material \"diffusetransmission\" \"rgb reflectance\" [ .5 .5 .5 ] \"rgb transmittance\" "
                    "[ .5 .5 .5 ]",
                    "Material \"coateddiffuse\" \"rgb reflectance\" [ 1 1 1 ]",
                    "Material \"coateddiffuse\" \"rgb reflectance\" [ 1 1 1 ] \"float roughness\" 0.1",
                    "Material \"dielectric\" \"float eta\" 1.5",
                    "Material \"dielectric\" \"spectrum eta\" \"glass-SF11\"",
                    "Material \"thindielectric\" \"float eta\" 1.5", "Material \"interface\"",
                    "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]\n"
                    "MakeNamedMaterial \"b\" \"string type\" \"dielectric\"\n"
                    "Material \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.3"));

/// Materials that absorb or lose light between facets: their own albedo, found by another way of sampling.
TEST(FurnaceOfRoughMetal, TwoWaysOfFindingTheSkyAgree) {
  for (const char* material :
       {"Material \"conductor\" \"float roughness\" 0.2", "Material \"dielectric\" \"float roughness\" 0.1",
        "Material \"conductor\" \"spectrum eta\" \"metal-Al-eta\" \"spectrum k\" \"metal-Al-k\""}) {
    const double by_chance = furnace_radiance(material, 0.5, PathOptions::Lights::by_chance);
    const double both = furnace_radiance(material, 0.5, PathOptions::Lights::both);
    EXPECT_LT(both, 1);
    EXPECT_GT(both, 0.4);
    EXPECT_NEAR(both, by_chance, 0.01) << material;  // 4096 samples of the worse way
  }
}

/// A smooth metal shows the sky times Fresnel's reflectance, in the colour of copper.
TEST(FurnaceOfRoughMetal, MirrorIsFresnel) {
  const double radiance = furnace_radiance("Material \"conductor\"", 0.5, PathOptions::Lights::both, 4);
  // Copper at 550 nm, Johnson & Christy: between 2.26 eV (1.02, 2.577) and 2.13 eV (0.70, 2.704).
  const double share = (550 - 1239.84198 / 2.26) / (1239.84198 / 2.13 - 1239.84198 / 2.26);
  const double n = 1.02 + share * (0.70 - 1.02), k = 2.577 + share * (2.704 - 2.577);
  EXPECT_NEAR(radiance, conductor_reflectance(std::sqrt(0.75), n, k), 2e-4);
}

}  // namespace
}  // namespace petzval::render
