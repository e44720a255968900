// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <libraw/libraw.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/colour/display.h>
#include <petzval/numeric/random.h>
#include <petzval/sensor/colour_calibration.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/sensor/formats/linear_dng.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <memory>

#include "flat_sensor.h"
#include "scratch.h"

namespace petzval {
namespace {

class Dng : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return scratch_.path(name); }

 private:
  const test::Scratch scratch_;
};

/// 60 x 44 random samples of a Bayer sensor with all facts of a camera.
RawImage example(const std::string& order = "RGGB") {
  const Sensor sensor = test::bayer_sensor(60, 44, order);
  RawImage raw;
  raw.columns = 60;
  raw.rows = 44;
  raw.mosaic = sensor.electronics->mosaic;
  raw.channels = sensor.electronics->channel_names();
  for (std::uint64_t i = 0; i < 60 * 44; ++i)
    raw.samples.push_back(static_cast<std::uint16_t>(RandomStream(3, 0, i).bits() % 4096));
  raw.black_level = 64;
  raw.white_level = 4095;
  raw.dn_per_e = 0.25;
  raw.read_noise_e = 3;
  raw.calibrations = standard_calibrations(sensor);
  raw.as_shot_neutral = {0.5, 1, 0.7};
  raw.exposure_s = 1.0 / 60;
  raw.iso = 200;
  raw.lens = {"Some Lens 35mm", 35, 2.8, 0};
  raw.sensor_name = "Some Sensor";
  return raw;
}

/// As they stand in a file.
std::string sample_bytes(const RawImage& raw) {
  return {reinterpret_cast<const char*>(raw.samples.data()), 2 * raw.samples.size()};
}

std::uint32_t number_at(const std::string& bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  return value;
}
std::string number_bytes(std::uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
  return bytes;
}
/// Where the entry of a tag stands in a directory, by the letter of TIFF 6.0; 0: there is none.
std::size_t entry_of(const std::string& bytes, std::size_t directory, std::uint32_t tag) {
  for (std::uint32_t i = 0; i < number_at(bytes, directory, 2); ++i)
    if (number_at(bytes, directory + 2 + 12 * i, 2) == tag) return directory + 2 + 12 * i;
  return 0;
}

std::unique_ptr<LibRaw> opened(const std::string& path) {
  auto libraw = std::make_unique<LibRaw>();
  EXPECT_EQ(libraw->open_file(path.c_str()), LIBRAW_SUCCESS);
  EXPECT_EQ(libraw->unpack(), LIBRAW_SUCCESS);
  return libraw;
}

TEST_F(Dng, LibRawSeesWhatWasWritten) {
  for (const std::string order : {"RGGB", "BGGR", "GRBG", "GBRG"}) {
    const RawImage raw = example(order);
    write_dng(path("a.dng"), raw);
    const auto libraw = opened(path("a.dng"));
    const auto& data = libraw->imgdata;
    ASSERT_EQ(data.sizes.raw_width, raw.columns);
    ASSERT_EQ(data.sizes.raw_height, raw.rows);
    ASSERT_NE(data.rawdata.raw_image, nullptr);
    for (int row = 0; row < raw.rows; ++row)
      for (int column = 0; column < raw.columns; ++column)
        ASSERT_EQ(data.rawdata.raw_image[row * static_cast<int>(data.sizes.raw_pitch / 2) + column],
                  raw.samples[static_cast<std::size_t>(row * raw.columns + column)])
            << row << ", " << column;
    // Colours of the mosaic by LibRaw's own reckoning; its second green is number 3.
    EXPECT_STREQ(data.idata.cdesc, "RGBG");
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        EXPECT_EQ("RGBG"[libraw->COLOR(row, column)],
                  order[static_cast<std::size_t>(row % 2 * 2 + column % 2)]);
    // A black level that all cells share is in `black`, or in the block that cblack[4], cblack[5] describe.
    const unsigned block = data.color.cblack[4] * data.color.cblack[5];
    EXPECT_EQ(data.color.black + (block > 0 ? data.color.cblack[6] : data.color.cblack[0]), 64u);
    EXPECT_EQ(data.color.maximum, 4095u);
  }
}

