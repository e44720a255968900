// SPDX-License-Identifier: BSD-3-Clause
// Media against the laws of radiative transfer: Beer and Lambert, white furnaces, single scattering in closed
// form, Chandrasekhar's H-functions; and against each other.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/render/camera/lens_camera.h>
#include <petzval/render/media/named_media.h>
#include <petzval/render/media/phase_function.h>

#include <array>
#include <limits>

#include "media_scenes.h"

namespace petzval::render {
namespace {

TEST(PhaseFunction, IntegratesToOneAndIsSampledAsItSays) {
  const QuadratureRule rule = gauss_legendre(400, -1, 1);
  for (const double g : {0.0, 1e-5, 0.3, 0.8, -0.5, 0.95}) {
    double integral = 0, mean = 0;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double each = 2 * pi * rule.weights[i] * henyey_greenstein(rule.nodes[i], g);
      integral += each, mean += rule.nodes[i] * each;
    }
    EXPECT_NEAR(integral, 1, 1e-9) << g;
    EXPECT_NEAR(mean, g, 1e-9) << g;
    const Vector3 way = normalised({0.3, -0.8, 0.5});
    constexpr int samples = 1 << 14, bins = 8;
    std::array<double, bins> found{}, expected{};
    double around = 0;
    for (std::uint32_t i = 0; i < samples; ++i) {
      const auto [u, v] = SobolSample(7, i).next2();
      const Vector3 to = sample_henyey_greenstein(way, g, u, v);
      ASSERT_NEAR(length(to), 1, 1e-12);
      found[static_cast<std::size_t>(std::min(bins - 1.0, (dot(way, to) + 1) / 2 * bins))] += 1.0 / samples;
      around += dot(to, Frame(way).x) / samples;
    }
    for (int bin = 0; bin < bins; ++bin) {
      const QuadratureRule part = gauss_legendre(100, -1 + 2.0 * bin / bins, -1 + 2.0 * (bin + 1) / bins);
      for (std::size_t i = 0; i < part.nodes.size(); ++i)
        expected[static_cast<std::size_t>(bin)] +=
            2 * pi * part.weights[i] * henyey_greenstein(part.nodes[i], g);
      // Points of a net of 2^14.
      EXPECT_NEAR(found[static_cast<std::size_t>(bin)], expected[static_cast<std::size_t>(bin)], 1e-3) << g;
    }
    EXPECT_NEAR(around, 0, 2e-3) << g;
  }
}

TEST(Media, AbsorbByBeerAndLambert) {
  const std::string lit =
      std::string(white_furnace) + medium(coloured("sigma_a", 0.1, 0.5, 2) + flat("sigma_s", 0));
  const auto expect = [](const Estimate& found, double way, double share) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<double, 3> absorption{0.1, 0.5, 2};
      EXPECT_NEAR(found.mean[i], share * std::exp(-absorption[i] * way), 1e-5) << i;
    }
  };
  const auto open = world_of(lit + fog_inside + slab(1.5));
  expect(seen(*open, {0, 0, 5}, {0, 0, -1}, 8), 1.5, 1);
  expect(seen(*open, {0, 0, 5}, {3, 0, -4}, 8), 1.5 / 0.8, 1);
  // From inside, and with a camera that stands in the medium.
  Unsupported unsupported;
  const auto around =
      build_world(parse_scene_description(
                      medium(coloured("sigma_a", 0.1, 0.5, 2) + flat("sigma_s", 0)) +
                          "MediumInterface \"\" \"fog\"\nCamera \"perspective\"\nWorldBegin\n" +
                          white_furnace + "Material \"interface\"\nShape \"sphere\" \"float radius\" 3\n",
                      "test.pbrt", unsupported),
                  WavelengthGroups({450, 550, 650}), {true}, unsupported);
  EXPECT_EQ(around->camera_medium, 0);
  // The sphere leads from the fog outside into none, as it says.
  EXPECT_EQ(around->geometries[0].outside, 0);
  // A shell of two spheres: only between them.
  const auto shell =
      world_of(lit + fog_inside + "Shape \"sphere\" \"float radius\" 2\nMediumInterface \"\" \"fog\"\n" +
               "Shape \"sphere\" \"float radius\" 1\n");
  expect(seen(*shell, {0, 0, 5}, {0, 0, -1}, 8), 2, 1);
  // Objects that are placed, and turned inside out.
  const auto placed =
      world_of(lit + "ObjectBegin \"ball\"\n" + fog_inside +
               "Shape \"sphere\" \"float radius\" 1\nObjectEnd\nScale 2 2 -2\nObjectInstance \"ball\"");
  expect(seen(*placed, {0, 0, 5}, {0, 0, -1}, 8), 4, 1);
  const auto reversed =
      world_of(lit + "ReverseOrientation\nMediumInterface \"\" \"fog\"\nMaterial \"interface\"\n" +
               "Shape \"sphere\" \"float radius\" 1\n");
  expect(seen(*reversed, {0, 0, 5}, {0, 0, -1}, 8), 2, 1);
}

