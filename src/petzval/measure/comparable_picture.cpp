// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/image/formats/exif_orientation.h>
#include <petzval/image/formats/jpeg.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/png.h>
#include <petzval/image/formats/spectral_exr.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/measure/comparable_picture.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace petzval {

namespace {

ComparablePicture read_exr(const std::string& path) {
  SpectralExr exr = read_spectral_exr(path);
  exr.validate(path);
  ComparablePicture picture;
  picture.columns = exr.width;
  picture.rows = exr.height;
  picture.bands = exr.wavelengths_nm.size();
  picture.wavelengths_nm = exr.wavelengths_nm;
  picture.units = exr.kind == SpectralExr::Kind::reflective ? "reflectance" : exr.units;
  const auto pitch = exr.numbers.find("pixelPitch_um");
  if (pitch != exr.numbers.end()) picture.pitch_um = pitch->second;
  picture.values = std::move(exr.values);
  return picture;
}

ComparablePicture read_array(const std::string& path) {
  NpyArray array = read_npy(path);
  constexpr std::size_t most = std::numeric_limits<int>::max();
  const bool pictorial = (array.shape.size() == 2 || array.shape.size() == 3) &&
                         std::all_of(array.shape.begin(), array.shape.end(),
                                     [](std::size_t length) { return length > 0 && length <= most; });
  if (!pictorial)
    throw InputError(path, fmt::format("has {} dimensions; a picture has (rows, columns) or (rows, columns, "
                                       "bands), none of them 0",
                                       array.shape.size()));
  ComparablePicture picture;
  picture.rows = static_cast<int>(array.shape[0]);
  picture.columns = static_cast<int>(array.shape[1]);
  picture.bands = array.shape.size() == 3 ? array.shape[2] : 1;
  picture.interleaved = true;
  if (auto* single = std::get_if<std::vector<float>>(&array.values))
    picture.values = LargeFloats(std::move(*single));
  else
    picture.values = std::move(std::get<std::vector<double>>(array.values));
  return picture;
}

template <class Sample>
std::vector<double> shares_of_full_scale(const std::vector<Sample>& samples, double full_scale) {
  std::vector<double> values(samples.size());
  std::transform(samples.begin(), samples.end(), values.begin(),
                 [full_scale](Sample sample) { return static_cast<double>(sample) / full_scale; });
  return values;
}

/// A picture for display. \param orientation  as files say it; only upright ones lie as they look.
template <class Image>
ComparablePicture display_of(const Image& image, bool linear, std::vector<double> values,
                             const std::string& path, int orientation = upright_orientation) {
  if (orientation != upright_orientation)
    throw InputError(path, fmt::format("is stored turned or mirrored (orientation {}); one that is stored "
                                       "upright can be compared",
                                       orientation));
  ComparablePicture picture;
  picture.columns = image.columns;
  picture.rows = image.rows;
  picture.bands = static_cast<std::size_t>(image.channels);
  picture.units = linear ? "linear code values" : "code values";
  picture.display = true;
  picture.interleaved = true;
  picture.values = std::move(values);
  return picture;
}

constexpr double full_byte = 255, full_word = 65535;

ComparablePicture read_png_display(const std::string& path) {
  const PngImage png = read_png(path);
  return display_of(png, png.transfer == PngTransfer::linear,
                    shares_of_full_scale(png.samples, png.bits == 16 ? full_word : full_byte), path);
}

ComparablePicture read_tiff_display(const std::string& path) {
  const TiffImage tiff = read_tiff(path);
  const bool linear = std::holds_alternative<std::vector<float>>(tiff.samples);  // 1 is full scale
  const std::size_t sample_bytes =
      std::visit([](const auto& samples) { return sizeof(samples[0]); }, tiff.samples);
  const double full_scale = linear ? 1 : sample_bytes == 1 ? full_byte : full_word;
  return display_of(tiff, linear,
                    std::visit([&](const auto& samples) { return shares_of_full_scale(samples, full_scale); },
                               tiff.samples),
                    path, tiff.orientation);
}

ComparablePicture read_jpeg_display(const std::string& path) {
  const JpegImage jpeg = read_jpeg(path);
  return display_of(jpeg, false, shares_of_full_scale(jpeg.samples, full_byte), path, jpeg.orientation);
}

void require_finite(const ComparablePicture& picture) {
  for (std::size_t pixel = 0; pixel < picture.pixels(); ++pixel)
    for (std::size_t band = 0; band < picture.bands; ++band)
      if (!std::isfinite(picture.at(band, pixel)))
        throw InputError(
            picture.name,
            fmt::format("band {}, row {}, column {} is {}: only finite numbers can be compared", band,
                        pixel / static_cast<std::size_t>(picture.columns),
                        pixel % static_cast<std::size_t>(picture.columns), picture.at(band, pixel)));
}

}  // namespace

ComparablePicture read_comparable_picture(const std::string& path) {
  const std::string extension = extension_of(path);
  const std::pair<const char*, ComparablePicture (*)(const std::string&)> readers[] = {
      {".exr", read_exr},          {".npy", read_array},         {".png", read_png_display},
      {".tif", read_tiff_display}, {".tiff", read_tiff_display}, {".jpg", read_jpeg_display},
      {".jpeg", read_jpeg_display}};
  const auto* const reader = std::find_if(std::begin(readers), std::end(readers),
                                          [&](const auto& each) { return extension == each.first; });
  if (reader == std::end(readers))
    throw InputError(path, "cannot be compared: .exr (spectral), .npy, .png, .tif and .jpg can");
  ComparablePicture picture = reader->second(path);
  picture.name = path;
  require_finite(picture);
  return picture;
}

bool drop_full_opacity(ComparablePicture& picture) {
  if (!picture.display || (picture.bands != 2 && picture.bands != 4)) return false;
  const std::size_t colours = picture.bands - 1;
  for (std::size_t pixel = 0; pixel < picture.pixels(); ++pixel)
    if (picture.at(colours, pixel) != 1) return false;
  std::vector<double> values;
  values.reserve(picture.pixels() * colours);
  for (std::size_t pixel = 0; pixel < picture.pixels(); ++pixel)
    for (std::size_t band = 0; band < colours; ++band) values.push_back(picture.at(band, pixel));
  picture.bands = colours;
  picture.interleaved = true;
  picture.values = std::move(values);
  return true;
}

}  // namespace petzval
