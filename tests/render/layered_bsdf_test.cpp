// SPDX-License-Identifier: BSD-3-Clause
// A clear coat over a base: against the closed form of Lambert's base, quadrature, and a slab of glass that
// lies in the scene as two surfaces.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/render/materials/coating_albedo.h>
#include <petzval/render/materials/fresnel.h>
#include <petzval/render/media/phase_function.h>

#include "media_scenes.h"

namespace petzval::render {
namespace {

Vector3 towards(double cos, double phi) {
  const double sin = std::sqrt(1 - cos * cos);
  return {sin * std::cos(phi), sin * std::sin(phi), cos};
}

/// As in a material, whose layering outlives it.
const Layering& layering(Layering each) {
  static std::vector<std::unique_ptr<Layering>> kept;
  return *kept.emplace_back(std::make_unique<Layering>(each));
}

Bsdf coated_metal(double coat, double base, double thickness = 0, int walks = 1) {
  return Bsdf::layered(
      Lanes::all(0.2), Lanes::all(3), {coat, coat}, {base, base},
      layering({.eta = 1.5, .thickness = thickness, .max_depth = 0, .walks = walks, .metal = true}));
}

/// Of light that crosses a smooth coat of this optical depth from outside, along one direction.
struct Passed {
  explicit Passed(double cos, double thickness) {
    const double inside = std::sqrt(1 - (1 - cos * cos) / 2.25);
    share = (1 - dielectric_reflectance(cos, 1.5)) * std::exp(-thickness / inside);
  }
  double share;
};

/// 2 ∫ F(c) exp(−2 t/c) c dc from inside: what the coat sends back to Lambert's base of what it sends up.
double returned(double thickness) {
  double sum = 0;
  const double kink = std::sqrt(1 - 1 / 2.25);  // total reflection below it
  for (const auto& [from, to] : {std::pair{0.0, kink}, std::pair{kink, 1.0}}) {
    const QuadratureRule rule = gauss_legendre(200, 0, 1);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double t = rule.nodes[i], cos = from + (to - from) * t * t;
      sum += rule.weights[i] * 2 * t * (to - from) * 2 * cos * dielectric_reflectance(cos, 1 / 1.5) *
             (thickness > 0 ? std::exp(-2 * thickness / cos) : 1);
    }
  }
  return sum;
}

TEST(LayeredBsdf, IsTheClosedFormOverLambert) {
  EXPECT_NEAR(returned(0), mean_dielectric_reflectance(1 / 1.5), 1e-5);
  const CoatingAlbedo coating(1.5);
  for (const double thickness : {0.0, 0.3}) {
    const Bsdf walked = Bsdf::layered(
        Lanes::all(0.8), Lanes::all(0), {0, 0}, {0, 0},
        layering({.eta = 1.5, .thickness = thickness, .max_depth = 0, .walks = 20000, .metal = false}));
    for (const auto& [cos_o, cos_i] : {std::pair{0.9, 0.7}, {0.3, 0.95}, {0.15, 0.2}}) {
      const Vector3 wo = towards(cos_o, 0.2), wi = towards(cos_i, 2);
      const double expected = Passed(cos_o, thickness).share * Passed(cos_i, thickness).share * 0.8 /
                              (pi * 2.25 * (1 - 0.8 * returned(thickness)));
      // 20000 walks, each of a scatter of about its mean.
      EXPECT_NEAR(static_cast<double>(walked.value(wo, wi)[0]), expected, 0.015 * expected) << thickness;
      if (thickness == 0) {
        const Bsdf closed = Bsdf::coated_diffuse(Lanes::all(0.8), 1.5, {0, 0}, coating);
        EXPECT_NEAR(static_cast<double>(closed.value(wo, wi)[0]), expected, 1e-3 * expected);
      }
    }
  }
}

Bsdf turbid(Bsdf bsdf, double albedo, double g) {
  bsdf.make_turbid(Lanes::all(albedo), g);
  return bsdf;
}

struct CoatedMetal {
  const char* name;
  Bsdf bsdf;
};

std::vector<CoatedMetal> metals(int walks) {
  return {{"smooth coat", coated_metal(0, 0.3, 0, walks)},
          {"smooth metal", coated_metal(0.3, 0, 0.1, walks)},
          {"both rough", coated_metal(0.2, 0.4, 0.1, walks)},
          {"turbid, smooth coat", turbid(coated_metal(0, 0.3, 0.7, walks), 0.8, 0.5)},
          {"turbid, smooth metal", turbid(coated_metal(0.3, 0, 0.5, walks), 0.9, -0.4)},
          {"turbid, smooth", turbid(coated_metal(0, 0, 0.5, walks), 0.6, 0)}};
}

TEST(LayeredBsdf, SamplesAreWhatItsValueSays) {
  constexpr int rings = 60, sectors = 40, samples = 1 << 16;
  for (const auto& [name, bsdf] : metals(25))
    for (const double cos : {0.9, -0.5}) {
      const Vector3 wo = towards(cos, 1.1);
      // Total, and the part of one side, which finds directions that are mirrored the wrong way.
      std::array<double, 2> sampled{}, integral{};
      double mirrored = 0;
      for (std::uint32_t i = 0; i < samples; ++i) {
        const auto [choice, u, v, none] = SobolSample(5, i).next4();
        (void)none;
        const auto chosen = bsdf.sample(wo, choice, u, v);
        if (!chosen) continue;
        const double weight = static_cast<double>(chosen->weight[0]) / samples;
        if (chosen->mirror) {
          mirrored += weight;
          continue;
        }
        EXPECT_GT(chosen->wi.z * wo.z, 0) << name;
        sampled[0] += weight;
        if (dot(chosen->wi, towards(0, 1.1)) > 0) sampled[1] += weight;
      }
      for (int ring = 0; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector) {
          Vector3 wi = towards((ring + 0.5) / rings, 2 * pi * (sector + 0.5) / sectors);
          if (cos < 0) wi.z = -wi.z;
          const double each =
              static_cast<double>(bsdf.value(wo, wi)[0]) * std::abs(wi.z) * 2 * pi / (rings * sectors);
          integral[0] += each;
          if (dot(wi, towards(0, 1.1)) > 0) integral[1] += each;
        }
      // 2400 cells with 25 walks each, and 65536 samples: 1 %.
      EXPECT_NEAR(sampled[0], integral[0], 0.01) << name << " at cos " << cos;
      EXPECT_NEAR(sampled[1], integral[1], 0.01) << name << " at cos " << cos;
      EXPECT_LT(sampled[0] + mirrored, 1) << name;
    }
}

TEST(LayeredBsdf, MayExchangeItsDirections) {
  for (const auto& [name, bsdf] : metals(100000)) {
    const Vector3 a = towards(0.9, 0), b = towards(0.6, 2.8);
    const double there = static_cast<double>(bsdf.value(a, b)[0]),
                 back = static_cast<double>(bsdf.value(b, a)[0]);
    EXPECT_GT(there, 0.02) << name;
    EXPECT_NEAR(there, back, 0.02 * there) << name;
  }
}

double radiance_of(const std::string& scene, Vector3 from, Vector3 along, PathOptions::Lights lights,
                   int samples) {
  const auto world = world_of(scene);
  PathOptions options;
  options.max_depth = 100;
  options.lights = lights;
  const PathTracer tracer(*world, options);
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    SobolSample sample(23, static_cast<std::uint32_t>(i));
    const PathLight light = tracer.trace(from, normalised(along), 0, 1, sample);
    sum += static_cast<double>(light.shared[1] + light.alone);
  }
  return sum / samples;
}