TEST(Equiangular, SamplesHaveTheirDensity) {
  for (const double g : {0.0, 0.6, -0.9}) {
    const AngleShares shares(g);
    for (const double length : {2.0, 30.0, std::numeric_limits<double>::infinity()}) {
      const Equiangular beside({1, 2, 3}, {0, 0, 1}, length, {1, 2.5, 8}, 0.01, shares);
      constexpr double step = 1e-7;
      for (double u = 0.0137; u < 1; u += 0.0711) {
        const double at = beside.sample(u), next = beside.sample(u + step);
        EXPECT_GT(at, 0);
        EXPECT_LT(next, length);
        EXPECT_NEAR((next - at) * beside.density(at) / step, 1, 1e-4) << g << " " << u;
      }
    }
  }
}

TEST(Media, LampBesideARayIsQuiet) {
  // Light scattered once, of a lamp that the ray passes at a hundredth of the fog's depth: by free flights
  // alone a sample deviates by about 6 times the mean.
  const auto world = world_of(
      std::string("LightSource \"point\" \"point3 from\" [ 0.02 0 -1 ] \"spectrum I\" [ 300 1 900 1 ]\n") +
      medium(coloured("sigma_a", 0.1, 0.1, 0.1) + flat("sigma_s", 0.2), 0.3) + fog_inside + slab(2));
  constexpr int samples = 1 << 12;
  const Estimate found = seen(*world, {0, 0, 5}, {0, 0, -1}, samples, PathOptions::Lights::both, 1);
  EXPECT_LT(found.deviation[1] * std::sqrt(samples), 1.5 * found.mean[1]);
}

TEST(Media, DimTheLampThatIsAsked) {
  // A floor below the fog, lit by a lamp inside, one above, the sun and the sky: E of each by itself.
  const std::string scene =
      medium(coloured("sigma_a", 0.1, 0.5, 2) + flat("sigma_s", 0)) + fog_inside + slab(1) +
      "MediumInterface \"\" \"\"\nMaterial \"diffuse\" \"float reflectance\" 1\nTranslate 0 0 -2\n"
      "Shape \"disk\" \"float radius\" 50\n";
  struct Lamp {
    const char* text;
    double irradiance, way;
  };
  for (const auto& [text, irradiance, way] :
       {Lamp{"LightSource \"point\" \"point3 from\" [ 0 0 2 ] \"spectrum I\" [ 300 1 900 1 ]\n", 1.0 / 16, 1},
        Lamp{"LightSource \"point\" \"point3 from\" [ 0 0 -0.5 ] \"spectrum I\" [ 300 1 900 1 ]\n", 1 / 2.25,
             0.5},
        Lamp{"LightSource \"distant\" \"point3 from\" [ 3 0 4 ] \"point3 to\" [ 0 0 0 ] \"spectrum L\" [ 300 "
             "1 900 1 ]\n",
             0.8, 1 / 0.8}}) {
    // The eye stands just above the floor, below the fog.
    const auto world = world_of(text + scene);
    const Estimate found = seen(*world, {0, 0, -1.5}, {0, 0, -1}, 8, PathOptions::Lights::both, 1);
    const std::array<double, 3> absorption{0.1, 0.5, 2};
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(found.mean[i], irradiance / pi * std::exp(-absorption[i] * way), 1e-4 * irradiance) << text;
  }
  // An opaque thing in the fog still casts its shadow.
  const auto world = world_of(
      std::string("LightSource \"point\" \"point3 from\" [ 0 0 2 ] \"spectrum I\" [ 300 1 900 1 ]\n") +
      scene + "Translate 0 0 1.5\nShape \"disk\" \"float radius\" 0.1\n");
  EXPECT_EQ(seen(*world, {0, 0, -1.5}, {0, 0, -1}, 8, PathOptions::Lights::both, 1).mean[0], 0);
}

