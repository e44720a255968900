// SPDX-License-Identifier: BSD-3-Clause
// Single lights stronger, turned and coloured: against Lambert's and Planck's laws.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/colour/observer.h>
#include <petzval/render/lights/light_change.h>
#include <petzval/simulate/render.h>
#include <scratch.h>

#include <cmath>
#include <numbers>

namespace petzval {
namespace {

/// A pinhole that looks along +z, y up.
constexpr const char* view_text =
    "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 4 \"float diagonal\" 20\nWorldBegin\n";

/// Two surfaces that shine and fill the left and the right half of the picture.
constexpr const char* panels =
    "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
    "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 2 1 .5 ] \"bool twosided\" true\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -9 -9 5  0 -9 5  -9 9 5  0 9 5 ]\nAttributeEnd\n"
    "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ] \"bool twosided\" true\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ 0 -9 5  9 -9 5  0 9 5  9 9 5 ]\nAttributeEnd\n";

/// A wall whose front is turned by 60 degrees towards +x from facing the camera, and a sun behind the camera.
constexpr const char* sunlit =
    "LightSource \"distant\" \"point3 from\" [ 0 0 0 ] \"point3 to\" [ 0 0 1 ]\n"
    "AttributeBegin\nTranslate 0 0 5\nRotate 60 0 1 0\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -9 -9 0  9 -9 0  -9 9 0  9 9 0 ]\nAttributeEnd\n";

/// The light of all bands at one pixel.
std::vector<double> light(const std::string& text, const std::vector<std::string>& changes, int column,
                          const std::vector<double>& wavelengths_nm = {450, 550, 650}) {
  const test::Scratch scratch;
  RenderRequest request{.scene = scratch.with("scene.pbrt", view_text + text), .focus_as_in_scene = true};
  request.wavelengths_nm = wavelengths_nm;
  request.samples_per_pixel = 4;
  request.max_depth = 1;
  for (const std::string& change : changes)
    request.light_changes.push_back(render::parse_light_change(change));
  const SpectralImage made = render_scene(prepare_scene(request)).irradiance;
  std::vector<double> bands;
  const std::size_t bands_count = wavelengths_nm.size(), pixel = static_cast<std::size_t>(2 * 8 + column);
  for (std::size_t band = 0; band < bands_count; ++band)
    bands.push_back(double(made.band(static_cast<int>(band))[pixel]));
  return bands;
}

TEST(LightChange, MakesOneLightStrongerAndLeavesTheOther) {
  const std::vector<double> left = light(panels, {}, 1), right = light(panels, {}, 6);
  const std::vector<std::string> changes = {"scale@0=3", "scale@1=0.5"};
  const std::vector<double> left_now = light(panels, changes, 1), right_now = light(panels, changes, 6);
  for (std::size_t band = 0; band < 3; ++band) {
    EXPECT_NEAR(left_now[band], 3 * left[band], 1e-5 * left[band]);
    EXPECT_NEAR(right_now[band], 0.5 * right[band], 1e-5 * right[band]);
    EXPECT_EQ(light(panels, {"scale@0=0"}, 1)[band], 0);
  }
}

TEST(LightChange, HasTheColourOfPlanckAndKeepsItsLuminance) {
  std::vector<double> nm;
  for (double at = 380; at <= 780; at += 10) nm.push_back(at);
  const auto luminance = [&](const std::vector<double>& bands) {
    return Observer::cie_1931().xyz(Spectrum(nm, bands)).y;
  };
  const std::vector<double> before = light(panels, {}, 1, nm),
                            after = light(panels, {"kelvin@0=3000", "kelvin@1=8000"}, 1, nm);
  EXPECT_NEAR(luminance(after) / luminance(before), 1, 0.01);
  const auto planck = [](double at_nm) {
    return std::pow(at_nm, -5) / std::expm1(1.438776877e7 / (at_nm * 3000));
  };
  for (std::size_t band = 0; band < nm.size(); ++band)
    EXPECT_NEAR(after[band] / after[20], planck(nm[band]) / planck(nm[20]), 1e-4) << nm[band];
}

TEST(LightChange, TurnedTheSunLightsAWallByLambertsLaw) {
  // The wall's front looks 60 degrees away from the sun.
  const double square_on = 2 * light(sunlit, {}, 4)[1];
  ASSERT_GT(square_on, 0);
  for (const double turned : {60.0, 20.0, -20.0, -60.0}) {
    const double cosine = std::cos((60 - turned) * std::numbers::pi / 180);
    EXPECT_NEAR(light(sunlit, {"turn_deg@0=" + std::to_string(turned)}, 4)[1] / square_on,
                std::max(0.0, cosine), 1e-4)
        << turned;
  }
}

TEST(LightChange, RefusesWhatIsNoChangeAndLightsThatAreNotThere) {
  for (const char* wrong : {"scale", "scale@0", "scale@=2", "scale@x=2", "bright@0=2", "scale@0=-1",
                            "kelvin@0=20", "turn_deg@0=", "scale@0=nan", "scale=2@0"})
    EXPECT_THROW(render::parse_light_change(wrong), InputError) << wrong;
  const auto says = [](const char* change) {
    try {
      light(panels, {change}, 1);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(says("scale@2=2").find("0 area diffuse, 1 area diffuse"), std::string::npos) << says("scale@2=2");
  EXPECT_NE(says("turn_deg@1=2").find("stands where it is"), std::string::npos);
}

}  // namespace
}  // namespace petzval
