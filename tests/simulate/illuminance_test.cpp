// SPDX-License-Identifier: BSD-3-Clause
// From lux on the scene to electrons in a pixel, by hand: the integral over the light of what a white wall
// gives back, what reaches the sensor of it, and the photons that count.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tables.h>
#include <petzval/base/error.h>
#include <petzval/colour/illuminants.h>
#include <petzval/colour/observer.h>
#include <petzval/lens/lens_file.h>
#include <petzval/sensor/photo_current.h>
#include <petzval/simulate/image.h>

#include <cmath>
#include <numbers>

namespace petzval {
namespace {

constexpr double planck_js = 6.62607015e-34, light_speed_m_per_s = 299792458;

Sensor monochrome() {
  Sensor sensor;
  sensor.name = "monochrome";
  sensor.geometry = {24, 18, 200};
  sensor.electronics.emplace();
  sensor.electronics->channels = {{"white", Spectrum({380, 480, 1000}, {0.3, 0.7, 0.1})}};
  sensor.electronics->mosaic = {1, 1, {0}};
  return sensor;
}

/// g_sensor on the axis [sr], linear between wavelengths.
Spectrum cone(const Lens& lens, std::vector<double> nm) {
  FieldTableRequest at = FieldTableRequest::of(lens);
  at.fields = {0}, at.wavelengths_nm = nm;
  std::vector<double> values;
  for (const IlluminationRow& row : illumination_table(lens, at)) values.push_back(row.g_sensor_sr);
  return Spectrum(std::move(nm), std::move(values));
}

/// Electrons per second in the middle of a white wall, under `power_w_m2` of the light on it between two
/// wavelengths.
double by_hand(const Camera& camera, const Spectrum& light, double level, double from_nm, double to_nm) {
  const Spectrum sr = cone(camera.lens, {from_nm, (from_nm + to_nm) / 2, to_nm});
  const Spectrum& efficiency = camera.sensor->electronics->channels[0].quantum_efficiency;
  const double side_m = camera.sensor->geometry.pitch_um * 1e-6;
  double sum = 0;
  constexpr double step_nm = 0.001;
  for (double nm = from_nm + step_nm / 2; nm < to_nm; nm += step_nm)
    sum += step_nm * level * light.at(nm) / std::numbers::pi * sr.at(nm) * efficiency.at(nm) * nm * 1e-9;
  return sum * side_m * side_m / (planck_js * light_speed_m_per_s);
}

double simulated(const Camera& camera, SceneOptions options) {
  options.columns = 24, options.rows = 18;
  options.horizontal_angle_deg = 30;
  ImageOptions image_options;
  image_options.imaging.method = BlurMethod::none;
  const SpectralImage light = image({"wall", options}, camera, image_options);
  return photo_current(light, *camera.sensor).e_per_s[9 * 24 + 12];
}

Camera camera() {
  Camera camera;
  camera.lens = read_lens("dgauss-50mm").lens;
  camera.sensor = monochrome();
  camera.focus = Focus::infinity();
  return camera;
}

TEST(Illuminance, BecomesElectronsAsByHand) {
  struct Case {
    const char* light;
    std::vector<double> bands_nm;
    double from_nm, to_nm;
  };
  const Case cases[] = {{"532nm", {532}, 531.9, 532.1},
                        {"532nm", {510, 540, 560}, 531.9, 532.1},
                        {"550nm/30", {550}, 490, 610},
                        {"550nm/30", {530, 550, 570}, 490, 610},
                        {"LED-B3", default_bands_nm(), 400, 700},
                        {"F11", default_bands_nm(), 400, 700},
                        {"D65", {400, 475, 550, 625, 700}, 400, 700}};
  for (const Case& each : cases) {
    SceneOptions options;
    options.illuminant = each.light;
    options.wavelengths_nm = each.bands_nm;
    options.illuminance_lx = 500;
    const Spectrum light = illuminant(each.light);
    const double level = 500 / luminance(light);
    EXPECT_NEAR(simulated(camera(), options) / by_hand(camera(), light, level, each.from_nm, each.to_nm), 1,
                5e-3)
        << each.light << ", bands: " << each.bands_nm.size();
  }
}

TEST(Illuminance, OfLightThatNoEyeSeesIsInWatts) {
  for (const auto& bands : {std::vector<double>{850}, {820, 835, 850, 865, 880}}) {
    SceneOptions options;
    options.illuminant = "LED-850";
    options.wavelengths_nm = bands;
    options.irradiance_w_m2 = 5;
    const Spectrum light = illuminant(options.illuminant);
    const double level = 5 / light.integral(700, 1000);
    EXPECT_NEAR(simulated(camera(), options) / by_hand(camera(), light, level, 761, 939), 1, 5e-3);
    options.irradiance_w_m2.reset();
    EXPECT_NEAR(simulated(camera(), options) / by_hand(camera(), light, level / 5, 761, 939), 1, 5e-3)
        << "1 W/m2 unless told";
    options.illuminance_lx = 500;
    EXPECT_THROW(simulated(camera(), options), InputError);
  }
}

}  // namespace
}  // namespace petzval