class MediaFurnace : public testing::TestWithParam<PathOptions::Lights> {};

TEST_P(MediaFurnace, KeepsTheLight) {
  for (const double g : {0.0, 0.8, -0.5})
    for (const char* boundary : {fog_inside, glass_about_fog})
      for (const std::string& coefficient : {flat("sigma_s", 2), coloured("sigma_s", 0.5, 2, 6)}) {
        const auto world = world_of(std::string(white_furnace) + medium(flat("sigma_a", 0) + coefficient, g) +
                                    boundary + "Shape \"sphere\" \"float radius\" 1\n");
        const Estimate found = seen(*world, {0, 0.3, -5}, {0, 0, 1}, 1 << 11, GetParam());
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_NEAR(found.mean[i], 1, 4.5 * found.deviation[i] + 1e-4)
              << g << " " << coefficient << boundary;
        // All that scatters is by how much a wavelength is taken for the three, none to three times: √2 a
        // path.
        if (GetParam() == PathOptions::Lights::both) {
          EXPECT_LT(found.deviation[1], std::sqrt(2.0 / (1 << 11)));
        }
      }
}

INSTANTIATE_TEST_SUITE_P(Ways, MediaFurnace,
                         testing::Values(PathOptions::Lights::both, PathOptions::Lights::by_chance,
                                         PathOptions::Lights::sampled));

TEST(Media, ScatterOnceAsTheClosedFormSays) {
  // Sun from 60 degrees, seen straight down and obliquely: σs p(Θ) E (1 − exp(−σt d (1/μ + 1/μ0))) / …
  constexpr double depth = 0.7, g = 0.4;
  const auto world = world_of(
      "LightSource \"distant\" \"point3 from\" [ 0 .8660254037844386 .5 ] \"point3 to\" [ 0 0 0 ] \"spectrum "
      "L\" "
      "[ 300 1 900 1 ]\n" +
      medium(coloured("sigma_a", 0.1, 0.2, 0.3) + coloured("sigma_s", 0.2, 1, 3), g) + fog_inside +
      slab(depth));
  const std::array<double, 3> scattering{0.2, 1, 3}, all{0.3, 1.2, 3.3};
  for (const Vector3 along : {Vector3{0, 0, -1}, Vector3{0.6, 0, -0.8}, Vector3{0, -0.8, -0.6}}) {
    const Estimate found = seen(*world, -2 * along, along, 1 << 13, PathOptions::Lights::both, 1);
    const double mu = -along.z, mu0 = 0.5;
    const double cos = dot(along, Vector3{0, std::sqrt(0.75), 0.5});  // to the sun
    for (std::size_t i = 0; i < 3; ++i) {
      const double sum = all[i] * (1 / mu + 1 / mu0);
      const double expected =
          scattering[i] * henyey_greenstein(cos, g) / mu * (1 - std::exp(-sum * depth)) / sum;
      EXPECT_NEAR(found.mean[i], expected, 4.5 * found.deviation[i] + 1e-6) << i;
      EXPECT_LT(found.deviation[i], 0.02 * expected);
    }
  }
}

/// H of isotropic scattering (Chandrasekhar, Radiative Transfer, 1950, chapter V): iterated from its integral
/// equation in the form that is stable for all albedos, 1/H = √(1 − ω) + ω/2 ∫ t H(t)/(μ + t) dt.
double h_function(double mu, double albedo) {
  const QuadratureRule rule = gauss_legendre(64, 0, 1);
  std::vector<double> h(rule.nodes.size(), 1);
  const auto at = [&](double m) {
    double sum = 0;
    for (std::size_t i = 0; i < h.size(); ++i)
      sum += rule.weights[i] * rule.nodes[i] * h[i] / (m + rule.nodes[i]);
    return 1 / (std::sqrt(1 - albedo) + albedo / 2 * sum);
  };
  for (int round = 0; round < 300; ++round) {
    std::vector<double> next = h;
    for (std::size_t i = 0; i < h.size(); ++i) next[i] = (h[i] + at(rule.nodes[i])) / 2;
    h = next;
  }
  return at(mu);
}

