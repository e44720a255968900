// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/plane_exr.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/sensor/raw_file.h>

#include <algorithm>
#include <filesystem>

namespace petzval {

namespace {

std::vector<float> linear_values(const RawImage& raw) {
  std::vector<float> values(raw.samples.size());
  std::transform(raw.samples.begin(), raw.samples.end(), values.begin(), [&](std::uint16_t stored) {
    return static_cast<float>(raw.linearization.empty() ? stored : raw.linearization[stored]);
  });
  return values;
}

void write_exr(const std::string& path, const RawImage& raw) {
  const std::vector<float> values = linear_values(raw);
  write_plane_exr(path, raw.columns, raw.rows, {{"Y", values}},
                  {{"mosaic", mosaic_text(raw.mosaic, raw.channels)}, {"comments", raw.provenance}},
                  {{"blackLevel", raw.black_level},
                   {"whiteLevel", raw.white_level},
                   {"dnPerElectron", raw.dn_per_e},
                   {"expTime", raw.exposure_s}});
}

}  // namespace

const std::vector<std::string>& raw_extensions() {
  static const std::vector<std::string> extensions = {".dng", ".tif", ".tiff", ".npy", ".exr"};
  return extensions;
}

void write_raw(const std::string& path, const RawImage& raw) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (extension == ".dng") return write_dng(path, raw);
  if (extension == ".exr") return write_exr(path, raw);
  if (extension == ".tif" || extension == ".tiff")
    return write_tiff(path, {raw.columns, raw.rows, 1, raw.samples, {}, raw.provenance});
  if (extension == ".npy") {
    const std::size_t shape[] = {static_cast<std::size_t>(raw.rows), static_cast<std::size_t>(raw.columns)};
    return write_npy(path, shape, linear_values(raw));
  }
  throw InputError(path, "a raw image is written as .dng, .tif, .npy or .exr");
}

}  // namespace petzval