TEST_F(Dng, LibRawSeesTheCamera) {
  const RawImage raw = example();
  write_dng(path("a.dng"), raw);
  const auto libraw = opened(path("a.dng"));
  const auto& data = libraw->imgdata;
  EXPECT_STREQ(data.idata.make, "Petzval");
  EXPECT_NEAR(static_cast<double>(data.other.shutter), raw.exposure_s, 1e-7);  // a float
  EXPECT_NEAR(static_cast<double>(data.other.aperture), 2.8, 1e-6);
  EXPECT_NEAR(static_cast<double>(data.other.focal_len), 35, 1e-5);
  EXPECT_NEAR(static_cast<double>(data.other.iso_speed), 200, 1e-5);
  EXPECT_STREQ(data.lens.Lens, "Some Lens 35mm");
  EXPECT_NEAR(static_cast<double>(data.lens.MinFocal), 35, 1e-5);  // LensInfo
  EXPECT_NEAR(static_cast<double>(data.lens.MaxFocal), 35, 1e-5);
  EXPECT_NEAR(static_cast<double>(data.lens.MaxAp4MinFocal), 2.8, 1e-6);
  // White balance: multipliers are the inverse of the neutral.
  EXPECT_NEAR(static_cast<double>(data.color.cam_mul[0] / data.color.cam_mul[1]), 2, 1e-6);
  EXPECT_NEAR(static_cast<double>(data.color.cam_mul[2] / data.color.cam_mul[1]), 1 / 0.7, 1e-6);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(data.color.dng_color[i].illuminant, i == 0 ? 17 : 21);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(3 * r + c);
        const auto which = static_cast<std::size_t>(i);
        // Floats as fractions: 1e-6 of the greatest, about 2.
        EXPECT_NEAR(static_cast<double>(data.color.dng_color[i].colormatrix[r][c]),
                    raw.calibrations[which].camera_from_xyz[at], 2e-6);
        EXPECT_NEAR(static_cast<double>(data.color.dng_color[i].forwardmatrix[r][c]),
                    raw.calibrations[which].pcs_from_balanced[at], 2e-6);
      }
  }
}

// A preview in the first directory, the mosaic in one below it; LibRaw finds both. The grey of a mosaic that
// is even but for its white balance: sRGB of 0.25 is 137 of 255.
TEST_F(Dng, IsLaidOutAsByCameras) {
  RawImage raw = example();
  for (int row = 0; row < raw.rows; ++row)
    for (int column = 0; column < raw.columns; ++column) {
      const auto channel = static_cast<std::size_t>(raw.mosaic.channel(row, column));
      raw.samples[static_cast<std::size_t>(row * raw.columns + column)] =
          static_cast<std::uint16_t>(std::lround(64 + 0.25 * (4095 - 64) * raw.as_shot_neutral[channel]));
    }
  const std::string bytes = dng_bytes(raw, "a.dng");
  constexpr std::uint32_t kind = 254, photometric = 262, sub_directories = 330, opcode_list_3 = 51022;
  const std::size_t first = number_at(bytes, 4, 4);
  const auto value = [&](std::size_t directory, std::uint32_t tag) {
    return number_at(bytes, entry_of(bytes, directory, tag) + 8, 2);
  };
  EXPECT_EQ(value(first, kind), 1u);
  EXPECT_EQ(value(first, photometric), 2u);
  EXPECT_EQ(number_at(bytes, first + 2 + 12 * number_at(bytes, first, 2), 4), 0u) << "another page";
  const std::size_t below = number_at(bytes, entry_of(bytes, first, sub_directories) + 8, 4);
  EXPECT_EQ(value(below, kind), 0u);
  EXPECT_EQ(value(below, photometric), 32803u);
  EXPECT_EQ(entry_of(bytes, first, opcode_list_3), 0u);

  LibRaw libraw;
  ASSERT_EQ(libraw.open_buffer(const_cast<char*>(bytes.data()), bytes.size()), LIBRAW_SUCCESS);
  ASSERT_EQ(libraw.unpack_thumb(), LIBRAW_SUCCESS);
  const libraw_thumbnail_t& preview = libraw.imgdata.thumbnail;
  EXPECT_EQ(preview.twidth, 30);
  EXPECT_EQ(preview.theight, 22);
  const auto* samples = reinterpret_cast<const std::uint8_t*>(preview.thumb);
  for (int i = 0; i < 3 * 30 * 22; ++i) ASSERT_NEAR(samples[i], 137, 1) << i;
}

