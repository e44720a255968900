// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/colour/display.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/png.h>
#include <petzval/image/formats/spectral_exr.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/measure/sfr/picture_planes.h>

#include <cctype>
#include <cmath>
#include <functional>
#include <string_view>

namespace petzval {

namespace {

/// Planes of interleaved samples; `value` turns the index of a sample into light.
PicturePlanes deinterleaved(int columns, int rows, int channels, int wanted,
                            const std::function<double(std::size_t)>& value) {
  PicturePlanes picture;
  picture.columns = columns, picture.rows = rows;
  picture.rgb = wanted == 3;
  const std::size_t pixels = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  for (int c = 0; c < wanted; ++c) {
    Plane plane{columns, rows, std::vector<double>(pixels)};
    for (std::size_t i = 0; i < pixels; ++i)
      plane.values[i] = value(i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c));
    picture.planes.push_back(std::move(plane));
  }
  return picture;
}

double to_light(double code, bool linear) {
  return linear ? code : srgb_decoded(code);
}

/// What only files of whole numbers, 0 to `full`, have.
void add_codes(PicturePlanes& picture, double full, bool linear) {
  picture.clip_low = 0, picture.clip_high = 1;
  for (double code = 0; code <= full; ++code) picture.code_levels.push_back(to_light(code / full, linear));
}

PicturePlanes from_png(const std::string& path, PictureTransfer transfer) {
  const PngImage png = read_png(path);
  const bool linear = transfer == PictureTransfer::linear ||
                      (transfer == PictureTransfer::stated && png.transfer == PngTransfer::linear);
  const double full = png.bits == 8 ? 255 : 65535;
  PicturePlanes picture =
      deinterleaved(png.columns, png.rows, png.channels, png.channels < 3 ? 1 : 3,
                    [&](std::size_t i) { return to_light(png.samples[i] / full, linear); });
  add_codes(picture, full, linear);
  return picture;
}

/// Whether a description calls the numbers linear: the word by itself, which "non-linear" has not.
bool says_linear(std::string_view description) {
  constexpr std::string_view word = "linear";
  const auto in_word = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '-'; };
  for (std::size_t at = 0; (at = description.find(word, at)) != description.npos; at += word.size()) {
    const bool begins = at == 0 || !in_word(description[at - 1]);
    const std::size_t end = at + word.size();
    const bool ends = end == description.size() || !in_word(description[end]);
    const std::string_view before = description.substr(0, at);
    if (begins && ends && !before.ends_with("non ") && !before.ends_with("not ")) return true;
  }
  return false;
}

PicturePlanes from_tiff(const std::string& path, PictureTransfer transfer) {
  const TiffImage tiff = read_tiff(path);
  const bool floats = std::holds_alternative<std::vector<float>>(tiff.samples);
  const bool linear = transfer == PictureTransfer::linear ||
                      (transfer == PictureTransfer::stated && (floats || says_linear(tiff.description)));
  PicturePlanes picture = std::visit(
      [&](const auto& samples) {
        using Sample = typename std::decay_t<decltype(samples)>::value_type;
        const double full =
            std::is_same_v<Sample, float> ? 1 : static_cast<double>(std::numeric_limits<Sample>::max());
        return deinterleaved(
            tiff.columns, tiff.rows, tiff.channels, tiff.channels < 3 ? 1 : 3,
            [&](std::size_t i) { return to_light(static_cast<double>(samples[i]) / full, linear); });
      },
      tiff.samples);
  if (!floats)
    add_codes(picture, std::holds_alternative<std::vector<std::uint8_t>>(tiff.samples) ? 255 : 65535, linear);
  return picture;
}

PicturePlanes from_npy(const std::string& path) {
  const NpyArray array = read_npy(path);
  const std::size_t dimensions = array.shape.size();
  constexpr std::size_t longest = 1 << 20;
  if ((dimensions != 2 && dimensions != 3) || array.shape[0] < 1 || array.shape[1] < 1 ||
      array.shape[0] > longest || array.shape[1] > longest ||
      (dimensions == 3 && (array.shape[2] < 1 || array.shape[2] > 4096)))
    throw InputError(path, "a picture has the shape rows x columns or rows x columns x bands");
  const int bands = dimensions == 3 ? static_cast<int>(array.shape[2]) : 1;
  PicturePlanes picture = std::visit(
      [&](const auto& values) {
        return deinterleaved(static_cast<int>(array.shape[1]), static_cast<int>(array.shape[0]), bands, bands,
                             [&](std::size_t i) { return static_cast<double>(values[i]); });
      },
      array.values);
  return picture;
}

PicturePlanes from_exr(const std::string& path) {
  const SpectralExr exr = read_spectral_exr(path);
  PicturePlanes picture;
  picture.columns = exr.width, picture.rows = exr.height;
  for (std::size_t band = 0; band < exr.wavelengths_nm.size(); ++band) {
    const std::span<const float> values = exr.plane(band);
    picture.planes.push_back({exr.width, exr.height, {values.begin(), values.end()}});
  }
  return picture;
}

}  // namespace

Plane PicturePlanes::luminance() const {
  if (planes.size() == 1) return planes[0];
  Plane result{columns, rows, std::vector<double>(planes[0].values.size())};
  const std::vector<double> weights =
      rgb ? std::vector<double>{0.2126, 0.7152, 0.0722}
          : std::vector<double>(planes.size(), 1 / static_cast<double>(planes.size()));
  for (std::size_t c = 0; c < planes.size(); ++c)
    for (std::size_t i = 0; i < result.values.size(); ++i)
      result.values[i] += weights[c] * planes[c].values[i];
  return result;
}

PicturePlanes read_picture_planes(const std::string& path, PictureTransfer transfer) {
  const std::string extension = extension_of(path);
  PicturePlanes picture;
  if (extension == ".png")
    picture = from_png(path, transfer);
  else if (extension == ".tif" || extension == ".tiff")
    picture = from_tiff(path, transfer);
  else if (extension == ".npy")
    picture = from_npy(path);
  else if (extension == ".exr")
    picture = from_exr(path);
  else
    throw InputError(path, "a picture to measure is a .png, .tif, .npy or .exr");
  for (const Plane& plane : picture.planes)
    for (std::size_t i = 0; i < plane.values.size(); ++i)
      if (!std::isfinite(plane.values[i]))
        throw InputError(path, fmt::format("the value at column {}, row {} is not a finite number",
                                           i % static_cast<std::size_t>(plane.columns),
                                           i / static_cast<std::size_t>(plane.columns)));
  return picture;
}

}  // namespace petzval
