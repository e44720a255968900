// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/colour/rec2100.h>
#include <petzval/image/colour_profile.h>
#include <petzval/image/formats/jpeg.h>
#include <petzval/image/formats/png.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/image/photograph.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <variant>

namespace petzval {

namespace {

/// A picture as its file holds it.
struct StoredPicture {
  int columns = 0, rows = 0, channels = 3;
  std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> samples;
  double white = 255;   ///< the sample that is white
  bool linear = false;  ///< the file says so
  PngTransfer transfer = PngTransfer::unstated;
  std::string icc_profile;
  int orientation = upright_orientation;
};

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

enum class PictureKind { png, jpeg, tiff };

/// By the first bytes: names lie.
PictureKind kind_of(const std::string& path) {
  using namespace std::string_view_literals;
  std::ifstream file(path, std::ios::binary);
  std::array<char, 4> start{};
  file.read(start.data(), start.size());
  const std::string_view bytes(start.data(), static_cast<std::size_t>(file.gcount()));
  if (bytes == "\x89PNG"sv) return PictureKind::png;
  if (bytes.starts_with("\xFF\xD8"sv)) return PictureKind::jpeg;
  if (bytes == "II*\0"sv || bytes == "MM\0*"sv || bytes == "II+\0"sv || bytes == "MM\0+"sv)
    return PictureKind::tiff;
  throw InputError(path, "is no photograph: neither PNG, JPEG nor TIFF");
}

StoredPicture read_stored(const std::string& path) {
  const PictureKind kind = kind_of(path);
  StoredPicture picture;
  const auto take = [&](auto& image) {
    picture.columns = image.columns, picture.rows = image.rows, picture.channels = image.channels;
    picture.samples = std::move(image.samples);
    picture.icc_profile = std::move(image.icc_profile);
  };
  if (kind == PictureKind::png) {
    PngImage png = read_png(path);
    take(png);
    picture.white = png.bits == 8 ? 255 : 65535;
    picture.linear = png.transfer == PngTransfer::linear;
    picture.transfer = png.transfer;
  } else if (kind == PictureKind::jpeg) {
    JpegImage jpeg = read_jpeg(path);
    take(jpeg);
    picture.orientation = jpeg.orientation;
  } else {
    TiffImage tiff = read_tiff(path);
    picture.linear = std::holds_alternative<std::vector<float>>(tiff.samples);
    picture.white = picture.linear                                                    ? 1
                    : std::holds_alternative<std::vector<std::uint8_t>>(tiff.samples) ? 255
                                                                                      : 65535;
    const int orientation = tiff.orientation;
    take(tiff);
    picture.orientation = orientation;
  }
  return picture;
}

/// From the samples of one row to linear sRGB.
class RowToLinear {
 public:
  RowToLinear(const StoredPicture& picture, PhotographEncoding encoding, const std::string& path)
      : picture_(picture), colours_(picture.channels <= 2 ? 1 : 3) {
    const bool by_file = encoding == PhotographEncoding::by_file;
    if (by_file && picture.transfer == PngTransfer::other)
      throw InputError(
          path,
          "is coded in a way that its chunk cICP states and Petzval does not read; sRGB, or ITU-R "
          "BT.2100 with PQ or HLG in full range, would be right");
    pq_ = by_file && picture.transfer == PngTransfer::rec2100_pq;
    hlg_ = by_file && picture.transfer == PngTransfer::rec2100_hlg;
    if (pq_ || hlg_) {  // comes before a colour profile
      for (double sample = 0; sample <= picture.white; ++sample)
        decoded_.push_back(static_cast<float>(pq_ ? pq_decoded(sample / picture.white)
                                                  : hlg_decoded(sample / picture.white)));
      return;
    }
    if (by_file && !picture.icc_profile.empty()) {
      profile_.emplace(picture.icc_profile, path);
      if (profile_->channels() < colours_)
        throw InputError(path,
                         "is in colour, but its colour profile is for grey; `scene.encoding` srgb takes "
                         "its numbers as sRGB");
      return;
    }
    srgb_ = encoding == PhotographEncoding::srgb || (by_file && !picture.linear);
    if (srgb_ && picture.white > 1)
      for (double sample = 0; sample <= picture.white; ++sample)
        decoded_.push_back(static_cast<float>(srgb_decoded(sample / picture.white)));
  }

  void operator()(std::size_t row, std::span<float> rgb) const {
    std::visit([&](const auto& samples) { convert(samples, row, rgb); }, picture_.samples);
  }

