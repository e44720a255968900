// SPDX-License-Identifier: BSD-3-Clause
// What a page is shown.
#include <petzval/analysis/spot_diagram.h>
#include <petzval/lens/first_order.h>
#include <petzval/live/bench_json.h>
#include <petzval/live/bench_psf.h>
#include <petzval/live/bench_sensor.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "live_page.h"

namespace petzval {
namespace {

using test::bench_state;
using test::json;
using test::LivePage;
using test::RunningServer;

TEST(Bench, ShowsWhatIsOnIt) {
  RunningServer server;
  LivePage page(*server);
  page.send(bench_state(3));
  const json layout = page.next("layout");
  EXPECT_EQ(layout["id"], 3);
  // The focal length in the name of the lens; its designer rounded to half a millimetre.
  EXPECT_NEAR(layout["first_order"]["efl_mm"].get<double>(), 50, 0.5);
  EXPECT_TRUE(layout["blocked"].empty());
  // Point spread and plot are worked out side by side: either may come first.
  std::set<std::string> seen;
  while (seen.size() < 2) {
    const json message = page.next();
    if (message["kind"] == "psf") {
      const std::size_t size = message["size"];
      EXPECT_EQ(page.bytes.size(), size * size * 3 * sizeof(float));
    } else if (message["kind"] == "plots") {
      EXPECT_EQ(message["analysis"], "distortion");
    } else {
      continue;
    }
    seen.insert(message["kind"]);
  }
  EXPECT_EQ(page.next("idle")["id"], 3);
}

TEST(Bench, ShowsThePreviewBeforeThePicture) {
  RunningServer server;
  LivePage page(*server);
  json state = bench_state(4);
  state["picture"] = true;
  page.send(state);
  const json preview = page.next("picture");
  EXPECT_EQ(preview["quality"], "preview");
  EXPECT_EQ(page.bytes.size(),
            4 * preview["columns"].get<std::size_t>() * preview["rows"].get<std::size_t>());
  const json full = page.next("picture");
  EXPECT_EQ(full["quality"], "full");
  EXPECT_GT(full["columns"], preview["columns"]);
  // The light half of the chart is lighter, in both: left 0.2, right 0.8 of the light.
  const auto level = [&](std::size_t column) {
    const std::size_t columns = full["columns"], row = full["rows"].get<std::size_t>() / 2;
    return static_cast<unsigned char>(page.bytes[4 * (row * columns + column) + 1]);
  };
  EXPECT_GT(level(full["columns"].get<std::size_t>() * 3 / 4),
            level(full["columns"].get<std::size_t>() / 4) + 50);
}

TEST(Bench, SmoothsTheMtfWhenTheHandRests) {
  RunningServer server;
  LivePage page(*server);
  json state = bench_state(5);
  state["picture"] = true;
  state["plots"] = json::array({"mtf"});
  page.send(state);
  const auto plots_until_idle = [&page] {
    std::vector<json> all;
    for (json message = page.next(); message["kind"] != "idle"; message = page.next())
      if (message["kind"] == "plots") all.push_back(message["plots"][0]["series"][0]);
    return all;
  };
  const std::vector<json> shown = plots_until_idle();
  ASSERT_FALSE(shown.empty());
  const json& smooth = shown.back();
  EXPECT_EQ(smooth["x"].size(), 41u);  // every 2.5 of 100 cycles/mm
  // The rough curve's points lie on the smooth one, if the machine was quick enough to draw it.
  for (std::size_t i = 0; shown.size() > 1 && i < shown[0]["x"].size(); ++i) {
    const auto at = static_cast<std::size_t>(shown[0]["x"][i].get<double>() / 2.5);
    EXPECT_NEAR(shown[0]["y"][i].get<double>(), smooth["y"][at].get<double>(), 1e-6) << i;
  }
  state["id"] = 6;
  page.send(state);
  EXPECT_TRUE(plots_until_idle().empty()) << "it stands already";
}

TEST(Bench, PutsTheSunWhereItsAnglesSayAndFollowsOneGhost) {
  RunningServer server;
  LivePage page(*server);
  const double right_deg = -2.5, up_deg = 1.5, degree = std::numbers::pi / 180;
  json state = bench_state(5);
  state["picture"] = true;
  state["stray"]["suns"] = json::array({{{"deg", {right_deg, up_deg}}, {"lx", 100000}}});
  state["stray"]["ghosts"] = true;
  state["stray"]["ghost"] = {2, 0};
  page.send(state);
  const json layout = page.next("layout"), stray = page.next("stray");
  const double efl_mm = layout["first_order"]["efl_mm"];
  // An achromat has no distortion to speak of: f tan θ.
  const json& near = stray["sky"][2];
  EXPECT_NEAR(near[1].get<double>(), efl_mm * near[0].get<double>(), 2e-3 * near[1].get<double>());
  for (std::size_t i = 1; i < stray["ghosts"].size(); ++i)
    EXPECT_LE(stray["ghosts"][i]["relative_irradiance"], stray["ghosts"][i - 1]["relative_irradiance"]);
  EXPECT_EQ(stray["ghosts"].size(), 3u) << "pairs of three surfaces";
  const json& rays = stray["way"];
  ASSERT_FALSE(rays.empty());
  for (const json& ray : rays) {
    const auto z = [&](std::size_t point) { return ray[2 * point].get<double>(); };
    const std::size_t points = ray.size() / 2;
    int turns = 0;
    for (std::size_t i = 2; i < points; ++i) turns += (z(i) > z(i - 1)) != (z(i - 1) > z(i - 2));
    EXPECT_EQ(turns, 2) << "it is reflected twice";
    EXPECT_NEAR(z(points - 1), layout["image_z"].get<double>(), 1e-5);
  }
  const json preview = page.next("picture");
  const double pitch_mm = preview["pitch_um"].get<double>() / 1000;
  const std::size_t columns = preview["columns"], rows = preview["rows"];
  const auto level = [&](double x_mm, double y_mm) {
    const auto column = static_cast<std::size_t>(static_cast<double>(columns) / 2 + x_mm / pitch_mm),
               row = static_cast<std::size_t>(static_cast<double>(rows) / 2 - y_mm / pitch_mm);
    return static_cast<unsigned char>(page.bytes[4 * (row * columns + column) + 1]);
  };
  const double x_mm = efl_mm * std::tan(right_deg * degree), y_mm = efl_mm * std::tan(up_deg * degree);
  EXPECT_EQ(level(x_mm, y_mm), 255) << "the sun";
  // The other three quarters have none; the left half of the chart is dark.
  EXPECT_LT(level(x_mm, -y_mm), 200);
  EXPECT_LT(level(-x_mm, y_mm), 255);
}

TEST(Bench, FocusesOnAPlaceOfThePicture) {
  RunningServer server;
  LivePage page(*server);
  const json state = bench_state(1);
  page.send(state);
  page.next("idle");
  const double x_mm = 1.5, y_mm = 1, height_mm = std::hypot(x_mm, y_mm);
  page.send(json{{"kind", "focus"}, {"id", 2}, {"place_mm", {x_mm, y_mm}}});
  const double shift_mm = page.next("focused")["shift_mm"];
  // Spots of a sensor that is moved by hand are larger on both sides.
  const Lens lens = read_lens("achromat-50mm").lens;
  const auto spot_um = [&](double at_mm) {
    Lens moved = lens;
    moved.surfaces.back().thickness_mm += at_mm;
    const FieldTableRequest at{.field_kind = Fields::Kind::real_image_height_mm,
                               .fields = {height_mm},
                               .wavelengths_nm = {lens.reference_wavelength_nm}};
    const SpotDiagram spot = spot_diagrams(moved, at, 24).front();
    const auto count = static_cast<double>(spot.y_um.size());
    double x = 0, y = 0, square = 0;
    for (std::size_t i = 0; i < spot.y_um.size(); ++i) x += spot.x_um[i] / count, y += spot.y_um[i] / count;
    for (std::size_t i = 0; i < spot.y_um.size(); ++i)
      square += std::pow(spot.x_um[i] - x, 2) + std::pow(spot.y_um[i] - y, 2);
    return std::sqrt(square / count);
  };
  const double best = spot_um(shift_mm);
  for (const double step_mm : {0.1, 0.2}) {
    EXPECT_GT(spot_um(shift_mm + step_mm), best);
    EXPECT_GT(spot_um(shift_mm - step_mm), best);
  }
}

/// What a quarter wave of 1.38 at 550 nm on glass leaves, by the sum of its two waves (Airy).
double reflected_by_film(double index, double wavelength_nm) {
  const double film = 1.38, phase = std::numbers::pi * 550 / wavelength_nm;
  const double r1 = (1 - film) / (1 + film), r2 = (film - index) / (film + index);
  const double cross = 2 * r1 * r2 * std::cos(phase);
  return (r1 * r1 + r2 * r2 + cross) / (1 + r1 * r1 * r2 * r2 + cross);
}

double reflected_by_glass(double index) {
  return std::pow((index - 1) / (index + 1), 2);
}

TEST(Bench, GhostsOfACoatedLensAreThoseOfItsFilms) {
  RunningServer server;
  LivePage page(*server);
  json state = bench_state(1);
  state["stray"]["ghost"] = {2, 0};
  const auto light_of_2_0 = [&] {
    page.send(state);
    const json stray = page.next("stray");
    for (const json& ghost : stray["ghosts"])
      if (ghost["first"] == 2 && ghost["second"] == 0) return ghost["relative_irradiance"].get<double>();
    return 0.0;
  };
  const double bare = light_of_2_0();
  state["coatings"] = {"mgf2", nullptr, "mgf2"};
  const double coated = light_of_2_0();
  const Lens lens = read_lens("achromat-50mm").lens;
  const double nm = lens.reference_wavelength_nm, front = lens.surfaces[0].material.index(nm),
               back = lens.surfaces[1].material.index(nm);
  EXPECT_NEAR(coated / bare,
              reflected_by_film(front, nm) * reflected_by_film(back, nm) /
                  (reflected_by_glass(front) * reflected_by_glass(back)),
              1e-9);
}

/// The mean level of a picture.
double mean_level(const std::string& rgba) {
  double sum = 0;
  for (std::size_t i = 0; i < rgba.size(); i += 4) sum += static_cast<unsigned char>(rgba[i + 1]);
  return 4 * sum / static_cast<double>(rgba.size());
}

TEST(Bench, FindsTheSourcesOfAScene) {
  RunningServer server;
  LivePage page(*server);
  json state = bench_state(1);
  state["scene"] = "points";  // 9 x 9 white samples on black
  state["picture"] = true;
  state["shot"]["noise"] = false;
  state["shot"]["exposure"] = "1";
  state["shot"]["compensation_ev"] = 4;
  const auto preview = [&] {
    page.send(state);
    return page.next("picture");
  };
  EXPECT_TRUE(preview()["sources"].empty()) << "they make nothing";
  const double without = mean_level(page.bytes);
  state["stray"]["ghosts"] = true;
  const json picture = preview();
  EXPECT_GT(mean_level(page.bytes), without);
  ASSERT_EQ(picture["sources"].size(), 16u) << "the brightest are taken";
  // On a lattice of 9 across a chart that is at least as wide as the frame; an achromat does not distort.
  const double width_mm = picture["columns"].get<double>() * picture["pitch_um"].get<double>() / 1000;
  double step_mm = INFINITY;
  for (const json& source : picture["sources"])
    if (const double x_mm = std::abs(source["x_mm"].get<double>()); x_mm > width_mm / 18)
      step_mm = std::min(step_mm, x_mm);
  EXPECT_GE(step_mm, width_mm / 9);
  EXPECT_LT(step_mm, 2 * width_mm / 9);
  for (const json& source : picture["sources"]) {
    const double steps = source["x_mm"].get<double>() / step_mm;
    // Samples are whole: half of one is this part of a step, of the source and for each step.
    const double half_sample = 0.5 * 9 / picture["scene_columns"].get<double>();
    EXPECT_NEAR(steps, std::round(steps), half_sample * (1 + std::abs(steps)) + 1e-3);
  }
  state["stray"]["threshold"] = 1e6;
  EXPECT_TRUE(preview()["sources"].empty()) << "no sample is a million times the mean of 320 x 240";
  EXPECT_NEAR(mean_level(page.bytes), without, 1e-9);
}

TEST(Bench, FocusesOnWhatASceneOfThreeDimensionsShows) {
  RunningServer server;
  LivePage page(*server);
  json state = bench_state(1);
  state["scene"] = "spheres";
  state["camera"]["focus"] = "1m";
  state["picture"] = true;
  page.send(state);
  const json preview = page.next("picture");
  EXPECT_EQ(preview["quality"], "preview");
  EXPECT_EQ(preview["samples"], 4);
  page.send(json{{"kind", "focus"}, {"id", 2}, {"place_mm", {0, 0}}});
  const double found_m = page.next("focused")["distance_m"];
  // The camera's axis, from (0, 0.34, -1.2) to (0, 0.1, 0), meets the ball of glass about (0.03, 0.09, -0.3).
  const double length = std::hypot(0.24, 1.2), up = -0.24 / length, deep = 1.2 / length;
  const double along = -0.25 * up + 0.9 * deep,
               square = 0.03 * 0.03 + 0.25 * 0.25 + 0.9 * 0.9 - along * along, radius = 0.09;
  const double half_chord = std::sqrt(radius * radius - square);
  // A pixel is this wide there, and the ball slopes so much.
  const double pixel_m = preview["pitch_um"].get<double>() * 1e-6 / 0.05 * along;
  EXPECT_NEAR(found_m, along - half_chord, std::numbers::sqrt2 * pixel_m * std::sqrt(square) / half_chord);
}

TEST(Bench, BladesTakeTheirShareOfTheLight) {
  RunningServer server;
  LivePage page(*server);
  json state = bench_state(1);
  state["scene"] = "wall";
  state["camera"]["f_number"] = 8;
  state["picture"] = true;
  const auto exposure_s = [&](const json& blades) {
    state["camera"]["blades"] = blades;
    page.send(state);
    return std::stod(page.next("picture")["exposure"].get<std::string>());
  };
  // A triangle in the circle of the stop, by its area.
  const double triangle = 3 / (2 * std::numbers::pi) * std::sin(2 * std::numbers::pi / 3);
  EXPECT_NEAR(exposure_s(0) / exposure_s(3), triangle, 0.05 * triangle);
}

TEST(Bench, ShowsTwoPagesTheirOwn) {
  RunningServer server;
  LivePage first(*server), second(*server);
  first.send(bench_state(11));
  second.send(bench_state(12, "tessar"));
  const json tessar = second.next("layout"), achromat = first.next("layout");
  EXPECT_EQ(achromat["id"], 11);
  EXPECT_EQ(tessar["id"], 12);
  EXPECT_EQ(achromat["surfaces"].size(), read_lens("achromat-50mm").lens.surfaces.size());
  EXPECT_EQ(tessar["surfaces"].size(), read_lens("tessar").lens.surfaces.size());
}

TEST(Bench, SaysWhichSurfaceIsInTheWayAndGoesOn) {
  RunningServer server;
  LivePage page(*server);
  json broken = bench_state(1);
  // At f/200 the beam is a quarter of a millimetre wide, and 7.5 mm of glass behind the stop, at 4 degrees,
  // it is more than its radius from the axis: a pinhole there stops all of it.
  broken["camera"]["f_number"] = 200;
  broken["lens"]["surfaces"][2]["semi_diameter_mm"] = 0.001;
  page.send(broken);
  const json layout = page.next("layout");
  ASSERT_FALSE(layout["blocked"].empty());
  EXPECT_EQ(layout["blocked"][0]["surface"], 2);
  page.send(bench_state(2));
  EXPECT_TRUE(page.next("layout")["blocked"].empty());
}

TEST(Bench, TellsAFaultOfTheLensAsOne) {
  RunningServer server;
  LivePage page(*server);
  json faulty = bench_state(5);
  faulty["lens"]["surfaces"][1]["glass"] = "SCHOTT:N-BK8";
  page.send(faulty);
  const json problem = page.next();
  EXPECT_EQ(problem["kind"], "problem");
  EXPECT_EQ(problem["stage"], "lens");
  EXPECT_EQ(problem["id"], 5);
  EXPECT_NE(problem["text"].get<std::string>().find("surfaces[1]"), std::string::npos) << problem["text"];
  page.send(bench_state(6));
  EXPECT_EQ(page.next("layout")["id"], 6);
}

TEST(Bench, TakesGoodFilesAndRefusesDamagedOnes) {
  RunningServer server;
  LivePage page(*server);
  page.upload("my lens.json", lens_to_json(read_lens("tessar").lens));
  const json lens = page.next();
  EXPECT_EQ(lens["kind"], "lens");
  EXPECT_EQ(lens["name"], "my lens");
  EXPECT_EQ(lens_to_json(lens_from_json(lens["lens"].dump(), "test")),
            lens_to_json(read_lens("tessar").lens));
  for (const auto& [name, bytes] : std::map<std::string, std::string>{{"a.zmx", "SURF 0\n  CURV x\n"},
                                                                      {"b.json", "{"},
                                                                      {"c.png", "\x89PNG\r\n"},
                                                                      {"d.jpg", "\xFF\xD8\xFF"},
                                                                      {"e.tif", "II*"}}) {
    page.upload(name, bytes);
    const json problem = page.next();
    EXPECT_EQ(problem["kind"], "problem") << name;
    EXPECT_EQ(problem["stage"], "upload");
    EXPECT_EQ(problem["text"].get<std::string>().find("/tmp/"), std::string::npos) << problem["text"];
  }
  for (const char* name : {"a.exe", "a", "", ".json/../../x", "/etc/passwd", "a.pbrt"}) {
    page.upload(name, "x");
    EXPECT_EQ(page.next()["kind"], "refused") << name;
  }
}

TEST(Bench, SavesTheLensItShows) {
  RunningServer server;
  LivePage page(*server);
  json state = bench_state(1);
  state["lens"]["surfaces"][0]["thickness_mm"] = 7.25;
  page.send(state);
  page.next("idle");
  page.send(json{{"kind", "save"}, {"id", 2}, {"extension", ".json"}});
  page.next("file");
  EXPECT_EQ(lens_from_json(page.bytes, "saved").surfaces[0].thickness_mm, 7.25);
  page.send(json{{"kind", "save"}, {"id", 3}, {"extension", ".png"}});
  EXPECT_EQ(page.next("problem")["stage"], "save") << "no picture was asked for";
}

TEST(Bench, FindsGlassesByNameAndByNumbers) {
  EXPECT_EQ(glasses_json("nbk7")[0]["name"], "SCHOTT:N-BK7");
  // N-BK7 is sold as 517642: nd 1.51680, Vd 64.17 (its data sheet).
  const json near = glasses_json("1.5168 64.17");
  bool found = false;
  for (std::size_t i = 0; i < 5; ++i) found = found || near[i]["name"] == "SCHOTT:N-BK7";
  EXPECT_TRUE(found) << near.dump();
  EXPECT_LE(glasses_json("n").size(), 40u);
  EXPECT_TRUE(glasses_json("no such glass").empty());
}

TEST(BenchPsf, PointsItsComaAwayFromTheAxisOrToIt) {
  const Lens lens = read_lens("coma-singlet").lens;
  const double field = lens.fields.values.back();
  FieldTableRequest at{.fields = {field}, .wavelengths_nm = {lens.reference_wavelength_nm}};
  const SpotDiagram spot = spot_diagrams(lens, at, 8).front();
  // Rays say to which side of the chief ray the light lies; the image height may have either sign.
  const double outward_um = std::accumulate(spot.y_um.begin(), spot.y_um.end(), 0.0) /
                            static_cast<double>(spot.y_um.size()) * (spot.height_um < 0 ? -1 : 1);
  Lens single = lens;
  single.wavelengths_nm = {lens.reference_wavelength_nm};
  const double height_mm = std::abs(spot.height_um) / 1000;
  const BenchPsf psf = bench_psf({single, {}}, {0, height_mm}, {});
  double rows = 0, light = 0;
  for (int row = 0; row < psf.size; ++row)
    for (int column = 0; column < psf.size; ++column) {
      const double value = psf.rgb[3 * static_cast<std::size_t>(row * psf.size + column) + 1];
      rows += value * ((psf.size - 1) / 2.0 - row);
      light += value;
    }
  const double psf_um = rows / light * psf.spacing_um;
  EXPECT_GT(psf_um * outward_um, 0) << psf_um << " against " << outward_um;
  EXPECT_NEAR(light, psf.captured, 0.02);
}

TEST(BinnedSensor, KeepsFrameAndExposureAndAddsNoiseAsPixelsDo) {
  const Sensor whole = read_sensor("full-frame-24mp");
  const BinnedSensor binned = binned_sensor("full-frame-24mp", 640);
  ASSERT_EQ(binned.pixels_added, 10);  // 6000 / 640, rounded up
  EXPECT_NEAR(binned.sensor.geometry.width_mm(), whole.geometry.width_mm(),
              2 * binned.sensor.geometry.pitch_um * 1e-3);
  const GainMode& large = binned.sensor.electronics->gain_modes[0];
  const GainMode& small = whole.electronics->gain_modes[0];
  // A hundred times the area catches a hundred times the light, and is full after the same time.
  EXPECT_NEAR(large.full_well_e / small.full_well_e, 100, 1e-9);
  // The same number at the end of its range: electrons of a full pixel times the gain.
  EXPECT_NEAR(large.full_well_e * large.dn_per_e, small.full_well_e * small.dn_per_e, 1e-6);
  // A hundred independent readings add up as the root of their number.
  EXPECT_NEAR(large.read_noise_e / small.read_noise_e, std::sqrt(100.0), 1e-9);
  EXPECT_EQ(read_sensor("full-frame-24mp", binned.settings).geometry.columns, binned.sensor.geometry.columns);
}

TEST(BinnedSensor, LeavesASmallSensorAsItIs) {
  const BinnedSensor same = binned_sensor("third-inch-vga", 640);
  EXPECT_TRUE(same.settings.empty());
  EXPECT_EQ(same.pixels_added, 1);
}

}  // namespace
}  // namespace petzval
