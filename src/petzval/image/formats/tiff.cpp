// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/tiff.h>
#include <petzval/image/formats/tiff_stream.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <type_traits>

namespace petzval {

namespace {

constexpr int max_tiff_side = 1 << 20;
constexpr int max_channels = 512;
constexpr std::size_t max_samples = std::size_t{1} << 31;
// No supported compression makes more of one byte: LZW reaches about 2700, Deflate 1032.
constexpr std::size_t max_tiff_expansion = 4000;
constexpr std::size_t strip_bytes = 1 << 16;

// ---- writing

void check(const std::string& path, const TiffImage& image) {
  if (image.columns < 1 || image.rows < 1 || image.columns > max_tiff_side || image.rows > max_tiff_side)
    throw InputError(path, fmt::format("a picture of {} x {} pixels; each side must be 1 to {}",
                                       image.columns, image.rows, max_tiff_side));
  if (image.channels < 1 || image.channels > max_channels)
    throw InputError(
        path, fmt::format("a TIFF of {} channels; 1 to {} would be right", image.channels, max_channels));
  const std::size_t held = std::visit([](const auto& samples) { return samples.size(); }, image.samples);
  if (held != image.sample_count())
    throw InputError(path, fmt::format("{} samples for a picture of {} x {} x {}", held, image.columns,
                                       image.rows, image.channels));
}

void set_layout(const TiffStream& stream, const TiffImage& image, int bits, bool is_float,
                std::uint32_t rows_per_strip) {
  TIFF* tiff = stream.handle();
  const bool rgb = image.channels >= 3;
  stream.require(
      TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, image.columns) &&
      TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, image.rows) &&
      TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, image.channels) &&
      TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits) &&
      TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, is_float ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT) &&
      TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) &&
      TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE) &&
      TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, rgb ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK) &&
      TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) &&
      TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, rows_per_strip));
  // Every TIFF picture must state a resolution; this one says that there is none.
  stream.require(TIFFSetField(tiff, TIFFTAG_XRESOLUTION, 1.0) &&
                 TIFFSetField(tiff, TIFFTAG_YRESOLUTION, 1.0) &&
                 TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE));
  const std::vector<std::uint16_t> extra(static_cast<std::size_t>(image.channels - (rgb ? 3 : 1)),
                                         EXTRASAMPLE_UNSPECIFIED);
  if (!extra.empty())
    stream.require(TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, static_cast<int>(extra.size()), extra.data()));
  if (!image.icc_profile.empty())
    stream.require(TIFFSetField(tiff, TIFFTAG_ICCPROFILE,
                                static_cast<std::uint32_t>(image.icc_profile.size()),
                                image.icc_profile.data()));
  if (!image.description.empty())
    stream.require(TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, image.description.c_str()));
}

template <typename Sample>
std::string tiff_bytes(const std::string& path, const TiffImage& image, const std::vector<Sample>& samples) {
  TiffStream stream(path, samples.size() * sizeof(Sample));
  const std::size_t row_samples =
      static_cast<std::size_t>(image.columns) * static_cast<std::size_t>(image.channels);
  const std::size_t rows_per_strip = std::max<std::size_t>(1, strip_bytes / (row_samples * sizeof(Sample)));
  set_layout(stream, image, 8 * sizeof(Sample), std::is_floating_point_v<Sample>,
             static_cast<std::uint32_t>(rows_per_strip));
  const auto rows = static_cast<std::size_t>(image.rows);
  for (std::size_t row = 0, strip = 0; row < rows; row += rows_per_strip, ++strip) {
    const std::size_t count = std::min(rows_per_strip, rows - row) * row_samples;
    // libtiff does not write to what it is given here, since bytes are not swapped.
    void* const data = const_cast<Sample*>(samples.data() + row * row_samples);
    stream.require(TIFFWriteRawStrip(stream.handle(), static_cast<std::uint32_t>(strip), data,
                                     static_cast<tmsize_t>(count * sizeof(Sample))) >= 0);
  }
  return stream.finish();
}

// ---- reading