 private:
  template <typename Sample>
  float value(Sample sample) const {
    if constexpr (std::is_integral_v<Sample>) {
      if (!decoded_.empty()) return decoded_[sample];
    } else if (srgb_) {
      return static_cast<float>(srgb_decoded(sample));
    }
    return static_cast<float>(sample / picture_.white);
  }

  /// From decoded values of BT.2100 to linear sRGB, of which 1 is diffuse white.
  void from_rec2100(std::span<float> rgb) const {
    static const ColourMatrix srgb_from_rec2020 = srgb_from_xyz() * xyz_from_rec2020();
    for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
      LinearRgb light{double(rgb[i]), double(rgb[i + 1]), double(rgb[i + 2])};
      if (hlg_) light = hlg_displayed(light);
      const Xyz seen = srgb_from_rec2020 * Xyz{light.r, light.g, light.b};
      rgb[i] = static_cast<float>(seen.x / hdr_white_cd_m2);
      rgb[i + 1] = static_cast<float>(seen.y / hdr_white_cd_m2);
      rgb[i + 2] = static_cast<float>(seen.z / hdr_white_cd_m2);
    }
  }

  template <typename Sample>
  void convert(const std::vector<Sample>& samples, std::size_t row, std::span<float> rgb) const {
    const std::size_t columns = rgb.size() / 3, channels = static_cast<std::size_t>(picture_.channels);
    const Sample* from = samples.data() + row * columns * channels;
    const std::size_t wanted = profile_ ? profile_->channels() : 3;
    std::vector<float> values(columns * wanted);
    for (std::size_t i = 0; i < columns; ++i)
      for (std::size_t c = 0; c < wanted; ++c)
        values[i * wanted + c] = value(from[i * channels + (colours_ == 1 ? 0 : c)]);
    if (profile_) return (*profile_)(values, rgb);
    std::copy(values.begin(), values.end(), rgb.begin());
    if (pq_ || hlg_) from_rec2100(rgb);
  }

  const StoredPicture& picture_;
  std::size_t colours_;
  bool srgb_ = false, pq_ = false, hlg_ = false;
  std::vector<float> decoded_;  ///< by samples of whole numbers; empty: they are as they are
  std::optional<ProfileToLinear> profile_;
};

void check_values(const Photograph& photograph, const std::string& path) {
  const auto bad = std::find_if(photograph.rgb.begin(), photograph.rgb.end(),
                                [](float value) { return !std::isfinite(value); });
  if (bad == photograph.rgb.end()) return;
  const auto pixel = static_cast<std::size_t>(bad - photograph.rgb.begin()) / 3;
  const auto width = static_cast<std::size_t>(photograph.columns);
  throw InputError(path, fmt::format("holds {} at row {}, column {}; finite numbers would be right", *bad,
                                     pixel / width, pixel % width));
}

/// Turns a picture upright (Exif 2.3, Orientation).
Photograph upright(Photograph stored, int orientation) {
  if (orientation == upright_orientation) return stored;
  const bool swapped = orientation >= 5;  // rows of the one are columns of the other
  // Which of the stored sides is the far one of the upright picture.
  const bool from_right = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool from_bottom = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  Photograph picture{swapped ? stored.rows : stored.columns, swapped ? stored.columns : stored.rows, {}};
  picture.rgb.resize(stored.rgb.size());
  for (int row = 0; row < picture.rows; ++row)
    for (int column = 0; column < picture.columns; ++column) {
      int x = swapped ? row : column, y = swapped ? column : row;
      if (from_right) x = stored.columns - 1 - x;
      if (from_bottom) y = stored.rows - 1 - y;
      const float* from = stored.row(y).data() + 3 * x;
      std::copy(from, from + 3, picture.rgb.begin() + 3 * (std::ptrdiff_t{row} * picture.columns + column));
    }
  return picture;
}

}  // namespace

bool has_photograph_name(const std::string& path) {
  const std::string extension = lower_extension(path);
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg" || extension == ".tif" ||
         extension == ".tiff";
}

Photograph read_photograph(const std::string& path, PhotographEncoding encoding) {
  const StoredPicture stored = read_stored(path);
  const RowToLinear to_linear(stored, encoding, path);
  Photograph photograph{stored.columns, stored.rows, {}};
  photograph.rgb.resize(3 * photograph.pixels());
  const std::size_t row_size = 3 * static_cast<std::size_t>(stored.columns);
  parallel_for(static_cast<std::size_t>(stored.rows), [&](std::size_t row) {
    to_linear(row, std::span<float>(photograph.rgb).subspan(row * row_size, row_size));
  });
  check_values(photograph, path);
  return upright(std::move(photograph), stored.orientation);
}

}  // namespace petzval
