// SPDX-License-Identifier: BSD-3-Clause
// Spectral files before the bench, and the finest pictures.
#include <petzval/base/data_directory.h>
#include <petzval/live/bench_scene.h>
#include <petzval/live/bench_sensor.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <sstream>

#include "../scratch.h"
#include "live_page.h"

namespace petzval {
namespace {

using test::bench_state;
using test::json;
using test::LivePage;
using test::RunningServer;

/// A sensor of few pixels, whose finest picture is soon there.
std::string few_pixels(const std::string& path) {
  json sensor = json::parse(std::ifstream(data_directory() + "/sensors/third-inch-1280x960.json"));
  constexpr int larger = 8;
  for (const char* key : {"columns", "rows"}) sensor[key] = sensor[key].get<int>() / larger;
  sensor["pitch_um"] = sensor["pitch_um"].get<double>() * larger;
  std::ofstream(path) << sensor;
  return path;
}

json state_before(const std::string& scene) {
  json state = bench_state(1);
  state["scene"] = scene;
  state["sensor"] = "few";
  state["picture"] = true;
  state["plots"] = json::array();
  return state;
}

struct FewPixels {
  test::Scratch scratch;
  RunningServer server{[this](LiveOptions& options) {
    options.start.sensor_files["few"] = few_pixels(scratch.path("few.json"));
  }};
};

/// Reflectances of 8 × 6 samples in bytes, one in all samples of a band.
std::string plain_cube(const std::vector<int>& bands) {
  std::string numbers;
  for (const int value : bands) numbers.append(48, static_cast<char>(value));
  return numbers;
}
constexpr const char* red_header =
    "ENVI\nsamples = 8\nlines = 6\nbands = 4\ndata type = 1\ninterleave = bsq\n"
    "wavelength = {420, 500, 600, 680}\nreflectance scale factor = 255\n";

TEST(BenchScene, ShowsASpectralFileInItsColoursToItsLastBand) {
  FewPixels few;
  LivePage page(*few.server);
  page.upload("paint.hdr", red_header, "paint.raw", plain_cube({10, 10, 200, 200}));
  const json scenes = page.next();
  ASSERT_EQ(scenes["kind"], "scenes") << scenes;
  json state = state_before(scenes["scene"]);
  state["shot"]["compensation_ev"] = -2;  // no channel is full
  page.send(state);
  const json preview = page.next("picture");
  EXPECT_EQ(preview["quality"], "preview");
  // A reflectance that rises from 500 to 600 nm is orange.
  const auto level = [&](std::size_t channel) {
    const std::size_t columns = preview["columns"], rows = preview["rows"];
    return static_cast<unsigned char>(page.bytes[4 * (rows / 2 * columns + columns / 2) + channel]);
  };
  EXPECT_GT(level(0), level(1) + 20);
  EXPECT_GT(level(1), level(2) + 20);
  EXPECT_EQ(page.next("picture")["quality"], "full");
  const json finest = page.next("picture");
  EXPECT_EQ(finest["quality"], "finest");
  EXPECT_EQ(finest["wavelengths"], "420:10:680");
  EXPECT_EQ(finest["columns"], 160);
}

TEST(BenchScene, RefusesDamagedSpectraInOneLineAndGoesOn) {
  RunningServer server;
  LivePage page(*server);
  const std::string open = "ENVI\nsamples = 8\nlines = 6\nbands = 1\ndata type = 1\nwavelength = {550}\n";
  const std::vector<std::array<std::string, 4>> files{
      {"short.hdr", red_header, "short.raw", "few"},
      {"alone.hdr", red_header, "", ""},
      {"open.hdr", open, "open.raw", std::string(48, '\1')},
      {"a.exr", "\x76\x2f\x31\x01\x02", "", ""},
      {"a.mat", std::string(200, 'M'), "", ""},
      {"a.npy", "\x93NUMPY\x01", "", ""},
      {"huge.hdr",
       "ENVI\nsamples = 800000\nlines = 600000\nbands = 1\ndata type = 1\nreflectance scale factor = 1\n"
       "wavelength = {550}\n",
       "huge.raw", "x"}};
  for (const auto& [name, bytes, companion, companion_bytes] : files) {
    page.upload(name, bytes, companion, companion_bytes);
    const json problem = page.next();
    EXPECT_EQ(problem["kind"], "problem") << name;
    const std::string text = problem["text"];
    EXPECT_TRUE(text.starts_with(name.substr(0, name.find('.')) + '.')) << text;
    EXPECT_EQ(text.find("tmp/"), text.npos) << text;
    EXPECT_EQ(text.find('\n'), text.npos) << text;
    EXPECT_EQ(text.find('`'), text.npos) << text;
  }
  page.send(bench_state(9));
  EXPECT_EQ(page.next("layout")["id"], 9);
}

TEST(BenchScene, KeepsNoMoreFilesThanItSays) {
  RunningServer server;
  LivePage page(*server);
  for (int i = 0; i < 16; ++i) {
    page.upload("paint.hdr", red_header, "paint.raw", plain_cube({10, 10, 200, 200}));
    EXPECT_EQ(page.next()["kind"], "scenes");
  }
  page.upload("paint.hdr", red_header, "paint.raw", plain_cube({10, 10, 200, 200}));
  EXPECT_EQ(page.next()["kind"], "problem");
}

TEST(BenchScene, TakesBandsThatTheFileHas) {
  const std::vector<double> liked{460, 540, 610};
  EXPECT_EQ((BenchScene{.path = "studio"}.wavelengths_nm(liked)), liked);
  EXPECT_EQ((BenchScene{.file_bands_nm = {400, 500, 700}}.wavelengths_nm(liked)), liked);
  EXPECT_EQ((BenchScene{.file_bands_nm = {500, 600}}.wavelengths_nm(liked)),
            (std::vector<double>{500, 540, 600}));
  EXPECT_EQ((BenchScene{.file_bands_nm = {800, 850, 900, 950, 1000}}.wavelengths_nm(liked)),
            (std::vector<double>{800, 900, 1000}));
  EXPECT_EQ((BenchScene{.file_bands_nm = {850}}.wavelengths_nm(liked)), std::vector<double>{850});
}

TEST(BenchScene, ShowsInfraredByItsOwnBands) {
  FewPixels few;
  LivePage page(*few.server);
  std::string header = red_header;
  header.replace(header.find("420, 500, 600, 680"), 18, "820, 850, 900, 940");
  page.upload("night.hdr", header, "night.img", plain_cube({100, 100, 100, 100}));
  const json scenes = page.next();
  ASSERT_EQ(scenes["kind"], "scenes") << scenes;
  page.send(state_before(scenes["scene"]));
  EXPECT_EQ(page.next("picture")["wavelengths"], "820,850,940");
}

TEST(BenchPicture, EndsWithAllPixelsAndBandsUnlessSomethingNewerComes) {
  FewPixels few;
  LivePage page(*few.server);
  page.send(state_before("slanted-edge"));
  EXPECT_EQ(page.next("picture")["quality"], "preview");
  const json full = page.next("picture");
  EXPECT_EQ(full["quality"], "full");
  EXPECT_EQ(full["bands"], 16);
  const json finest = page.next("picture");
  EXPECT_EQ(finest["quality"], "finest");
  EXPECT_EQ(finest["bands"], 31);
  EXPECT_EQ(finest["whole"], (json{160, 120}));
  EXPECT_EQ(page.next("idle")["id"], 1);

  json older = state_before("studio");
  older["id"] = 2;
  older["sensor"] = "full-frame-24mp";
  page.send(older);
  EXPECT_EQ(page.next("picture")["quality"], "preview");
  EXPECT_EQ(page.next("picture")["quality"], "full");
  // Now the finest is under way, for many seconds.
  page.send(bench_state(3));
  for (json message = page.next(); message["kind"] != "idle"; message = page.next())
    EXPECT_FALSE(message["kind"] == "picture" && message["id"] == 2) << message["quality"];
}

TEST(BenchRender, EndsWithAllPixelsAndBandsOnceTheyAreAsQuiet) {
  FewPixels few;
  LivePage page(*few.server);
  json state = state_before("spheres");
  state["camera"]["focus"] = "1m";
  page.send(state);
  json full;
  std::array<double, 3> of_full{}, of_finest{};
  const auto mean_colour = [&] {
    std::array<double, 3> mean{};
    for (std::size_t i = 0; i < page.bytes.size(); ++i)
      if (i % 4 < 3)
        mean[i % 4] +=
            4.0 / static_cast<double>(page.bytes.size()) * static_cast<unsigned char>(page.bytes[i]);
    return mean;
  };
  json finest = page.next("picture");
  EXPECT_EQ(finest["quality"], "preview");
  while (finest["quality"] != "finest") {
    finest = page.next("picture");
    if (!full.is_null()) {
      // Both have as many pixels: with fewer rays the picture would be noisier than the full one.
      EXPECT_GE(finest["samples"], full["samples"]);
    }
    if (finest["quality"] == "full") full = finest, of_full = mean_colour();
  }
  of_finest = mean_colour();
  EXPECT_EQ(full["bands"], 8);
  EXPECT_EQ(full["samples"], 128);
  EXPECT_EQ(finest["bands"], 31);
  EXPECT_EQ(finest["samples"], 128);
  EXPECT_EQ(finest["columns"], 160);
  EXPECT_EQ(page.next("idle")["id"], 1);
  // The same scene in the same light, in 8 bands and in 31: a few levels of 255.
  for (std::size_t channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(of_finest[channel], of_full[channel], 5) << channel;
}

TEST(BinnedSensor, HasAtMostSoManyPixels) {
  // 6000 × 4000: 3 × 3 of them are 2.7 million pixels, 4 × 4 are 1.5 million.
  EXPECT_EQ(columns_for_pixels("full-frame-24mp", 1.6e6), 1500);
  EXPECT_EQ(columns_for_pixels("third-inch-1280x960", 1.6e6), 1280);
  const BinnedSensor binned = binned_sensor("full-frame-24mp", columns_for_pixels("full-frame-24mp", 1.6e6));
  EXPECT_EQ(binned.pixels_added, 4);
  EXPECT_EQ(binned.whole_columns, 6000);
}

}  // namespace
}  // namespace petzval