/// What the tags say, checked.
struct Layout {
  std::uint32_t columns = 0, rows = 0;
  std::uint16_t channels = 1, bits = 1, format = SAMPLEFORMAT_UINT, planes = PLANARCONFIG_CONTIG,
                photometric = PHOTOMETRIC_MINISBLACK, compression = COMPRESSION_NONE;
  bool tiled = false;
  std::uint32_t block_columns = 0, block_rows = 0;  ///< of a tile or strip

  std::size_t sample_bytes() const { return bits / 8u; }
  std::size_t planes_held() const { return planes == PLANARCONFIG_SEPARATE ? channels : 1u; }
  std::size_t channels_in_block() const { return planes == PLANARCONFIG_SEPARATE ? 1u : channels; }
};

Layout read_layout(const TiffStream& stream) {
  TIFF* tiff = stream.handle();
  Layout layout;
  if (!TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &layout.columns) ||
      !TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &layout.rows))
    stream.fail("the size of the picture is missing");
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &layout.channels);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &layout.bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &layout.format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &layout.planes);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &layout.compression);
  if (!TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &layout.photometric))
    stream.fail("the photometric tag is missing");
  layout.tiled = TIFFIsTiled(tiff) != 0;
  if (layout.tiled) {
    TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &layout.block_columns);
    TIFFGetField(tiff, TIFFTAG_TILELENGTH, &layout.block_rows);
  } else {
    layout.block_columns = layout.columns;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_ROWSPERSTRIP, &layout.block_rows);
    layout.block_rows = std::min(layout.block_rows, layout.rows);
  }
  return layout;
}

void check_kind(const std::string& path, const Layout& layout) {
  const bool whole = layout.format == SAMPLEFORMAT_UINT && (layout.bits == 8 || layout.bits == 16);
  if (!whole && !(layout.format == SAMPLEFORMAT_IEEEFP && layout.bits == 32))
    throw InputError(path,
                     fmt::format("has samples of {} bits (format {}); 8- and 16-bit whole numbers and 32-bit "
                                 "floating point can be read",
                                 layout.bits, layout.format));
  constexpr std::array compressions = {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE,
                                       COMPRESSION_DEFLATE, COMPRESSION_PACKBITS};
  if (std::find(compressions.begin(), compressions.end(), layout.compression) == compressions.end())
    throw InputError(path,
                     fmt::format("is compressed by method {}; none, LZW, Deflate and PackBits can be read",
                                 layout.compression));
  constexpr std::array kinds = {PHOTOMETRIC_MINISBLACK, PHOTOMETRIC_MINISWHITE, PHOTOMETRIC_RGB};
  if (std::find(kinds.begin(), kinds.end(), layout.photometric) == kinds.end())
    throw InputError(path,
                     fmt::format("is of photometric kind {}; grey and RGB can be read", layout.photometric));
  if (layout.photometric == PHOTOMETRIC_RGB && layout.channels < 3)
    throw InputError(path, fmt::format("is RGB with {} channels", layout.channels));
}

void check_sizes(const TiffStream& stream, const Layout& layout) {
  const auto within = [](std::uint64_t value, std::uint64_t most) { return value >= 1 && value <= most; };
  if (!within(layout.columns, max_tiff_side) || !within(layout.rows, max_tiff_side) ||
      !within(layout.channels, max_channels))
    throw InputError(stream.path(),
                     fmt::format("promises {} x {} pixels of {} channels; sides must be 1 to {}, "
                                 "channels 1 to {}",
                                 layout.columns, layout.rows, layout.channels, max_tiff_side, max_channels));
  const std::uint64_t samples = std::uint64_t{layout.columns} * layout.rows * layout.channels;
  const std::uint64_t block = std::uint64_t{layout.block_columns} * layout.block_rows *
                              layout.channels_in_block() * layout.sample_bytes();
  const std::uint64_t most =
      stream.size() * (layout.compression == COMPRESSION_NONE ? 1 : max_tiff_expansion);
  if (samples > max_samples || samples * layout.sample_bytes() > most || block > 2 * most || block == 0)
    throw InputError(stream.path(), fmt::format("promises {} x {} pixels, but the file is too short for them",
                                                layout.columns, layout.rows));
}