TEST_F(Dng, DateAndTimeAreThoseOfTheImage) {
  RawImage raw = example();
  EXPECT_FALSE(parse_dng(dng_bytes(raw, "a.dng"), "a.dng").date_time);
  raw.date_time = parse_date_time("2026-11-26 10:07:09.25");
  write_dng(path("a.dng"), raw);
  EXPECT_EQ(read_dng(path("a.dng")).date_time, raw.date_time);
  const std::time_t seen = opened(path("a.dng"))->imgdata.other.timestamp;  // by the computer's time zone
  const std::tm* clock = std::localtime(&seen);
  EXPECT_EQ(clock->tm_year, 126);
  EXPECT_EQ(clock->tm_mon, 10);
  EXPECT_EQ(clock->tm_mday, 26);
  EXPECT_EQ(clock->tm_hour, 10);
  EXPECT_EQ(clock->tm_min, 7);
  EXPECT_EQ(clock->tm_sec, 9);
}

TEST_F(Dng, DirectoriesThatLeadNowhereOrInCirclesAreRefused) {
  const std::string good = dng_bytes(example(), "a.dng");
  const std::size_t first = number_at(good, 4, 4);
  const std::size_t sub = entry_of(good, first, 330) + 8;
  const std::size_t exif = entry_of(good, first, 34665) + 8;
  const auto end = static_cast<std::uint32_t>(good.size());
  for (const auto& [at, places] :
       {std::pair{sub, std::vector<std::uint32_t>{0, 1, static_cast<std::uint32_t>(first), end - 1, end,
                                                  0xfffffff0}},
        std::pair{exif, std::vector<std::uint32_t>{1, end - 1, end, 0xfffffff0}}})
    for (const std::uint32_t place : places) {
      std::string bad = good;
      bad.replace(at, 4, number_bytes(place));
      EXPECT_THROW(parse_dng(bad, "a.dng"), InputError) << at << " " << place;
    }
  // A page that is its own next one is not looked at.
  std::string loop = good;
  loop.replace(first + 2 + 12 * number_at(good, first, 2), 4,
               number_bytes(static_cast<std::uint32_t>(first)));
  EXPECT_EQ(parse_dng(loop, "a.dng").samples, example().samples);
}

TEST_F(Dng, MergedExposuresKeepTheirElectrons) {
  RawImage raw = example();
  raw.shot_noise_share = 1 / std::sqrt(21);
  const RawImage back = parse_dng(dng_bytes(raw, "a.dng"), "a.dng");
  EXPECT_DOUBLE_EQ(back.shot_noise_share, raw.shot_noise_share);
  EXPECT_NEAR(back.dn_per_e, 0.25, 1e-12);
  EXPECT_NEAR(back.read_noise_e, 3, 1e-12);
  raw.shot_noise_share = 1.5;
  EXPECT_THROW(dng_bytes(raw, "a.dng"), InputError);
}

