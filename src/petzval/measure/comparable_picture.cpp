// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/png.h>
#include <petzval/image/formats/spectral_exr.h>
#include <petzval/measure/comparable_picture.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

ComparablePicture read_display(const std::string& path) {
  const PngImage png = read_png(path);
  ComparablePicture picture;
  picture.columns = png.columns;
  picture.rows = png.rows;
  picture.bands = static_cast<std::size_t>(png.channels);
  picture.units = png.transfer == PngTransfer::linear ? "linear code values" : "code values";
  picture.display = true;
  picture.interleaved = true;
  const double full_scale = png.bits == 16 ? 65535 : 255;
  std::vector<double> values(png.samples.size());
  std::transform(png.samples.begin(), png.samples.end(), values.begin(),
                 [&](std::uint16_t sample) { return sample / full_scale; });
  picture.values = std::move(values);
  return picture;
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
  if (extension != ".exr" && extension != ".npy" && extension != ".png")
    throw InputError(path, "cannot be compared: .exr (spectral), .npy and .png can");
  ComparablePicture picture = extension == ".exr"   ? read_exr(path)
                              : extension == ".npy" ? read_array(path)
                                                    : read_display(path);
  picture.name = path;
  require_finite(picture);
  return picture;
}

}  // namespace petzval
