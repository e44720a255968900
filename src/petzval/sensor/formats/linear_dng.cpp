// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/version.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/tiff_stream.h>
#include <petzval/sensor/formats/dng_tags.h>
#include <petzval/sensor/formats/linear_dng.h>
#include <tiffio.h>

#include <algorithm>

namespace petzval {

namespace {

constexpr std::size_t primaries = 3;

/// A file being written.
class LinearDngWriter {
 public:
  LinearDngWriter(const std::string& path, const LinearPicture& picture)
      : picture_(picture), stream_(path, 2 * picture.samples.size()), tiff_(stream_.handle()) {}

  std::string bytes() {
    set_picture();
    set_camera();
    set_levels_and_colour();
    write_strips();
    stream_.require(TIFFWriteDirectory(tiff_) != 0);
    return stream_.finish();
  }

 private:
  template <typename... Values>
  void set(std::uint32_t tag, Values... values) {
    stream_.require(TIFFSetField(tiff_, tag, values...) != 0);
  }

  std::size_t row_samples() const { return primaries * static_cast<std::size_t>(picture_.columns); }
  std::size_t rows_per_strip() const {
    constexpr std::size_t strip_bytes = 1 << 18;
    return std::max<std::size_t>(1, strip_bytes / (2 * row_samples()));
  }

  void set_picture() {
    set(TIFFTAG_SUBFILETYPE, 0);
    set(TIFFTAG_IMAGEWIDTH, picture_.columns);
    set(TIFFTAG_IMAGELENGTH, picture_.rows);
    set(TIFFTAG_BITSPERSAMPLE, 16);
    set(TIFFTAG_SAMPLESPERPIXEL, static_cast<int>(primaries));
    set(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    set(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    set(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    set(TIFFTAG_PHOTOMETRIC, static_cast<int>(dng::linear_raw));
    set(TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(rows_per_strip()));
  }

  void set_camera() {
    const std::uint8_t written_for[] = {1, 4, 0, 0}, backward[] = {1, 1, 0, 0};
    set(TIFFTAG_DNGVERSION, written_for);
    set(TIFFTAG_DNGBACKWARDVERSION, backward);
    set(TIFFTAG_MAKE, "Petzval");
    set(TIFFTAG_MODEL, picture_.model.c_str());
    set(TIFFTAG_UNIQUECAMERAMODEL, ("Petzval " + picture_.model).c_str());
    set(TIFFTAG_SOFTWARE, fmt::format("petzval {}", version()).c_str());
    if (!picture_.provenance.empty()) set(TIFFTAG_IMAGEDESCRIPTION, picture_.provenance.c_str());
  }

  void set_levels_and_colour() {
    const std::vector<float> neutral(primaries, 1);
    const std::vector<std::uint32_t> white(primaries, 65535);
    set(TIFFTAG_WHITELEVEL, static_cast<int>(primaries), white.data());
    constexpr int exif_d65 = 21;
    set(TIFFTAG_CALIBRATIONILLUMINANT1, exif_d65);
    const std::vector<float> matrix(picture_.rgb_from_xyz.begin(), picture_.rgb_from_xyz.end());
    set(TIFFTAG_COLORMATRIX1, static_cast<int>(matrix.size()), matrix.data());
    set(TIFFTAG_ASSHOTNEUTRAL, static_cast<int>(primaries), neutral.data());
  }

  void write_strips() {
    const auto rows = static_cast<std::size_t>(picture_.rows);
    for (std::size_t row = 0, strip = 0; row < rows; row += rows_per_strip(), ++strip) {
      const std::size_t count = std::min(rows_per_strip(), rows - row) * row_samples();
      // libtiff does not write to it: bytes are not swapped.
      void* const data = const_cast<std::uint16_t*>(picture_.samples.data() + row * row_samples());
      stream_.require(TIFFWriteRawStrip(tiff_, static_cast<std::uint32_t>(strip), data,
                                        static_cast<tmsize_t>(2 * count)) >= 0);
    }
  }

  const LinearPicture& picture_;
  TiffStream stream_;
  TIFF* tiff_;
};

}  // namespace

std::string linear_dng_bytes(const LinearPicture& picture, const std::string& path) {
  if (picture.columns < 1 || picture.rows < 1 ||
      picture.samples.size() !=
          primaries * static_cast<std::size_t>(picture.columns) * static_cast<std::size_t>(picture.rows))
    throw InputError(path, fmt::format("{} samples for a picture of {} x {} x {}", picture.samples.size(),
                                       picture.columns, picture.rows, primaries));
  dng::register_tags();
  return LinearDngWriter(path, picture).bytes();
}

void write_linear_dng(const std::string& path, const LinearPicture& picture) {
  write_whole_file(path, linear_dng_bytes(picture, path));
}

}  // namespace petzval