TEST_F(Dng, TablesOfAllSamplesComeBack) {
  // One entry more than libtiff counts: the greatest sample, which is white, keeps its value.
  RawImage raw = example();
  raw.white_level = 65535;
  for (int stored = 0; stored <= 65535; ++stored)
    raw.linearization.push_back(
        static_cast<std::uint16_t>(std::lround(stored * (0.9 + 0.1 * stored / 65535))));
  raw.samples[0] = 65535;
  raw.samples[1] = 65533;
  raw.samples[2] = 0;
  write_dng(path("t.dng"), raw);
  const RawImage back = read_dng(path("t.dng"));
  for (int row = 0; row < raw.rows; ++row)
    for (int column = 0; column < raw.columns; ++column)
      ASSERT_EQ(back.pixel(row, column), raw.pixel(row, column));
  EXPECT_EQ(back.pixel(0, 0), 65535);
}

TEST_F(Dng, BadPixelsAndWhatUndoesTheLensComeBack) {
  for (const std::string order : {"RGGB", "BGGR", "GRBG", "GBRG"}) {
    RawImage raw = example(order);
    raw.bad_pixels = {{0, 59}, {7, 3}, {43, 0}};
    raw.pitch_um = 3.75;
    raw.lens.warp = {1, -0.05, 0.004, -1e-5};
    raw.lens.vignetting = {0.1, 0.02, 0.003, 4e-4, 5e-5};
    const std::string bytes = dng_bytes(raw, "a.dng");
    const RawImage back = parse_dng(bytes, "a.dng");
    EXPECT_EQ(back.bad_pixels, raw.bad_pixels);
    EXPECT_EQ(back.lens.warp, raw.lens.warp);
    EXPECT_EQ(back.lens.vignetting, raw.lens.vignetting);
    EXPECT_NEAR(back.pitch_um, 3.75, 1e-6);
    raw.lens.fisheye_warp = {1.01, -0.2, 0.03, -0.004};
    raw.lens.warp.clear(), raw.lens.vignetting.clear();
    raw.lens.gain_map = {3, 2, {1, 1.25F, 2, 1, 1.5F, 3}};
    const RawImage other = parse_dng(dng_bytes(raw, "a.dng"), "a.dng");
    EXPECT_EQ(other.lens.fisheye_warp, raw.lens.fisheye_warp);
    EXPECT_EQ(other.lens.gain_map, raw.lens.gain_map);
    EXPECT_TRUE(other.lens.warp.empty());
    // FixBadPixelsList as DNG 1.4 prints it: its number, version 1.3, length 12 + 3 · 8, the phase of the
    // mosaic.
    const std::string phases[] = {"RGGB", "GRBG", "GBRG", "BGGR"};
    const auto phase = std::find(std::begin(phases), std::end(phases), order) - std::begin(phases);
    std::string opcode("\0\0\0\1\0\0\0\5\1\3\0\0\0\0\0\1\0\0\0\x24\0\0\0", 23);
    opcode += static_cast<char>(phase);
    EXPECT_NE(bytes.find(opcode), std::string::npos) << order;
  }
}

TEST_F(Dng, BadListsOfOpcodesAreRefused) {
  RawImage raw = example();
  raw.bad_pixels = {{7, 3}};
  const std::string good = dng_bytes(raw, "a.dng");
  const std::size_t at = good.find(std::string("\0\0\0\1\0\0\0\5\1\3\0\0", 12));
  ASSERT_NE(at, std::string::npos);
  // Two opcodes, a longer one, more points than there are, a row beyond the picture.
  for (const std::size_t byte : {3u, 19u, 27u, 35u}) {
    std::string bad = good;
    bad[at + byte] = 77;
    EXPECT_THROW(parse_dng(bad, "a.dng"), InputError) << byte;
  }
}

