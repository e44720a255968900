// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/colour/rec2100.h>
#include <petzval/image/formats/jpeg_output.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/plane_exr.h>
#include <petzval/image/formats/png.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/isp/display_picture.h>
#include <petzval/isp/linear_picture.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace petzval {

namespace {

/// The transfer curve for values 0 … 1 in steps too fine to show in 16 bits.
class CodeTable {
 public:
  explicit CodeTable(int bits) : table_(steps + 1) {
    for (std::size_t i = 0; i <= steps; ++i) {
      // Roots, not values, are evenly spaced: the curve is steep near black.
      const double root = static_cast<double>(i) / steps;
      const double encoded = srgb_encoded(root * root);
      table_[i] = static_cast<float>(encoded * (bits == 8 ? 255 : 65535));
    }
  }
  std::uint16_t operator()(float linear) const {
    if (!(linear > 0)) return 0;
    const float at = std::sqrt(std::min(1.0f, linear)) * static_cast<float>(steps);
    const auto i = std::min(static_cast<std::size_t>(at), steps - 1);
    const float share = at - static_cast<float>(i);
    return static_cast<std::uint16_t>(table_[i] + share * (table_[i + 1] - table_[i]) + 0.5f);
  }

 private:
  static constexpr std::size_t steps = 16384;
  std::vector<float> table_;
};

/// Channels interleaved; `Code` holds as many bits or more.
template <typename Code, typename ToCode>
std::vector<Code> codes(const Planes& planes, const ToCode& code) {
  const std::size_t channels = planes.values.size(), columns = static_cast<std::size_t>(planes.columns);
  std::vector<Code> samples(planes.values[0].size() * channels);
  parallel_for(static_cast<std::size_t>(planes.rows), [&](std::size_t row) {
    for (std::size_t k = 0; k < channels; ++k) {
      const float* const from = planes.values[k].data() + row * columns;
      Code* const to = samples.data() + row * columns * channels + k;
      for (std::size_t c = 0; c < columns; ++c) to[c * channels] = static_cast<Code>(code(from[c]));
    }
  });
  return samples;
}

void write_tiff_picture(const std::string& path, const Planes& planes, int bits, const std::string& icc,
                        const std::string& provenance) {
  TiffImage image{planes.columns, planes.rows, static_cast<int>(planes.values.size()), {}, icc, provenance};
  if (bits == 8)
    image.samples = codes<std::uint8_t>(planes, CodeTable(bits));
  else
    image.samples = codes<std::uint16_t>(planes, CodeTable(bits));
  write_tiff(path, image);
}

std::uint16_t pq_code(float linear) {
  return static_cast<std::uint16_t>(65535 * pq_encoded(hdr_white_cd_m2 * double(linear)) + 0.5);
}

void write_png_picture(const std::string& path, const Planes& planes, DisplaySpace space, int bits,
                       const std::string& icc, const std::string& provenance, const CameraFacts& facts) {
  const bool srgb = space == DisplaySpace::srgb, pq = space == DisplaySpace::rec2100_pq;
  PngImage image;
  image.columns = planes.columns;
  image.rows = planes.rows;
  image.channels = static_cast<int>(planes.values.size());
  image.bits = pq ? 16 : bits;
  image.transfer = srgb ? PngTransfer::srgb : pq ? PngTransfer::rec2100_pq : PngTransfer::unstated;
  if (!srgb) image.icc_profile = icc;
  image.text["Description"] = provenance;
  if (facts.exposure_s > 0)
    image.exif =
        exif_of(planes.columns, planes.rows, {.facts = facts, .description = provenance, .srgb = srgb});
  image.samples = pq ? codes<std::uint16_t>(planes, pq_code) : codes<std::uint16_t>(planes, CodeTable(bits));
  write_png(path, image);
}

void write_jpeg_picture(const std::string& path, const Planes& planes, int bits, const std::string& icc,
                        const JpegOptions& options) {
  constexpr int jpeg_bits = 8;
  if (bits != jpeg_bits)
    throw InputError(path, "a .jpg has 8 bits; `bits` 8, or a .png or .tif, would be right");
  JpegImage image{planes.columns, planes.rows, static_cast<int>(planes.values.size()), {}, icc};
  image.samples = codes<std::uint8_t>(planes, CodeTable(bits));
  write_jpeg(path, image, options);
}

std::vector<float> interleaved(const Planes& planes) {
  const std::size_t channels = planes.values.size();
  std::vector<float> values(planes.values[0].size() * channels);
  for (std::size_t i = 0; i < planes.values[0].size(); ++i)
    for (std::size_t k = 0; k < channels; ++k) values[i * channels + k] = planes.values[k][i];
  return values;
}

}  // namespace

const std::vector<std::string>& display_picture_extensions() {
  static const std::vector<std::string> extensions = {".png",  ".jpg", ".jpeg", ".tif",
                                                      ".tiff", ".exr", ".npy",  ".dng"};
  return extensions;
}

void write_display_picture(const std::string& path, const Planes& planes, DisplaySpace space, int bits,
                           const std::string& provenance, const CameraFacts& facts) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const std::size_t channels = planes.values.size();
  if (extension == ".exr") {
    std::vector<ExrPlane> named;
    for (std::size_t i = 0; i < channels; ++i)
      named.push_back({channels == 1   ? "Y"
                       : channels == 3 ? std::string(1, "RGB"[i])
                                       : fmt::format("C{}", i),
                       planes.values[i]});
    return write_plane_exr(path, planes.columns, planes.rows, named, {{"comments", provenance}});
  }
  if (extension == ".npy") {
    const std::size_t shape[] = {static_cast<std::size_t>(planes.rows),
                                 static_cast<std::size_t>(planes.columns), channels};
    return write_npy(path, shape, interleaved(planes));
  }
  if (channels != 1 && channels != 3)
    throw InputError(path, fmt::format("{} planes are written as .exr or .npy", channels));
  const std::string icc = channels == 3 ? icc_profile(space) : std::string();
  if (extension == ".png") return write_png_picture(path, planes, space, bits, icc, provenance, facts);
  if (space == DisplaySpace::rec2100_pq && extension != ".dng")
    throw InputError(path, "Rec. 2100 PQ is written as .png (16 bits), or linear as .exr, .npy or .dng");
  if (extension == ".jpg" || extension == ".jpeg")
    return write_jpeg_picture(
        path, planes, bits, icc,
        {.facts = facts, .description = provenance, .srgb = space == DisplaySpace::srgb});
  if (extension == ".tif" || extension == ".tiff")
    return write_tiff_picture(path, planes, bits, icc, provenance);
  if (extension == ".dng" && channels == 3)
    return write_linear_dng(path, linear_picture(planes, space, provenance, facts));
  throw InputError(path, channels == 3 ? "a picture is written as .png, .jpg, .tif, .exr, .npy or .dng"
                                       : "one plane is written as .png, .jpg, .tif, .exr or .npy");
}

}  // namespace petzval