TEST(Media, ReflectAsChandrasekharSays) {
  // His table XI: H(1) of a conservative half space.
  EXPECT_NEAR(h_function(1, 1), 2.9078, 2e-4);
  // Under an even sky of 1 a half space shines by 1 − √(1 − ω) H(μ); under a sun of irradiance E across its
  // direction, by ω/(4π) μ0/(μ + μ0) H(μ) H(μ0) E.
  const std::array<double, 3> albedo{0.5, 0.9, 0.99};
  const std::string half_space =
      medium(coloured("sigma_a", 0.5, 0.1, 0.01) + coloured("sigma_s", 0.5, 0.9, 0.99)) + fog_inside +
      "Shape \"disk\" \"float radius\" 1e6\n";
  const auto sky = world_of(white_furnace + half_space);
  const auto sun = world_of(
      "LightSource \"distant\" \"point3 from\" [ .8 0 .6 ] \"point3 to\" [ 0 0 0 ] \"spectrum L\" [ 300 1 "
      "900 1 ]\n" +
      half_space);
  for (const double mu : {1.0, 0.3}) {
    const Vector3 along{0, std::sqrt(1 - mu * mu), -mu};
    const Estimate under_sky = seen(*sky, {0, 0, 0.1}, along, 1 << 13),
                   under_sun = seen(*sun, {0, 0, 0.1}, along, 1 << 13);
    for (std::size_t i = 0; i < 3; ++i) {
      const double h = h_function(mu, albedo[i]);
      EXPECT_NEAR(under_sky.mean[i], 1 - std::sqrt(1 - albedo[i]) * h, 4.5 * under_sky.deviation[i]) << mu;
      const double expected = albedo[i] / (4 * pi) * 0.6 / (mu + 0.6) * h * h_function(0.6, albedo[i]);
      EXPECT_NEAR(under_sun.mean[i], expected, 4.5 * under_sun.deviation[i]) << mu;
      EXPECT_LT(under_sun.deviation[i], 0.05 * expected);
    }
  }
}

/// A lit ball of coloured fog, with a matt ball in it, looks as each wavelength by itself has it.
TEST(Media, GiveEachWavelengthWhatItHasAlone) {
  const std::array<double, 3> absorption{0.05, 0.3, 1}, scattering{0.3, 2, 1.2};
  const auto scene = [&](const std::string& coefficients) {
    return "LightSource \"infinite\" \"spectrum L\" [ 300 .3 900 .3 ]\nAttributeBegin\nAreaLightSource "
           "\"diffuse\" "
           "\"spectrum L\" [ 300 9 900 9 ] \"bool twosided\" true\nTranslate 2 0 0\nRotate 90 0 1 0\nShape "
           "\"disk\" "
           "\"float radius\" .5\nAttributeEnd\n" +
           medium(coefficients, 0.5) + fog_inside +
           "Shape \"sphere\" \"float radius\" 1.5\nMediumInterface \"fog\" \"fog\"\nMaterial "
           "\"diffuse\"\nTranslate 0 0 "
           "-.5\nShape \"sphere\" \"float radius\" 0.4\n";
  };
  const auto all = world_of(scene(coloured("sigma_a", 0.05, 0.3, 1) + coloured("sigma_s", 0.3, 2, 1.2)));
  const Vector3 from{0, 0.3, -5}, along{0, 0, 1};
  for (const auto lights : {PathOptions::Lights::both, PathOptions::Lights::by_chance}) {
    const int samples = lights == PathOptions::Lights::both ? 1 << 14 : 1 << 16;
    const Estimate found = seen(*all, from, along, samples, lights);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto one = world_of(scene(flat("sigma_a", absorption[i]) + flat("sigma_s", scattering[i])));
      const Estimate alone = seen(*one, from, along, 1 << 14);
      EXPECT_NEAR(found.mean[i], alone.mean[i], 4.5 * std::hypot(found.deviation[i], alone.deviation[i]))
          << i;
      if (lights == PathOptions::Lights::both) {
        EXPECT_LT(found.deviation[i], 0.02 * found.mean[i]);
      }
    }
  }
}