/// Copies what a tile or strip holds of the picture to its place.
template <typename Sample>
void place(const Layout& layout, const Sample* block, std::uint32_t left, std::uint32_t top,
           std::size_t plane, std::vector<Sample>& samples) {
  const std::size_t channels = layout.channels, inside = layout.channels_in_block();
  const std::uint32_t columns = std::min(layout.block_columns, layout.columns - left);
  const std::uint32_t rows = std::min(layout.block_rows, layout.rows - top);
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column)
      for (std::size_t c = 0; c < inside; ++c)
        samples[(std::size_t{top + row} * layout.columns + left + column) * channels + plane + c] =
            block[(std::size_t{row} * layout.block_columns + column) * inside + c];
}

template <typename Sample>
std::vector<Sample> read_samples(const TiffStream& stream, const Layout& layout) {
  std::vector<Sample> samples(std::size_t{layout.columns} * layout.rows * layout.channels);
  std::vector<Sample> block(std::size_t{layout.block_columns} * layout.block_rows *
                            layout.channels_in_block());
  const tmsize_t needed = layout.tiled ? TIFFTileSize(stream.handle()) : TIFFStripSize(stream.handle());
  if (needed != static_cast<tmsize_t>(block.size() * sizeof(Sample)))
    stream.fail("its blocks have another size");
  std::uint32_t index = 0;
  for (std::size_t plane = 0; plane < layout.planes_held(); ++plane)
    for (std::uint32_t top = 0; top < layout.rows; top += layout.block_rows)
      for (std::uint32_t left = 0; left < layout.columns; left += layout.block_columns, ++index) {
        const tmsize_t got = layout.tiled ? TIFFReadEncodedTile(stream.handle(), index, block.data(), needed)
                                          : TIFFReadEncodedStrip(stream.handle(), index, block.data(), -1);
        const std::uint64_t rows =
            layout.tiled ? layout.block_rows : std::min(layout.block_rows, layout.rows - top);
        const auto wanted = static_cast<tmsize_t>(rows * std::uint64_t{layout.block_columns} *
                                                  layout.channels_in_block() * sizeof(Sample));
        if (got != wanted) stream.fail("a strip or tile ends too early");
        place(layout, block.data(), left, top, plane, samples);
      }
  if (layout.photometric == PHOTOMETRIC_MINISWHITE)
    for (std::size_t i = 0; i < samples.size(); i += layout.channels)
      samples[i] = static_cast<Sample>((std::is_integral_v<Sample> ? std::numeric_limits<Sample>::max() : 1) -
                                       samples[i]);
  return samples;
}

TiffImage::Samples read_any_samples(const TiffStream& stream, const Layout& layout) {
  if (layout.bits == 8) return read_samples<std::uint8_t>(stream, layout);
  if (layout.bits == 16) return read_samples<std::uint16_t>(stream, layout);
  return read_samples<float>(stream, layout);
}

}  // namespace

void write_tiff(const std::string& path, const TiffImage& image) {
  check(path, image);
  write_whole_file(
      path, std::visit([&](const auto& samples) { return tiff_bytes(path, image, samples); }, image.samples));
}

TiffImage read_tiff(const std::string& path) {
  const TiffStream stream = TiffStream::reader(path, read_whole_file(path));
  stream.require_whole();
  const Layout layout = read_layout(stream);
  check_kind(path, layout);
  check_sizes(stream, layout);
  TiffImage image{static_cast<int>(layout.columns),
                  static_cast<int>(layout.rows),
                  layout.channels,
                  read_any_samples(stream, layout),
                  {},
                  {}};
  std::uint32_t profile_bytes = 0;
  const void* profile = nullptr;
  if (TIFFGetField(stream.handle(), TIFFTAG_ICCPROFILE, &profile_bytes, &profile))
    image.icc_profile.assign(static_cast<const char*>(profile), profile_bytes);
  const char* description = nullptr;
  if (TIFFGetField(stream.handle(), TIFFTAG_IMAGEDESCRIPTION, &description) && description)
    image.description = description;
  std::uint16_t orientation = ORIENTATION_TOPLEFT;
  if (TIFFGetField(stream.handle(), TIFFTAG_ORIENTATION, &orientation) &&
      orientation >= ORIENTATION_TOPLEFT && orientation <= ORIENTATION_LEFTBOT)
    image.orientation = orientation;
  return image;
}

}  // namespace petzval
