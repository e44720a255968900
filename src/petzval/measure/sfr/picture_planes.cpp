// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/colour/display.h>
#include <petzval/image/formats/jpeg.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/png.h>
#include <petzval/image/formats/spectral_exr.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/isp/demosaic.h>
#include <petzval/measure/sfr/picture_planes.h>
#include <petzval/sensor/formats/camera_raw.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

namespace petzval {

namespace {

/// Planes of interleaved samples; `value` turns the index of a sample into light.
template <typename Value>
PicturePlanes deinterleaved(int columns, int rows, int channels, int wanted, const Value& value) {
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

/// How code values become light.
struct CodeCurve {
  bool linear = false, assumed = false;
};

CodeCurve code_curve(PictureTransfer asked, bool says_linear, bool says_srgb) {
  if (asked != PictureTransfer::stated) return {asked == PictureTransfer::linear, false};
  return {says_linear, !says_linear && !says_srgb};
}

/// What only files of whole numbers have.
void add_codes(PicturePlanes& picture, int bits, const CodeCurve& curve) {
  picture.clip_low = 0, picture.clip_high = 1;
  picture.bits = bits, picture.srgb = !curve.linear, picture.assumed = curve.assumed;
  const double full = bits == 8 ? 255 : 65535;
  for (double code = 0; code <= full; ++code)
    picture.code_levels.push_back(to_light(code / full, curve.linear));
}

PicturePlanes from_png(const std::string& path, PictureTransfer transfer) {
  const PngImage png = read_standard_png(path);
  const CodeCurve curve =
      code_curve(transfer, png.transfer == PngTransfer::linear, png.transfer == PngTransfer::srgb);
  const double full = png.bits == 8 ? 255 : 65535;
  PicturePlanes picture =
      deinterleaved(png.columns, png.rows, png.channels, png.channels < 3 ? 1 : 3,
                    [&](std::size_t i) { return to_light(png.samples[i] / full, curve.linear); });
  add_codes(picture, png.bits, curve);
  return picture;
}

PicturePlanes from_jpeg(const std::string& path, PictureTransfer transfer) {
  const JpegImage jpeg = read_jpeg(path);
  const CodeCurve curve = code_curve(transfer, false, false);
  PicturePlanes picture =
      deinterleaved(jpeg.columns, jpeg.rows, jpeg.channels, jpeg.channels,
                    [&](std::size_t i) { return to_light(jpeg.samples[i] / 255.0, curve.linear); });
  add_codes(picture, 8, curve);
  picture.coefficient_steps = jpeg.steps;
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
  const CodeCurve curve = code_curve(transfer, floats || says_linear(tiff.description),
                                     tiff.description.find("sRGB") != std::string::npos);
  PicturePlanes picture = std::visit(
      [&](const auto& samples) {
        using Sample = typename std::decay_t<decltype(samples)>::value_type;
        const double full =
            std::is_same_v<Sample, float> ? 1 : static_cast<double>(std::numeric_limits<Sample>::max());
        return deinterleaved(
            tiff.columns, tiff.rows, tiff.channels, tiff.channels < 3 ? 1 : 3,
            [&](std::size_t i) { return to_light(static_cast<double>(samples[i]) / full, curve.linear); });
      },
      tiff.samples);
  if (!floats)
    add_codes(picture, std::holds_alternative<std::vector<std::uint8_t>>(tiff.samples) ? 8 : 16, curve);
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

/// The light of each stored number, as linearised() has it.
void add_raw_levels(PicturePlanes& picture, const RawImage& raw) {
  const double range = raw.white_level - raw.black_level;
  const auto add = [&](double linear) { picture.code_levels.push_back((linear - raw.black_level) / range); };
  if (raw.linearization.empty())
    for (double code = 0; code <= raw.white_level; ++code) add(code);
  else
    for (const std::uint16_t linear : raw.linearization) add(linear);
  std::ranges::sort(picture.code_levels);
  picture.code_levels.erase(std::unique(picture.code_levels.begin(), picture.code_levels.end()),
                            picture.code_levels.end());
  picture.clip_low = picture.code_levels.front(), picture.clip_high = 1;
  picture.bits = 16;
}

PicturePlanes from_raw(const RawImage& raw, const std::string& path, bool demosaic) {
  const LinearMosaic mosaic = linearised(raw);
  PicturePlanes picture;
  picture.columns = mosaic.columns, picture.rows = mosaic.rows;
  const auto add_plane = [&](const std::vector<float>& values) {
    picture.planes.push_back({mosaic.columns, mosaic.rows, {values.begin(), values.end()}});
  };
  if (mosaic.mosaic.is_uniform() || !demosaic) {
    add_plane(mosaic.values);
    add_raw_levels(picture, raw);
    if (mosaic.mosaic.is_uniform()) return picture;
    if (!is_bayer(mosaic))
      throw InputError(path, fmt::format("the mosaic {} is not Bayer's, whose colours are measured by "
                                         "themselves; demosaic it",
                                         mosaic_text(mosaic.mosaic, mosaic.channels)));
    for (const char c : mosaic_text(mosaic.mosaic, mosaic.channels))
      picture.bayer += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return picture;
  }
  const Planes planes = demosaiced(mosaic, usual_demosaic_method(mosaic).name);
  for (const char* const colour : {"red", "green", "blue"}) {
    const auto at = std::ranges::find(mosaic.channels, colour);
    if (at == mosaic.channels.end() || mosaic.channels.size() != 3) break;
    add_plane(planes.values[static_cast<std::size_t>(at - mosaic.channels.begin())]);
  }
  picture.rgb = picture.planes.size() == 3;
  if (!picture.rgb) {
    picture.planes.clear();
    for (const std::vector<float>& values : planes.values) add_plane(values);
  }
  picture.clip_high = 1;
  return picture;
}

}  // namespace

const std::vector<std::string>& measurable_extensions() {
  static const std::vector<std::string> extensions = [] {
    std::vector<std::string> all{".png", ".jpg", ".jpeg", ".tif", ".tiff", ".npy", ".exr"};
    all.insert(all.end(), camera_raw_extensions().begin(), camera_raw_extensions().end());
    return all;
  }();
  return extensions;
}

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

PicturePlanes read_picture_planes(const std::string& path, PictureTransfer transfer, bool demosaic) {
  const std::string extension = extension_of(path);
  PicturePlanes picture;
  if (extension == ".png")
    picture = from_png(path, transfer);
  else if (extension == ".jpg" || extension == ".jpeg")
    picture = from_jpeg(path, transfer);
  else if (extension == ".tif" || extension == ".tiff")
    picture = from_tiff(path, transfer);
  else if (extension == ".npy")
    picture = from_npy(path);
  else if (extension == ".exr")
    picture = from_exr(path);
  else if (std::ranges::count(camera_raw_extensions(), extension))
    picture = from_raw(read_raw(path), path, demosaic);
  else
    throw InputError(path,
                     "a picture to measure is a .png, .jpg, .tif, .npy, .exr, .dng or a camera's raw file "
                     "(.nef, .cr2, .arw, ...)");
  for (const Plane& plane : picture.planes)
    for (std::size_t i = 0; i < plane.values.size(); ++i)
      if (!std::isfinite(plane.values[i]))
        throw InputError(path, fmt::format("the value at column {}, row {} is not a finite number",
                                           i % static_cast<std::size_t>(plane.columns),
                                           i / static_cast<std::size_t>(plane.columns)));
  return picture;
}

}  // namespace petzval