/// Glass that disperses leaves the hero alone, in fog and before it.
TEST(Media, FollowsTheHeroThroughDispersingGlass) {
  for (const char* order : {"in fog", "before fog"}) {
    const bool in_fog = std::string(order) == "in fog";
    const std::string glass =
        "Material \"dielectric\" \"spectrum eta\" \"glass-SF11\"\nShape \"sphere\" \"float radius\" 0.5\n";
    const auto world =
        world_of(std::string(white_furnace) + medium(flat("sigma_a", 0) + coloured("sigma_s", 0.2, 1, 3)) +
                 (in_fog ? fog_inside +
                               std::string("Shape \"sphere\" \"float radius\" 1\nMediumInterface "
                                           "\"\" \"fog\"\n") +
                               glass
                         : "MediumInterface \"fog\" \"\"\n" + glass));
    const Estimate found = seen(*world, {0, 0.1, -5}, {0, 0, 1}, 3 << 12);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(found.mean[i], 1, 4.5 * found.deviation[i] + 1e-4) << order << i;
  }
}

/// Through a lens that disperses, wavelengths do not lead to a ray alike: at the border of what it lets in
/// some do not at all. With coloured fog before it, which only scatters, the light of a furnace is what it
/// was.
TEST(Media, LeaveTheLightOfALensThatDisperses) {
  const std::vector<double> wavelengths{420, 460, 500, 540, 580, 620, 660, 700};
  const auto picture = [&](const std::string& before) {
    Unsupported unsupported;
    const auto world = build_world(
        parse_scene_description(before + "Camera \"perspective\"\nWorldBegin\n" + white_furnace +
                                    "Material \"interface\"\nReverseOrientation\nShape \"sphere\" "
                                    "\"float radius\" 3\n",
                                "test.pbrt", unsupported),
        WavelengthGroups(wavelengths), {true}, unsupported);
    const SensorGeometry film{2, 2, 20};  // not wider than the colours that the lens spreads
    const LensCamera camera(read_lens("edmund-54852").lens, film, world->groups);
    RenderOptions options;
    options.samples_per_pixel = 1 << 15;
    options.path.max_depth = 200;
    return render_picture(*world, camera, Transform(), film, options);
  };
  const Rendering clear = picture(""),
                  foggy = picture(
                      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" " + flat("sigma_a", 0) +
                      "\"spectrum sigma_s\" [ 400 2 550 .2 700 2 ]\nMediumInterface \"\" \"fog\"\n");
  const std::size_t pixels = clear.irradiance.values().size() / wavelengths.size();
  for (std::size_t band = 0; band < wavelengths.size(); ++band) {
    double with = 0, without = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
      without += static_cast<double>(clear.irradiance.values()[band * pixels + i]);
      with += static_cast<double>(foggy.irradiance.values()[band * pixels + i]);
    }
    // As many paths, each of a scatter of its mean.
    EXPECT_NEAR(with / without, 1, 4.5 / std::sqrt(4 << 15)) << wavelengths[band];
  }
}

/// Pictures of first surfaces look through media as if they were clear.
TEST(Media, ShowTheFirstSurfaceBehindThem) {
  const auto world = world_of(std::string(white_furnace) + medium(flat("sigma_s", 1)) + fog_inside + slab(1) +
                              "MediumInterface \"\"\nMaterial \"diffuse\" \"float reflectance\" "
                              "0.25\nTranslate 0 0 -3\nShape \"disk\" "
                              "\"float radius\" 10\n");
  int through = 0;
  for (std::uint32_t i = 0; i < 64; ++i) {
    SobolSample sample(3, i);
    FirstSurface first;
    const PathLight light =
        PathTracer(*world, {})
            .trace({0, 0, 1}, {0, 0, -1}, 0, 0, sample, std::numeric_limits<double>::infinity(), &first);
    ASSERT_TRUE(first.met);
    EXPECT_NEAR(first.position.z, -3, 1e-6);
    EXPECT_NEAR(static_cast<double>(first.albedo[0]), 0.25, 1e-6);
    if (light.distance > 3.9) ++through;
  }
  // exp(−σt) of the light, whose σt is 2: 8.7 of 64.
  EXPECT_NEAR(through, 64 * std::exp(-2), 2);
}