// A picture without a mosaic: what LibRaw makes of it in linear sRGB is the picture.
TEST_F(Dng, LibRawDevelopsALinearPictureToItself) {
  LinearPicture picture{40, 30, {}, {}, {}, ""};
  const ColourMatrix matrix = srgb_from_xyz();
  for (std::size_t i = 0; i < 9; ++i) picture.rgb_from_xyz[i] = matrix[i / 3][i % 3];
  for (std::uint64_t i = 0; i < 3 * 40 * 30; ++i)
    picture.samples.push_back(static_cast<std::uint16_t>(RandomStream(4, 0, i).bits() % 65536));
  picture.samples[0] = picture.samples[1] = picture.samples[2] = 65535;  // LibRaw stretches to the greatest
  write_linear_dng(path("l.dng"), picture);
  LibRaw libraw;
  auto& parameters = libraw.imgdata.params;
  parameters.use_camera_wb = 1, parameters.output_color = 1, parameters.output_bps = 16;
  parameters.no_auto_bright = 1, parameters.gamm[0] = parameters.gamm[1] = 1;
  ASSERT_EQ(libraw.open_file(path("l.dng").c_str()), LIBRAW_SUCCESS);
  ASSERT_EQ(libraw.unpack(), LIBRAW_SUCCESS);
  ASSERT_EQ(libraw.dcraw_process(), LIBRAW_SUCCESS);
  int error = 0;
  libraw_processed_image_t* made = libraw.dcraw_make_mem_image(&error);
  ASSERT_NE(made, nullptr);
  ASSERT_EQ(made->width, 40);
  ASSERT_EQ(made->height, 30);
  const auto* samples = reinterpret_cast<const std::uint16_t*>(made->data);
  // Its primaries have four digits: 2e-3 of white.
  for (std::size_t i = 0; i < picture.samples.size(); ++i)
    ASSERT_NEAR(samples[i], picture.samples[i], 0.002 * 65535) << i;
  LibRaw::dcraw_clear_mem(made);
  picture.samples.pop_back();
  EXPECT_THROW(write_linear_dng(path("l.dng"), picture), InputError);
}

TEST_F(Dng, ComesBack) {
  RawImage raw = example();
  raw.provenance = "how it came about";
  write_dng(path("a.dng"), raw);
  const RawImage back = read_dng(path("a.dng"));
  EXPECT_EQ(back.columns, raw.columns);
  EXPECT_EQ(back.rows, raw.rows);
  EXPECT_EQ(back.samples, raw.samples);
  EXPECT_EQ(back.mosaic, raw.mosaic);
  EXPECT_EQ(back.channels, raw.channels);
  EXPECT_EQ(back.black_level, 64);
  EXPECT_EQ(back.white_level, 4095);
  EXPECT_NEAR(back.dn_per_e, 0.25, 1e-12);
  EXPECT_NEAR(back.read_noise_e, 3, 1e-12);
  ASSERT_EQ(back.calibrations.size(), 2u);
  EXPECT_EQ(back.calibrations[1].exif_light_source, 21);
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_NEAR(back.calibrations[0].pcs_from_balanced[i], raw.calibrations[0].pcs_from_balanced[i], 2e-6);
  ASSERT_EQ(back.as_shot_neutral.size(), 3u);
  EXPECT_NEAR(back.as_shot_neutral[2], 0.7, 1e-6);
  EXPECT_NEAR(back.exposure_s, raw.exposure_s, 1e-9);  // a float
  EXPECT_EQ(back.iso, 200);
  EXPECT_NEAR(back.lens.focal_length_mm, 35, 1e-6);
  EXPECT_EQ(back.lens.name, raw.lens.name);
  EXPECT_EQ(back.sensor_name, raw.sensor_name);
  EXPECT_EQ(back.provenance, raw.provenance);
  write_dng(path("b.dng"), raw);
  EXPECT_EQ(read_whole_file(path("a.dng")), read_whole_file(path("b.dng")))
      << "the same image, the same bytes";
}

