// SPDX-License-Identifier: BSD-3-Clause
// Measured materials, from files made of a metal of facets: against that metal, by χ², in a furnace, and as
// Mitsuba 3 reads them.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/materials/measured_brdf.h>
#include <petzval/render/path_tracer.h>

#include "measured_file.h"
#include "scene_text.h"
#include "sphere_cells.h"

#include "../scratch.h"

namespace petzval::render {
namespace {

const WavelengthGroups green({550});

Vector3 measured_way(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

const std::string& isotropic_file() {
  static const std::string bytes = MeasuredFile({0.3, 0.3}, {}).bytes();
  return bytes;
}
const std::string& brushed_file() {
  static const std::string bytes =
      MeasuredFile({0.2, 0.45}, {.thetas = 12, .phis = 65, .facets = 64, .spectra = 24}).bytes();
  return bytes;
}

struct Measured {
  const char* name;
  FacetMetal metal;
  MeasuredBrdf brdf;
};

const std::vector<Measured>& both() {
  static const std::vector<Measured> all = [] {
    std::vector<Measured> made;
    made.push_back({"isotropic", {0.3, 0.3}, {isotropic_file(), "isotropic.bsdf", green}});
    made.push_back({"brushed", {0.2, 0.45}, {brushed_file(), "brushed.bsdf", green}});
    return made;
  }();
  return all;
}

TEST(MeasuredBrdf, IsTheMetalThatItIsMadeOf) {
  for (const auto& [name, metal, brdf] : both()) {
    double sum = 0, of = 0;
    for (const double theta : {0.1, 0.5, 0.9, 1.2})
      for (const double phi : {0.3, 2.5, -1.9})
        for (const double theta_in : {0.05, 0.4, 0.8, 1.1})
          for (const double phi_in : {-2.7, -0.6, 0.9, 2.2}) {
            const Vector3 wo = measured_way(theta, phi), wi = measured_way(theta_in, phi_in);
            const double expected = metal.value(wo, wi, 550),
                         found = static_cast<double>(brdf.value(wo, wi, 0)[0]);
            // Between nodes, some 7 degrees apart: of the value, and where a lobe ends, of Lambert's.
            EXPECT_NEAR(found, expected, 0.03 * expected + 0.02 / pi) << name;
            sum += std::abs(found - expected), of += expected;
          }
    EXPECT_LT(sum / of, 0.01) << name;
  }
}

/// Values and densities that Mitsuba 3.9.1 ("measured", scalar_spectral at 550 nm) finds in the same files.
TEST(MeasuredBrdf, IsWhatMitsubaReads) {
  struct Known {
    double theta, phi, theta_in, phi_in;
    std::array<double, 2> value, pdf;
  };
  for (const Known& known : {Known{0.3, 0.2, 0.9, 2.5, {0.2048358, 0.2126295}, {0.1804202, 0.197291}},
                             Known{1.1, -2.0, 0.4, 0.6, {0.2352503, 0.5495391}, {0.3299448, 0.7818581}},
                             Known{0.05, 3.0, 1.2, -1.0, {0.1046256, 0.114137}, {0.05334897, 0.061512}},
                             Known{0.7, 1.0, 0.8, -2.0, {1.1236, 1.130476}, {1.144197, 1.204483}}})
    for (std::size_t i = 0; i < 2; ++i) {
      const MeasuredBrdf& brdf = both()[i].brdf;
      const Vector3 wo = measured_way(known.theta, known.phi),
                    wi = measured_way(known.theta_in, known.phi_in);
      EXPECT_NEAR(static_cast<double>(brdf.value(wo, wi, 0)[0]), known.value[i], 1e-5 * known.value[i]);
      EXPECT_NEAR(brdf.pdf(wo, wi), known.pdf[i], 1e-5 * known.pdf[i]);
    }
}

TEST(MeasuredBrdf, MayExchangeItsDirections) {
  for (const auto& [name, metal, brdf] : both())
    for (const double turn : {0.4, 1.7, 3.0}) {
      const Vector3 a = measured_way(0.3, 0.2), b = measured_way(1.0, 0.2 + turn);
      const double there = static_cast<double>(brdf.value(a, b, 0)[0]),
                   back = static_cast<double>(brdf.value(b, a, 0)[0]);
      EXPECT_NEAR(there, back, 0.03 * there) << name << " " << turn;
      EXPECT_EQ(static_cast<double>(brdf.value(-a, -b, 0)[0]), there) << name;
      EXPECT_EQ(static_cast<double>(brdf.value(a, -b, 0)[0]), 0) << name;
    }
}

TEST(MeasuredBrdf, SamplesItsDensity) {
  constexpr int samples = 1 << 17;
  for (const auto& [name, metal, brdf] : both())
    for (const double theta : {0.2, 0.9, 1.4, 2.4}) {
      const Vector3 wo = measured_way(theta, 0.7);
      SphereCells cells;
      double reflected = 0;
      for (std::uint32_t i = 0; i < samples; ++i) {
        const auto [u, v, none, other] = SobolSample(7, i).next4();
        (void)none, (void)other;
        const auto chosen = brdf.sample(wo, u, v, 0);
        if (!chosen) continue;
        cells.count(chosen->wi);
        reflected += static_cast<double>(chosen->weight[0]) / samples;
        if (i % 1000 == 0) {
          EXPECT_NEAR(chosen->pdf, brdf.pdf(wo, chosen->wi), 1e-3 * chosen->pdf) << name;
          const double weight =
              static_cast<double>(brdf.value(wo, chosen->wi, 0)[0]) * std::abs(chosen->wi.z) / chosen->pdf;
          EXPECT_NEAR(static_cast<double>(chosen->weight[0]), weight, 1e-3 * weight) << name;
        }
      }
      cells.expect_density(samples, 24, 0.01, std::string(name) + " at " + std::to_string(theta),
                           [&, &each = brdf](Vector3 wi) { return each.pdf(wo, wi); });
      // The metal keeps less than all of the light; what its facets lose to each other is small.
      double expected = 0;
      constexpr int rings = 400, sectors = 400;
      for (int ring = 0; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector) {
          const double cos = (ring + 0.5) / rings;
          const Vector3 wi = measured_way(std::acos(cos), 2 * pi * (sector + 0.5) / sectors);
          expected += metal.value(wo.z < 0 ? -wo : wo, wi, 550) * cos * 2 * pi / (rings * sectors);
        }
      EXPECT_NEAR(reflected, expected, 0.01) << name << " at " << theta;
    }
}

/// Between the wavelengths of the file, and beyond them.
TEST(MeasuredBrdf, HasTheBandsOfThePicture) {
  const MeasuredBrdf brdf(isotropic_file(), "metal.bsdf", WavelengthGroups({380, 400, 450, 500, 800}));
  const Vector3 wo = measured_way(0.7, 0), wi = measured_way(0.6, 3);
  const Lanes f = brdf.value(wo, wi, 0);
  EXPECT_EQ(f[0], f[1]);
  EXPECT_NEAR(f[2], (f[1] + f[3]) / 2, 1e-6f);
  const double expected = FacetMetal{}.value(wo, wi, 700);
  EXPECT_NEAR(static_cast<double>(f[4]), expected, 0.01 * expected);
}

double furnace_radiance(const World& world, PathOptions::Lights lights) {
  const PathTracer tracer(world, {.max_depth = 50, .lights = lights});
  double sum = 0;
  constexpr int samples = 1 << 15;
  for (std::uint32_t i = 0; i < samples; ++i) {
    SobolSample sample(3, i);
    sum += static_cast<double>(
        tracer.trace({0, 0, 2}, normalised(Vector3{0.01, 0.02, -1}), 0, 0, sample).shared[1]);
  }
  return sum / samples;
}

TEST(MeasuredBrdf, IsAsBrightInAFurnaceHoweverLightIsFound) {
  const test::Scratch scratch;
  const std::string path = scratch.with("metal.bsdf", isotropic_file());
  const auto world = world_of(white_furnace +
                              ("Material \"measured\" \"string filename\" \"" + path + "\"\nShape \"disk\""));
  const MeasuredBrdf brdf(isotropic_file(), path, WavelengthGroups({450, 550, 650}));
  const auto expected = static_cast<double>(brdf.albedo(0)[1]);
  EXPECT_GT(expected, 0.6);
  EXPECT_LT(expected, 0.8);
  for (const auto lights :
       {PathOptions::Lights::both, PathOptions::Lights::sampled, PathOptions::Lights::by_chance})
    EXPECT_NEAR(furnace_radiance(*world, lights), expected, 0.005);
}

std::string fault_of(const std::string& bytes) {
  try {
    MeasuredBrdf(bytes, "m.bsdf", green);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(MeasuredBrdf, SaysWhatIsWrongWithAFile) {
  const std::string good =
      MeasuredFile({0.3, 0.3}, {.thetas = 3, .facets = 8, .spectra = 4, .wavelengths_nm = {500, 600}})
          .bytes();
  EXPECT_EQ(fault_of(good), "");
  EXPECT_EQ(fault_of("P6 1 1 255"),
            "m.bsdf: is no tensor file; .bsdf files of measured materials begin with \"tensor_file\"");
  for (std::size_t size = 0; size < good.size(); size += 7) {
    const std::string found = fault_of(good.substr(0, size));
    EXPECT_TRUE(found.starts_with("m.bsdf: ")) << size;
    EXPECT_EQ(found.find('\n'), std::string::npos);
  }
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string bytes = good;
    return fault_of(bytes.replace(bytes.find(from), from.size(), to));
  };
  EXPECT_EQ(with("vndf", "VNDF"), "m.bsdf: has no field \"vndf\"");
  EXPECT_EQ(with("spectra", "rgb    "), "m.bsdf: has no field \"spectra\"");
  TensorWriter colours;
  for (const char* axis : {"theta_i", "phi_i"}) colours.add(axis, {1}, {0});
  for (const char* map : {"ndf", "sigma"}) colours.add(map, {2, 2}, {1, 1, 1, 1});
  for (const char* tables : {"vndf", "luminance"}) colours.add(tables, {1, 1, 2, 2}, {1, 1, 1, 1});
  colours.add("rgb", {1, 1, 3, 2, 2}, std::vector<float>(12, 1));
  EXPECT_EQ(fault_of(colours.file()), "m.bsdf: holds colours (rgb); a file with spectra would be right");
}

TEST(MeasuredBrdf, IsNamedByAScene) {
  const auto refused = [](const std::string& parameters) {
    try {
      world_of("Material \"measured\" " + parameters + "\nShape \"sphere\"");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused(""), "test.pbrt:3:1: a measured material needs \"string filename\", a .bsdf file");
  EXPECT_TRUE(refused("\"string filename\" \"/nowhere/m.bsdf\"").starts_with("test.pbrt:3:21: "));
}

}  // namespace
}  // namespace petzval::render