TEST(Media, AreKnownByName) {
  const auto first = [](const std::string& text) {
    const auto world = world_of(text + "\nShape \"sphere\"\n");
    return std::array{world->media[0].absorption[0][2], world->media[0].scattering[0][2]};
  };
  // Of the three wavelengths the last is red.
  const std::string skin = "\"rgb sigma_a\" [ .032 .17 .48 ] \"rgb sigma_s\" [ .74 .88 1.01 ]";
  EXPECT_EQ(first("Material \"subsurface\" \"string name\" \"Skin1\" \"float scale\" 3"),
            first("Material \"subsurface\" \"float scale\" 3 " + skin));
  EXPECT_EQ(first("Material \"subsurface\" \"string name\" \"Wholemilk\""), first("Material \"subsurface\""));
  EXPECT_EQ(first("MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"string preset\" \"Skin1\""),
            first("MakeNamedMedium \"a\" \"string type\" \"homogeneous\" " + skin));
  for (const NamedMedium& each : named_media())
    EXPECT_GT(first("Material \"subsurface\" \"string name\" \"" + std::string(each.name) + "\"")[1], 0);
}

TEST(Media, RefusesWhatIsNoMedium) {
  EXPECT_EQ(media_message("MediumInterface \"smoke\" \"\"\nShape \"sphere\""),
            "test.pbrt:3:1: there is no medium \"smoke\"; MakeNamedMedium makes one");
  // It may be made later, but once.
  EXPECT_EQ(media_message("MediumInterface \"fog\" \"\"\nShape \"sphere\"\n" + medium("")), "nothing");
  EXPECT_EQ(media_message(medium("") + medium("")), "test.pbrt:4:1: there is a medium \"fog\" already");
  EXPECT_EQ(media_message("MakeNamedMedium \"a\""), "test.pbrt:3:1: medium \"a\" has no \"string type\"");
  EXPECT_EQ(media_message("MakeNamedMedium \"\" \"string type\" \"homogeneous\""),
            "test.pbrt:3:1: a medium without a name");
  const auto with = [](const std::string& parameter) {
    return media_message("MakeNamedMedium \"a\" \"string type\" \"homogeneous\"\n" + parameter);
  };
  EXPECT_EQ(with("\"float g\" 1"), "test.pbrt:4:1: a mean cosine of 1; above -1 and below 1 would be right");
  EXPECT_NE(with("\"float g\" -1.5").find("test.pbrt:4:1"), std::string::npos);
  EXPECT_EQ(with("\"float scale\" -1"), "test.pbrt:4:1: 0 or more would be right");
  EXPECT_EQ(with("\"spectrum sigma_s\" [ 400 -1 700 -1 ]"),
            "test.pbrt:4:1: a coefficient of -1 at 450 nm; 0 to 1e+12 would be right");
  EXPECT_NE(with("\"rgb sigma_a\" [ 1 -1 1 ]").find("test.pbrt:4:1: \"rgb sigma_a\" takes three numbers"),
            std::string::npos);
  EXPECT_EQ(with("\"rgb attenuation\" [ 1 .5 0 ] \"float attenuationdistance\" 0"),
            "test.pbrt:4:30: a distance above 0 would be right");
  EXPECT_EQ(with("\"rgb attenuation\" [ 1 .5 0 ] \"float attenuationdistance\" 2"), "nothing");
  EXPECT_NE(with("\"string preset\" \"Tea\"").find("test.pbrt:4:1: a medium named \"Tea\""),
            std::string::npos);
  EXPECT_EQ(with("\"string preset\" \"Skin1\" \"rgb sigma_a\" [ 1 1 1 ]"),
            "test.pbrt:4:1: a medium has either a preset or coefficients of its own");
  EXPECT_NE(media_message("MakeNamedMedium \"a\" \"string type\" \"cloud\"").find("a medium \"cloud\""),
            std::string::npos);
}

}  // namespace
}  // namespace petzval::render