/// A metal plate under a sheet of glass, which the path tracer meets as two surfaces, looks like one surface
/// of the coated metal; the light comes from a bright disk at the side and a dim sky.
TEST(LayeredBsdf, IsASlabOfGlassOverMetal) {
  const std::string lights =
      "LightSource \"infinite\" \"spectrum L\" [ 300 .2 900 .2 ]\nAttributeBegin\nAreaLightSource "
      "\"diffuse\" "
      "\"spectrum L\" [ 300 1 900 1 ] \"bool twosided\" true\nTranslate 1.5 0 1.5\nRotate 45 0 1 0\nShape "
      "\"disk\" \"float radius\" 2\nAttributeEnd\n";
  const std::string plate = "Shape \"disk\" \"float radius\" 1\n";
  const auto metal = [](double n, double k) {
    return "\"spectrum conductor.eta\" [ 300 " + std::to_string(n) + " 900 " + std::to_string(n) +
           " ] \"spectrum conductor.k\" [ 300 " + std::to_string(k) + " 900 " + std::to_string(k) + " ] ";
  };
  for (const auto& [coat, base] : {std::pair{0.0, 0.3}, {0.25, 0.0}, {0.25, 0.3}}) {
    const std::string alphas = "\"bool remaproughness\" false ",
                      of_coat = "roughness\" " + std::to_string(coat),
                      of_base = "roughness\" " + std::to_string(base);
    std::string below = metal(0.3 / 1.5, 3 / 1.5);
    for (std::size_t at; (at = below.find("conductor.")) != std::string::npos;) below.erase(at, 10);
    const std::string slab = lights + "Material \"conductor\" " + alphas + below + "\"float " + of_base +
                             "\n" + plate + "Material \"dielectric\" " + alphas + "\"float " + of_coat +
                             "\nTranslate 0 0 .001\n" + plate;
    const std::string coated = lights + "Material \"coatedconductor\" " + alphas + metal(0.3, 3) +
                               "\"integer nsamples\" 4 \"float interface." + of_coat + " \"float conductor." +
                               of_base + "\n" + plate;
    const Vector3 from{-2, 0, 2}, along{2, 0.1, -2};
    const double two = radiance_of(slab, from, along, PathOptions::Lights::by_chance, 1 << 15);
    // 32768 paths of a scatter of about half the mean, twice.
    EXPECT_NEAR(radiance_of(coated, from, along, PathOptions::Lights::both, 1 << 15), two, 0.015 * two)
        << coat << " " << base;
  }
}