TEST_F(Dng, OtherMosaicsComeBack) {
  RawImage raw = example();
  raw.calibrations.clear();
  raw.as_shot_neutral.clear();
  raw.channels = {"red", "green", "blue", "white"};
  raw.mosaic = {2, 4, {3, 0, 3, 1, 1, 3, 2, 3}};
  write_dng(path("a.dng"), raw);
  EXPECT_EQ(read_dng(path("a.dng")).mosaic, raw.mosaic);
  EXPECT_EQ(read_dng(path("a.dng")).channels, raw.channels);

  raw.channels = {"grey"};
  raw.mosaic = {};
  write_dng(path("a.dng"), raw);
  EXPECT_EQ(read_dng(path("a.dng")).samples, raw.samples);
  EXPECT_EQ(read_dng(path("a.dng")).channels.size(), 1u);

  raw.channels = {"red", "infrared"};
  raw.mosaic = {1, 2, {0, 1}};
  EXPECT_THROW(write_dng(path("c.dng"), raw), InputError);
  EXPECT_FALSE(std::filesystem::exists(path("c.dng")));
}

TEST_F(Dng, LinearizationIsAppliedByLibRawAndByUs) {
  RawImage raw = example();
  for (int i = 0; i < 4096; ++i) raw.linearization.push_back(static_cast<std::uint16_t>(i * i / 300));
  raw.white_level = 4095 * 4095 / 300;
  write_dng(path("a.dng"), raw);
  const RawImage back = read_dng(path("a.dng"));
  const auto libraw = opened(path("a.dng"));
  for (int row = 0; row < raw.rows; ++row)
    for (int column = 0; column < raw.columns; ++column) {
      const int stored = raw.samples[static_cast<std::size_t>(row * raw.columns + column)];
      EXPECT_EQ(back.pixel(row, column), stored * stored / 300);
      EXPECT_EQ(libraw->imgdata.rawdata.raw_image[row * raw.columns + column], stored * stored / 300);
    }
}

TEST_F(Dng, ExiftoolFindsNothingWrong) {
  if (std::system("exiftool -ver >/dev/null 2>&1") != 0) GTEST_SKIP() << "exiftool is not installed";
  RawImage raw = example();
  raw.bad_pixels = {{7, 3}};
  raw.lens.fisheye_warp = {1.01, -0.2, 0.03, -0.004};
  raw.lens.gain_map = {3, 2, {1, 1.25F, 2, 1, 1.5F, 3}};
  raw.shot_noise_share = 0.25;
  raw.date_time = parse_date_time("2026-11-26 10:07:09.25");
  write_dng(path("a.dng"), raw);
  LinearPicture picture{8, 6, std::vector<std::uint16_t>(3 * 8 * 6, 9), {}, camera_facts(raw), ""};
  picture.rgb_from_xyz = {3, -1, 0, -1, 2, 0, 0, 0, 1};
  write_linear_dng(path("l.dng"), picture);
  for (const char* name : {"a.dng", "l.dng"}) {
    const auto said = [&](const std::string& about) {
      EXPECT_EQ(
          std::system(("exiftool -S " + about + " '" + path(name) + "' > '" + path("said") + "'").c_str()),
          0);
      return read_whole_file(path("said"));
    };
    EXPECT_EQ(said("-validate -warning -error -a"), "Validate: OK\n") << name;
    EXPECT_EQ(said("-DateTimeOriginal -SubSecTimeOriginal -ModifyDate -LensModel -FNumber -OpcodeList3"),
              "DateTimeOriginal: 2026:11:26 10:07:09\nSubSecTimeOriginal: 250000\n"
              "ModifyDate: 2026:11:26 10:07:09\nLensModel: Some Lens 35mm\nFNumber: 2.8\n"
              "OpcodeList3: WarpFisheye\n")
        << name;
  }
  const auto said_of_maps = [&](const char* name) {
    EXPECT_EQ(std::system(("exiftool -S -OpcodeList2 '" + path(name) + "' > '" + path("said") + "'").c_str()),
              0);
    return read_whole_file(path("said"));
  };
  EXPECT_EQ(said_of_maps("a.dng"), "OpcodeList2: GainMap, GainMap, GainMap, GainMap\n");
  EXPECT_EQ(said_of_maps("l.dng"), "OpcodeList2: GainMap\n");
}

