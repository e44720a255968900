// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/colour/display.h>
#include <petzval/image/formats/png.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/measure/viewed_picture.h>

#include <algorithm>
#include <filesystem>
#include <functional>

namespace petzval {

namespace {

/// \param linear  the linear light of sample i.
ViewedPicture viewed(int columns, int rows, int channels, const std::function<double(std::size_t)>& linear) {
  ViewedPicture picture{columns, rows, {}};
  const std::size_t pixels = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  picture.pixels.reserve(pixels);
  const auto step = static_cast<std::size_t>(channels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::size_t at = i * step;
    const bool grey = channels < 3;
    picture.pixels.push_back(
        xyz_of(LinearRgb{linear(at), linear(grey ? at : at + 1), linear(grey ? at : at + 2)}));
  }
  return picture;
}

std::vector<double> decoding(std::size_t count) {
  std::vector<double> table(count);
  for (std::size_t i = 0; i < count; ++i)
    table[i] = srgb_decoded(static_cast<double>(i) / static_cast<double>(count - 1));
  return table;
}

ViewedPicture of_tiff(const std::string& path) {
  const TiffImage image = read_tiff(path);
  return std::visit(
      [&](const auto& samples) {
        using Sample = typename std::decay_t<decltype(samples)>::value_type;
        if constexpr (std::is_same_v<Sample, float>) {
          return viewed(image.columns, image.rows, image.channels,
                        [&](std::size_t i) { return static_cast<double>(samples[i]); });
        } else {
          const std::vector<double> table = decoding(std::size_t{1} << (8 * sizeof(Sample)));
          return viewed(image.columns, image.rows, image.channels,
                        [&](std::size_t i) { return table[samples[i]]; });
        }
      },
      image.samples);
}

}  // namespace

ViewedPicture read_viewed_picture(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (extension == ".tif" || extension == ".tiff") return of_tiff(path);
  if (extension != ".png") throw InputError(path, "a picture to be looked at is .png or .tif");
  const PngImage image = read_standard_png(path);
  const std::vector<double> table = decoding(image.bits == 8 ? 256 : 65536);
  return viewed(image.columns, image.rows, image.channels,
                [&](std::size_t i) { return table[image.samples[i]]; });
}

}  // namespace petzval
