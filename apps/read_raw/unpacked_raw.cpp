// SPDX-License-Identifier: BSD-3-Clause
#include "unpacked_raw.h"

#include <fmt/format.h>
#include <libraw/libraw.h>
#include <petzval/base/error.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace petzval {

namespace {

void check(int result, const std::string& path) {
  if (result != LIBRAW_SUCCESS)
    throw InputError(
        path, fmt::format("LibRaw cannot read it as a camera's raw file: {}", libraw_strerror(result)));
}

/// The name of a colour that LibRaw calls by a letter.
std::string channel_name(char letter, const std::string& path) {
  switch (letter) {
    case 'R':
      return "red";
    case 'G':
      return "green";
    case 'B':
      return "blue";
    case 'C':
      return "cyan";
    case 'M':
      return "magenta";
    case 'Y':
      return "yellow";
    default:
      throw InputError(path, fmt::format("a sensor with a colour that LibRaw calls {}; red, green, blue and "
                                         "their complements are known",
                                         letter));
  }
}

/// The colours of a mosaic's period, which is 6 x 6 for X-Trans; two greens are one channel.
void add_mosaic(LibRaw& libraw, RawImage& raw, const std::string& path) {
  const auto& about = libraw.imgdata.idata;
  if (about.filters == 0) {
    raw.mosaic = {};
    raw.channels = {"grey"};
    return;
  }
  // Matrices and balances have LibRaw's order.
  if (std::string(about.cdesc).starts_with("RGB")) raw.channels = {"red", "green", "blue"};
  const int period = about.filters == 9 ? 6 : about.filters >= 1000 ? 8 : 0;
  if (period == 0)
    throw InputError(path, "its mosaic is not one of squares; Bayer and X-Trans mosaics are read");
  Mosaic mosaic{period, period == 8 ? 2 : period, {}};
  for (int row = 0; row < mosaic.rows; ++row)
    for (int column = 0; column < mosaic.columns; ++column) {
      const std::string name = channel_name(about.cdesc[libraw.COLOR(row, column)], path);
      auto at = std::ranges::find(raw.channels, name);
      if (at == raw.channels.end()) at = raw.channels.insert(raw.channels.end(), name);
      mosaic.cells.push_back(static_cast<int>(at - raw.channels.begin()));
    }
  // dcraw's patterns are eight rows high; Bayer's repeat after two.
  if (mosaic.rows == 8) {
    const std::vector<int> two(mosaic.cells.begin(), mosaic.cells.begin() + 4);
    bool repeats = true;
    for (std::size_t i = 0; i < mosaic.cells.size(); ++i) repeats = repeats && mosaic.cells[i] == two[i % 4];
    if (repeats) mosaic.rows = 2, mosaic.cells = two;
  }
  raw.mosaic = mosaic;
}

/// Black of a visible pixel: one level, one of each of four colours, and a pattern that repeats over the
/// sensor.
unsigned black_of(LibRaw& libraw, int row, int column) {
  const auto& colour = libraw.imgdata.color;
  unsigned black =
      colour.black + colour.cblack[libraw.imgdata.idata.filters == 0 ? 0 : libraw.COLOR(row, column)];
  const unsigned rows = colour.cblack[4], columns = colour.cblack[5];
  if (rows > 0 && columns > 0 && rows * columns <= LIBRAW_CBLACK_SIZE - 6)
    black += colour.cblack[6 + static_cast<unsigned>(row) % rows * columns +
                           static_cast<unsigned>(column) % columns];
  return black;
}

void add_samples(LibRaw& libraw, RawImage& raw, const std::string& path) {
  const auto& sizes = libraw.imgdata.sizes;
  const ushort* const stored = libraw.imgdata.rawdata.raw_image;
  if (stored == nullptr)
    throw InputError(
        path, "it holds no mosaic as the sensor recorded it, one number a pixel, which is what is read");
  raw.columns = sizes.width, raw.rows = sizes.height;
  const std::size_t pitch = sizes.raw_pitch / sizeof(ushort);
  if (raw.columns < 1 || raw.rows < 1 || sizes.left_margin + raw.columns > sizes.raw_width ||
      sizes.top_margin + raw.rows > sizes.raw_height || pitch < sizes.raw_width)
    throw InputError(path, "its sizes contradict each other");
  unsigned most = 0;
  constexpr int period = 48;  // of all patterns
  for (int row = 0; row < std::min(period, raw.rows); ++row)
    for (int column = 0; column < std::min(period, raw.columns); ++column)
      most = std::max(most, black_of(libraw, row, column));
  raw.black_level = most;
  raw.white_level = libraw.imgdata.color.maximum;
  if (!(raw.white_level > raw.black_level && raw.white_level < 65536))
    throw InputError(path, fmt::format("black {} and white {} leave no light between them", most,
                                       libraw.imgdata.color.maximum));
  raw.samples.reserve(static_cast<std::size_t>(raw.columns) * static_cast<std::size_t>(raw.rows));
  for (int row = 0; row < raw.rows; ++row) {
    const ushort* const line =
        stored + static_cast<std::size_t>(row + sizes.top_margin) * pitch + sizes.left_margin;
    for (int column = 0; column < raw.columns; ++column)
      raw.samples.push_back(
          static_cast<std::uint16_t>(std::min(65535U, line[column] + most - black_of(libraw, row, column))));
  }
}

/// A matrix from XYZ to the camera's red, green and blue, if there is one.
void add_matrix(RawImage& raw, int illuminant, const float (&matrix)[4][3]) {
  const double temperature_k = illuminant == 17   ? 2856
                               : illuminant == 21 ? 6504
                               : illuminant == 23 ? 5003
                                                  : 0;
  ColourCalibration calibration{illuminant, temperature_k, {}, {}};
  bool known = false;
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 3; ++k) {
      if (!std::isfinite(matrix[c][k])) return;
      calibration.camera_from_xyz.push_back(static_cast<double>(matrix[c][k]));
      known = known || matrix[c][k] != 0;
    }
  if (known && temperature_k > 0) raw.calibrations.push_back(calibration);
}

void add_colours(const LibRaw& libraw, RawImage& raw) {
  const auto& colour = libraw.imgdata.color;
  if (raw.channels != std::vector<std::string>{"red", "green", "blue"}) return;
  for (const auto& dng : colour.dng_color) add_matrix(raw, dng.illuminant, dng.colormatrix);
  if (raw.calibrations.empty()) add_matrix(raw, 21, colour.cam_xyz);
  std::vector<double> neutral;
  for (int c = 0; c < 3; ++c)
    if (colour.cam_mul[c] > 0 && std::isfinite(colour.cam_mul[c])) neutral.push_back(1 / colour.cam_mul[c]);
  if (neutral.size() == 3) {
    const double most = std::ranges::max(neutral);
    for (double& n : neutral) n /= most;
    raw.as_shot_neutral = neutral;
  }
}

}  // namespace

RawImage unpacked_raw(const std::string& path) {
  const auto libraw = std::make_unique<LibRaw>();  // half a megabyte
  check(libraw->open_file(path.c_str()), path);
  check(libraw->unpack(), path);
  RawImage raw;
  add_mosaic(*libraw, raw, path);
  add_samples(*libraw, raw, path);
  add_colours(*libraw, raw);
  const auto& shot = libraw->imgdata.other;
  if (shot.shutter > 0 && std::isfinite(shot.shutter)) raw.exposure_s = shot.shutter;
  if (shot.iso_speed > 0 && std::isfinite(shot.iso_speed)) raw.iso = shot.iso_speed;
  return raw;
}

}  // namespace petzval