/// Entries of a directory are tag, type, count and place; the file is little-endian.
TEST_F(Dng, ATagOfAnotherTypeIsRefusedNotTakenForItsBytes) {
  write_dng(path("a.dng"), example());
  const std::string bytes = read_whole_file(path("a.dng"));
  const auto entry = [](int tag, int type) {
    return std::string{static_cast<char>(tag & 255), static_cast<char>(tag >> 8), static_cast<char>(type), 0};
  };
  constexpr int ascii = 2, rational = 5, signed_rational = 10, real = 12;
  struct Change {
    const char* name;
    int tag, from, to;
  };
  for (const auto& [name, tag, from, to] :
       {Change{"ForwardMatrix1", 50964, signed_rational, ascii}, Change{"NoiseProfile", 51041, real, ascii},
        Change{"ColorMatrix1", 50721, signed_rational, ascii},
        Change{"BlackLevel", 50714, rational, ascii}}) {
    std::string changed = bytes;
    const std::size_t at = changed.find(entry(tag, from));
    ASSERT_NE(at, changed.npos) << name;
    changed.replace(at, 4, entry(tag, to));
    try {
      parse_dng(changed, "x.dng");
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), fmt::format("x.dng: has a {} that cannot be read", name));
    }
  }
}

TEST_F(Dng, DamageIsRefusedOrHarmless) {
  RawImage raw = example();
  raw.bad_pixels = {{7, 3}};
  raw.lens.fisheye_warp = {1.01, -0.2, 0.03, -0.004};
  raw.lens.vignetting = {0.1, 0.02, 0.003, 4e-4, 5e-5};
  raw.lens.gain_map = {3, 2, {1, 1.25F, 2, 1, 1.5F, 3}};
  raw.shot_noise_share = 0.25;
  raw.date_time = parse_date_time("2026-11-26 10:07:09.25");
  write_dng(path("a.dng"), raw);
  const std::string bytes = read_whole_file(path("a.dng"));
  const auto attempt = [&](const std::string& damaged) {
    const std::string name = path("damaged.dng");
    std::filesystem::remove(name);
    std::FILE* file = std::fopen(name.c_str(), "wb");
    std::fwrite(damaged.data(), 1, damaged.size(), file);
    std::fclose(file);
    try {
      read_dng(name);
      return true;
    } catch (const Error&) {
      return false;
    }
  };
  for (std::size_t length = 0; length < bytes.size(); length += 97)
    EXPECT_FALSE(attempt(bytes.substr(0, length))) << length;
  // Samples mislead nobody; everything else may. Bits, bytes and words at random.
  const std::size_t mosaic = bytes.find(sample_bytes(example())), mosaic_bytes = 2 * 60 * 44;
  ASSERT_NE(mosaic, bytes.npos);
  for (std::uint64_t i = 0; i < 4000; ++i) {
    RandomStream random(8, 1, i);
    std::string damaged = bytes;
    const std::uint64_t changes = 1 + random.bits() % 3;
    for (std::uint64_t k = 0; k < changes; ++k) {
      const bool header = random.bits() % 16 == 0;
      std::size_t at = header ? random.bits() % 8 : random.bits() % (bytes.size() - mosaic_bytes);
      if (at >= mosaic) at += mosaic_bytes;
      damaged[at] = random.bits() % 2 ? static_cast<char>(random.bits())
                                      : static_cast<char>(damaged[at] ^ (1 << random.bits() % 8));
    }
    attempt(damaged);
  }
}

}  // namespace
}  // namespace petzval