/// Nothing is lost by a mirror under a smooth coat.
TEST(LayeredBsdf, KeepsTheLightOfAFurnace) {
  const auto sphere = [](const std::string& material) {
    return radiance_of(std::string(white_furnace) + material + "\nShape \"sphere\" \"float radius\" 1",
                       {0, 0.6, -3}, {0, 0, 1}, PathOptions::Lights::both, 4096);
  };
  const std::string white = "Material \"coatedconductor\" \"rgb reflectance\" [ 1 1 1 ] ";
  EXPECT_NEAR(sphere(white), 1, 3e-3);
  // Of all orders of reflection the first: F + (1 − F)² straight on.
  const auto one_order = world_of(std::string(white_furnace) + white +
                                  "\"integer maxdepth\" 1\nShape \"sphere\" \"float radius\" 1");
  SobolSample sample(1, 0);
  const PathLight light = PathTracer(*one_order, {}).trace({0, 0, -3}, {0, 0, 1}, 0, 0, sample);
  EXPECT_NEAR(static_cast<double>(light.shared[0]), 0.04 + 0.96 * 0.96, 1e-3);
}

TEST(LayeredBsdf, RefusesWhatIsNoCoat) {
  const auto message = [](const std::string& parameters) -> std::string {
    try {
      world_of("Material \"coatedconductor\" " + parameters + "\nShape \"sphere\"");
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_EQ(message("\"float thickness\" -1"), "test.pbrt:3:28: 0 or more would be right");
  EXPECT_EQ(message("\"integer nsamples\" 0"), "test.pbrt:3:28: a number from 1 to 1000 would be right");
  EXPECT_NE(message("\"float interface.eta\" 1").find("test.pbrt:3:28: a coating of index 1"),
            std::string::npos);
  EXPECT_EQ(message("\"float g\" 1"), "test.pbrt:3:28: a mean cosine above -1 and below 1 would be right");
  EXPECT_NE(message("\"spectrum conductor.k\" \"metal-Au-k\"").find("needs"), std::string::npos);
}

/// A coat of nearly the index of air over black: ω p (1 − exp(−τ (1/μ + 1/μ'))) / (μ + μ') of light that is
/// scattered once (Chandrasekhar, Radiative Transfer, 1960).
TEST(LayeredBsdf, ScattersOnceInATurbidCoat) {
  for (const double thickness : {0.2, 3.0})
    for (const double g : {0.0, 0.6}) {
      const Bsdf bsdf = turbid(
          Bsdf::layered(
              Lanes::all(0), Lanes::all(0), {0, 0}, {0, 0},
              layering(
                  {.eta = 1.0005, .thickness = thickness, .max_depth = 1, .walks = 40000, .metal = false})),
          0.7, g);
      const Vector3 wo = towards(0.9, 0.2), wi = towards(0.6, 2);
      const double expected = 0.7 * henyey_greenstein(-dot(wo, wi), g) *
                              -std::expm1(-thickness * (1 / wo.z + 1 / wi.z)) / (wo.z + wi.z);
      // 40000 walks of a scatter of about the mean, and what the boundary does: 0.1 %.
      EXPECT_NEAR(static_cast<double>(bsdf.value(wo, wi)[0]), expected, 0.02 * expected) << thickness << g;
    }
}

TEST(LayeredBsdf, KeepsTheLightInATurbidCoat) {
  const auto sphere = [](const std::string& material) {
    return radiance_of(std::string(white_furnace) + "Material \"coated" + material +
                           " \"float thickness\" 1 \"float albedo\" 1 \"float g\" 0.3\n"
                           "Shape \"sphere\" \"float radius\" 1",
                       {0, 0.6, -3}, {0, 0, 1}, PathOptions::Lights::both, 1 << 14);
  };
  const std::string white = "\"rgb reflectance\" [ 1 1 1 ]";
  // Paths of a scatter of up to 0.6 of the mean.
  EXPECT_NEAR(sphere("diffuse\" " + white), 1, 0.015);
  EXPECT_NEAR(sphere("conductor\" " + white), 1, 0.015);
}

/// Each square of a chequered coat is that of an even coat, to the bit.
TEST(LayeredBsdf, MayBeOtherHereThanThere) {
  const auto seen = [](const std::string& material, const std::string& thickness, double x) {
    const auto world = world_of(
        white_furnace +
        ("Texture \"t\" \"float\" \"checkerboard\" \"float uscale\" 2 \"float vscale\" 1 \"float tex1\" "
         "0.3 \"float tex2\" 0.8\nTexture \"a\" \"spectrum\" \"checkerboard\" \"float uscale\" 2 "
         "\"float vscale\" 1 \"spectrum tex1\" [ 300 0.2 900 0.2 ] \"spectrum tex2\" [ 300 0.9 900 0.9 ]\n"
         "Material \"" +
         material + "\" " + thickness +
         "\nShape \"bilinearmesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0 1 1 0 ]\n"));
    double sum = 0;
    for (std::uint32_t i = 0; i < 64; ++i) {
      SobolSample sample(1, i);
      sum +=
          static_cast<double>(PathTracer(*world, {}).trace({x, 0.1, 3}, {0, 0, -1}, 0, 0, sample).shared[0]);
    }
    return sum;
  };
  for (const char* material : {"coateddiffuse", "coatedconductor"}) {
    const double thin = seen(material, "\"float thickness\" 0.3", -0.5),
                 thick = seen(material, "\"float thickness\" 0.8", 0.5);
    EXPECT_GT(thin, 1.05 * thick);
    EXPECT_EQ(seen(material, "\"texture thickness\" \"t\"", -0.5), thin);
    EXPECT_EQ(seen(material, "\"texture thickness\" \"t\"", 0.5), thick);
    const auto inside = [&](double albedo, const char* g, double x) {
      return seen(material, flat("albedo", albedo) + g + "\"float thickness\" 0.5", x);
    };
    const std::string both = "\"texture albedo\" \"a\" \"texture g\" \"t\" \"float thickness\" 0.5";
    EXPECT_EQ(seen(material, both, -0.5), inside(0.2, "\"float g\" 0.3 ", -0.5));
    EXPECT_EQ(seen(material, both, 0.5), inside(0.9, "\"float g\" 0.8 ", 0.5));
    EXPECT_NE(inside(0.9, "\"float g\" 0.8 ", 0.5), inside(0.9, "", 0.5));
  }
  // The index of a glass is that at the d line.
  EXPECT_NEAR(seen("coateddiffuse", "\"spectrum eta\" \"glass-BK7\"", 0.5),
              seen("coateddiffuse", "\"float eta\" 1.5168", 0.5), 1e-4);
}

}  // namespace
}  // namespace petzval::render
