// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/tiff_stream.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/sensor/formats/dng_opcodes.h>
#include <petzval/sensor/formats/dng_tags.h>
#include <petzval/sensor/formats/original_raw.h>
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace petzval {

namespace {

constexpr std::uint32_t max_dng_side = 1 << 17;
constexpr std::uint64_t max_expansion = 1032;  // of Deflate
constexpr int max_dng_mosaic_side = 64;

class DngReader {
 public:
  DngReader(const std::string& path, std::string bytes)
      : path_(path), stream_(TiffStream::reader(path, std::move(bytes))), tiff_(stream_.handle()) {}

  RawImage image() {
    const std::uint8_t* version = nullptr;
    if (!TIFFGetField(tiff_, TIFFTAG_DNGVERSION, &version))
      throw InputError(path_, "is no DNG file: it has no DNGVersion");
    read_camera();  // stands in the first directory, whatever that holds
    const std::uint64_t exif = exif_place();
    go_to_raw();
    read_frame();
    read_mosaic();
    read_noise();
    read_levels();
    read_opcodes();
    read_samples();
    if (exif) read_exif(exif);
    stream_.require_whole();
    check_ignored();
    check();
    return std::move(raw_);
  }

 private:
  [[noreturn]] void refuse(const std::string& message) const { throw InputError(path_, message); }

  template <typename Value>
  Value value_or(std::uint32_t tag, Value otherwise) const {
    Value value = otherwise;
    return TIFFGetFieldDefaulted(tiff_, tag, &value) ? value : otherwise;
  }

  // ---- first directory: camera, colour, white balance, noise

  std::vector<double> doubles(std::uint32_t tag, bool wide_count) const {
    std::uint16_t count = 0;
    std::uint32_t wide = 0;
    const float* values = nullptr;
    const int there =
        wide_count ? TIFFGetField(tiff_, tag, &wide, &values) : TIFFGetField(tiff_, tag, &count, &values);
    if (!there || !values) return {};
    const std::size_t held = wide_count ? wide : count;
    return {values, values + held};
  }

  void read_camera() {
    const char* text = nullptr;
    if (TIFFGetField(tiff_, TIFFTAG_MODEL, &text) && text) raw_.sensor_name = text;
    if (TIFFGetField(tiff_, TIFFTAG_IMAGEDESCRIPTION, &text) && text) raw_.provenance = text;
    raw_.as_shot_neutral = doubles(TIFFTAG_ASSHOTNEUTRAL, false);
    const std::uint32_t matrices[] = {TIFFTAG_COLORMATRIX1, TIFFTAG_COLORMATRIX2};
    const std::uint32_t forward[] = {dng::forward_matrix_1_tag, dng::forward_matrix_2_tag};
    const std::uint32_t lights[] = {TIFFTAG_CALIBRATIONILLUMINANT1, TIFFTAG_CALIBRATIONILLUMINANT2};
    for (std::size_t i = 0; i < 2; ++i) {
      ColourCalibration calibration;
      calibration.camera_from_xyz = doubles(matrices[i], false);
      if (calibration.camera_from_xyz.empty()) continue;
      calibration.pcs_from_balanced = doubles(forward[i], true);
      std::uint16_t light = 0;
      TIFFGetField(tiff_, lights[i], &light);
      calibration.exif_light_source = light;
      calibration.temperature_k = temperature_of(light);
      raw_.calibrations.push_back(calibration);
    }
    const char* when = nullptr;
    if (TIFFGetField(tiff_, TIFFTAG_DATETIME, &when) && when) take_date_time(when, "");
    std::uint16_t count = 0;
    const std::uint8_t* own = nullptr;
    if (TIFFGetField(tiff_, TIFFTAG_DNGPRIVATEDATA, &count, &own) && own)
      raw_.shot_noise_share = dng::shot_noise_share(std::string(own, own + count)).value_or(1);
    read_noise();
  }

  /// Is in the first directory or in that of the raw picture.
  void read_noise() {
    std::uint32_t count = 0;
    const double* profile = nullptr;
    if (TIFFGetField(tiff_, dng::noise_profile_tag, &count, &profile) && profile && count >= 2)
      noise_scale_ = profile[0], noise_offset_ = profile[1];
  }

  /// Dates that are none ("0000:00:00 00:00:00") are not known.
  void take_date_time(const std::string& seconds, const std::string& fraction) {
    try {
      raw_.date_time = parse_date_time(fraction.empty() ? seconds : seconds + "." + fraction);
    } catch (const InputError&) {
    }
  }

  /// Of EXIF's light sources.
  static double temperature_of(std::uint16_t light) {
    switch (light) {
      case 3:
      case 17:
        return 2856;
      case 18:
        return 4874;
      case 19:
        return 6774;
      case 20:
        return 5503;
      case 21:
        return 6504;
      case 22:
        return 7504;
      case 23:
        return 5003;
      case 24:
        return 3200;
      default:
        return 5500;
    }
  }

  std::uint64_t exif_place() const {
    std::uint64_t place = 0;
    TIFFGetField(tiff_, TIFFTAG_EXIFIFD, &place);
    return place;
  }

  // ---- the directory of the raw picture

  bool is_raw() const {
    const auto photometric = value_or<std::uint16_t>(TIFFTAG_PHOTOMETRIC, 0);
    return (photometric == dng::colour_filter_array || photometric == dng::linear_raw) &&
           value_or<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0) == 0;
  }

  void go_to_raw() {
    if (is_raw()) return;
    std::uint16_t count = 0;
    const std::uint64_t* places = nullptr;
    std::vector<std::uint64_t> copies;
    if (TIFFGetField(tiff_, TIFFTAG_SUBIFD, &count, &places) && places) copies.assign(places, places + count);
    constexpr std::size_t most = 16;
    copies.resize(std::min(copies.size(), most));
    for (const std::uint64_t place : copies) {
      if (!TIFFSetSubDirectory(tiff_, place)) continue;
      if (is_raw()) return;
    }
    refuse("holds no raw picture (a mosaic, or linear raw of one channel)");
  }

  void read_frame() {
    std::uint32_t columns = 0, rows = 0;
    TIFFGetField(tiff_, TIFFTAG_IMAGEWIDTH, &columns);
    TIFFGetField(tiff_, TIFFTAG_IMAGELENGTH, &rows);
    if (columns < 1 || rows < 1 || columns > max_dng_side || rows > max_dng_side)
      refuse(fmt::format("promises {} x {} pixels; 1 to {} on a side would be right", columns, rows,
                         max_dng_side));
    if (value_or<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1) != 1)
      refuse("has several samples a pixel; a raw picture has one");
    bits_ = value_or<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
    if ((bits_ != 8 && bits_ != 16) ||
        value_or<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT) != SAMPLEFORMAT_UINT)
      refuse(fmt::format("has samples of {} bits; whole numbers of 8 or 16 bits can be read", bits_));
    const auto compression = value_or<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    if (compression != COMPRESSION_NONE && compression != COMPRESSION_ADOBE_DEFLATE)
      refuse(fmt::format("is compressed by method {}; uncompressed and Deflate can be read", compression));
    const std::uint64_t most = stream_.size() * (compression == COMPRESSION_NONE ? 1 : max_expansion);
    if (std::uint64_t{columns} * rows * (bits_ / 8u) > most)
      refuse(fmt::format("promises {} x {} pixels, but the file is too short for them", columns, rows));
    raw_.columns = static_cast<int>(columns);
    raw_.rows = static_cast<int>(rows);
  }

  void read_mosaic() {
    if (value_or<std::uint16_t>(TIFFTAG_PHOTOMETRIC, 0) == dng::linear_raw) {
      raw_.channels = {"grey"};
      return;
    }
    const std::uint16_t* period = nullptr;
    std::uint16_t plane_count = 0, cell_count = 0;
    const std::uint8_t *planes = nullptr, *cells = nullptr;
    if (!TIFFGetField(tiff_, TIFFTAG_CFAREPEATPATTERNDIM, &period) ||
        !TIFFGetField(tiff_, TIFFTAG_CFAPATTERN, &cell_count, &cells))
      refuse("has no CFAPattern");
    raw_.mosaic = {period[0], period[1], {}};
    if (period[0] < 1 || period[1] < 1 || period[0] > max_dng_mosaic_side ||
        period[1] > max_dng_mosaic_side || period[0] * period[1] != cell_count)
      refuse(fmt::format("has a mosaic of {} x {} with {} cells", period[0], period[1], cell_count));
    std::vector<std::uint8_t> numbers = {0, 1, 2};
    if (TIFFGetField(tiff_, TIFFTAG_CFAPLANECOLOR, &plane_count, &planes) && planes)
      numbers.assign(planes, planes + plane_count);
    for (const std::uint8_t number : numbers) raw_.channels.push_back(dng::channel_name(number));
    for (std::uint16_t i = 0; i < cell_count; ++i) {
      const auto found = std::find(numbers.begin(), numbers.end(), cells[i]);
      if (found == numbers.end())
        refuse(fmt::format("has colour {} in its mosaic and not in CFAPlaneColor", cells[i]));
      raw_.mosaic.cells.push_back(static_cast<int>(found - numbers.begin()));
    }
  }

  void read_levels() {
    const std::vector<double> black = doubles(TIFFTAG_BLACKLEVEL, false);
    for (const double level : black)
      if (level != black.front()) refuse("has several black levels; one can be read");
    raw_.black_level = black.empty() ? 0 : black.front();
    raw_.white_level = std::exp2(bits_) - 1;
    std::uint16_t count = 0;
    const std::uint32_t* white = nullptr;
    if (TIFFGetField(tiff_, TIFFTAG_WHITELEVEL, &count, &white) && white && count >= 1)
      raw_.white_level = white[0];
    const std::uint16_t* table = nullptr;
    if (TIFFGetField(tiff_, TIFFTAG_LINEARIZATIONTABLE, &count, &table) && table) {
      raw_.linearization.assign(table, table + count);
      if (!raw_.linearization.empty())  // beyond the table, its last value (DNG 1.4, chapter 5)
        raw_.linearization.resize(std::size_t{1} << bits_, raw_.linearization.back());
    }
    const double range = raw_.white_level - raw_.black_level;
    if (noise_scale_ > 0 && noise_offset_ >= 0 && std::isfinite(noise_scale_) &&
        std::isfinite(noise_offset_)) {
      raw_.dn_per_e = noise_scale_ * range / raw_.shot_noise_share;
      raw_.read_noise_e = std::sqrt(noise_offset_) * range / raw_.dn_per_e;
    }
  }

  void read_opcodes() {
    const auto list = [&](std::uint32_t tag) {
      std::uint32_t count = 0;
      const std::uint8_t* bytes = nullptr;
      const bool there = TIFFGetField(tiff_, tag, &count, &bytes) && bytes;
      return there ? std::span(bytes, count) : std::span<const std::uint8_t>();
    };
    try {
      if (const auto samples = list(dng::opcode_list_1_tag); !samples.empty())
        dng::take_sample_opcodes(samples, raw_);
      if (const auto values = list(dng::opcode_list_2_tag); !values.empty())
        dng::take_value_opcodes(values, raw_);
      if (const auto picture = list(dng::opcode_list_3_tag); !picture.empty())
        dng::take_picture_opcodes(picture, raw_);
    } catch (const InputError& error) {
      refuse(std::string("has ") + error.what());
    }
  }

  // ---- samples

  struct Blocks {
    std::uint32_t columns, rows;
    tmsize_t bytes;
    bool tiled;
  };

  Blocks blocks() const {
    Blocks blocks{static_cast<std::uint32_t>(raw_.columns), 0, 0, TIFFIsTiled(tiff_) != 0};
    if (blocks.tiled) {
      TIFFGetField(tiff_, TIFFTAG_TILEWIDTH, &blocks.columns);
      TIFFGetField(tiff_, TIFFTAG_TILELENGTH, &blocks.rows);
      blocks.bytes = TIFFTileSize(tiff_);
    } else {
      TIFFGetFieldDefaulted(tiff_, TIFFTAG_ROWSPERSTRIP, &blocks.rows);
      blocks.rows = std::min(blocks.rows, static_cast<std::uint32_t>(raw_.rows));
      blocks.bytes = TIFFStripSize(tiff_);
    }
    const std::uint64_t expected = std::uint64_t{blocks.columns} * blocks.rows * (bits_ / 8u);
    const std::uint64_t most = max_expansion * stream_.size();
    if (expected == 0 || expected > most || blocks.bytes != static_cast<tmsize_t>(expected))
      refuse("has strips or tiles of an impossible size");
    return blocks;
  }

  void read_samples() {
    const Blocks block = blocks();
    const auto columns = static_cast<std::uint32_t>(raw_.columns),
               rows = static_cast<std::uint32_t>(raw_.rows);
    raw_.samples.resize(std::size_t{columns} * rows);
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(block.bytes));
    std::uint32_t index = 0;
    for (std::uint32_t top = 0; top < rows; top += block.rows)
      for (std::uint32_t left = 0; left < columns; left += block.columns, ++index) {
        const std::uint32_t height = block.tiled ? block.rows : std::min(block.rows, rows - top);
        const auto wanted = static_cast<tmsize_t>(std::uint64_t{block.columns} * height * (bits_ / 8u));
        const tmsize_t got = block.tiled ? TIFFReadEncodedTile(tiff_, index, bytes.data(), block.bytes)
                                         : TIFFReadEncodedStrip(tiff_, index, bytes.data(), wanted);
        if (got != wanted) stream_.fail("a strip or tile ends too early");
        place(bytes, block, left, top);
      }
  }

  void place(const std::vector<std::uint8_t>& bytes, const Blocks& block, std::uint32_t left,
             std::uint32_t top) {
    const auto columns = static_cast<std::uint32_t>(raw_.columns),
               rows = static_cast<std::uint32_t>(raw_.rows);
    const std::uint32_t width = std::min(block.columns, columns - left);
    for (std::uint32_t r = 0; r < std::min(block.rows, rows - top); ++r) {
      const std::uint8_t* from = bytes.data() + std::size_t{r} * block.columns * (bits_ / 8u);
      std::uint16_t* into = raw_.samples.data() + std::size_t{top + r} * columns + left;
      if (bits_ == 8)
        std::copy_n(from, width, into);
      else
        std::memcpy(into, from, 2 * std::size_t{width});
    }
  }

  void read_exif(std::uint64_t place) {
    stream_.require(TIFFReadEXIFDirectory(tiff_, place) != 0);
    const auto number = [&](std::uint32_t tag) {
      // libtiff hands out fractions of EXIF as float or as double, and says which.
      const TIFFField* field = TIFFFieldWithTag(tiff_, tag);
      const bool wide = field && TIFFFieldSetGetSize(field) == sizeof(double);
      double value = 0;
      float narrow = 0;
      const bool there = wide ? TIFFGetField(tiff_, tag, &value) : TIFFGetField(tiff_, tag, &narrow);
      if (!wide) value = static_cast<double>(narrow);
      return there && std::isfinite(value) && value > 0 ? value : 0.0;
    };
    raw_.exposure_s = number(EXIFTAG_EXPOSURETIME);
    raw_.lens.f_number = number(EXIFTAG_FNUMBER);
    raw_.lens.focal_length_mm = number(EXIFTAG_FOCALLENGTH);
    // 1: none, 2: inches, 3: centimetres, 4: mm, 5: µm.
    constexpr double um_per_unit[] = {0, 0, 25400, 1e4, 1e3, 1};
    std::uint16_t unit = 2;
    TIFFGetField(tiff_, EXIFTAG_FOCALPLANERESOLUTIONUNIT, &unit);
    if (const double density = number(EXIFTAG_FOCALPLANEXRESOLUTION); density > 0 && unit < 6)
      raw_.pitch_um = um_per_unit[unit] / density;
    std::uint16_t count = 0;
    const std::uint16_t* iso = nullptr;
    if (TIFFGetField(tiff_, EXIFTAG_ISOSPEEDRATINGS, &count, &iso) && iso && count >= 1) raw_.iso = iso[0];
    const auto text = [&](std::uint32_t tag) {
      const char* value = nullptr;
      return TIFFGetField(tiff_, tag, &value) && value ? std::string(value) : std::string();
    };
    raw_.lens.name = text(EXIFTAG_LENSMODEL);
    take_date_time(text(EXIFTAG_DATETIMEORIGINAL), text(EXIFTAG_SUBSECTIMEORIGINAL));
  }

  /// A black level that libtiff ignored would be 0.
  void check_ignored() const {
    for (const std::string& tag : stream_.ignored_tags())
      for (const char* const matters :
           {"AsShotNeutral", "BlackLevel", "CFAPattern", "CFAPlaneColor", "CFARepeatPatternDim",
            "CalibrationIlluminant1", "CalibrationIlluminant2", "ColorMatrix1", "ColorMatrix2",
            "ForwardMatrix1", "ForwardMatrix2", "LinearizationTable", "NoiseProfile", "WhiteLevel"})
        if (tag == matters) refuse(fmt::format("has a {} that cannot be read", tag));
  }

  void check() {
    const std::size_t channels = raw_.channels.size();
    if (channels == 1) raw_.as_shot_neutral.clear();
    try {
      raw_.validate();
    } catch (const InputError& error) {
      refuse(std::string("holds ") + error.what());
    }
    for (const ColourCalibration& calibration : raw_.calibrations)
      for (const auto* values : {&calibration.camera_from_xyz, &calibration.pcs_from_balanced})
        for (const double value : *values)
          if (!std::isfinite(value)) refuse("has a colour matrix that is no matrix of numbers");
  }

  std::string path_;
  TiffStream stream_;
  TIFF* tiff_;
  RawImage raw_;
  std::uint16_t bits_ = 16;
  double noise_scale_ = 0, noise_offset_ = 0;
};

}  // namespace

RawImage parse_dng(std::string bytes, const std::string& path) {
  dng::register_tags();
  try {
    // A picture for other programs, with the mosaic in it.
    if (std::optional<std::string> original = original_raw(bytes)) bytes = std::move(*original);
  } catch (const InputError& error) {
    throw InputError(path, std::string("has ") + error.what());
  }
  return DngReader(path, std::move(bytes)).image();
}

RawImage read_dng(const std::string& path) {
  return parse_dng(read_whole_file(path), path);
}

}  // namespace petzval
