// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/version.h>
#include <petzval/base/whole_file.h>
#include <petzval/colour/display.h>
#include <petzval/image/formats/tiff_stream.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/sensor/formats/dng_opcodes.h>
#include <petzval/sensor/formats/dng_tags.h>
#include <petzval/sensor/formats/linear_dng.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace petzval {

namespace {

constexpr std::size_t strip_bytes = 1 << 18;

/// A small picture, 8 bits of red, green and blue, for who only looks.
struct Preview {
  std::uint32_t columns = 1, rows = 1;
  std::vector<std::uint8_t> samples = {};
};

/// Means of squares of pixels, white balanced, in the curve of display; grey if the channels are no
/// primaries.
Preview preview_of(const RawImage& raw, int samples_per_pixel) {
  constexpr int longest = 256;
  const int step = std::max(
      {2, raw.mosaic.rows, raw.mosaic.columns, (std::max(raw.columns, raw.rows) + longest - 1) / longest});
  const int columns = std::max(1, raw.columns / step), rows = std::max(1, raw.rows / step);
  Preview preview{static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows), {}};
  const std::size_t channels = raw.channels.size();
  std::array<std::size_t, 3> primaries = {};
  bool coloured = true;
  for (std::size_t k = 0; k < primaries.size(); ++k) {
    const char* const names[] = {"red", "green", "blue"};
    const auto found = std::find(raw.channels.begin(), raw.channels.end(), names[k]);
    coloured = coloured && found != raw.channels.end();
    primaries[k] = static_cast<std::size_t>(found - raw.channels.begin());
  }
  preview.samples.resize(3 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  parallel_for(static_cast<std::size_t>(rows), [&](std::size_t row) {
    for (int column = 0; column < columns; ++column) {
      std::vector<double> sums(channels), counts(channels);
      const int top = static_cast<int>(row) * step, left = column * step;
      for (int r = top; r < std::min(raw.rows, top + step); ++r)
        for (int c = left; c < std::min(raw.columns, left + step); ++c)
          for (int k = 0; k < samples_per_pixel; ++k) {
            const auto channel =
                static_cast<std::size_t>(samples_per_pixel > 1 ? k : raw.mosaic.channel(r, c));
            const std::uint16_t stored =
                raw.samples[(static_cast<std::size_t>(r) * static_cast<std::size_t>(raw.columns) +
                             static_cast<std::size_t>(c)) *
                                static_cast<std::size_t>(samples_per_pixel) +
                            static_cast<std::size_t>(k)];
            sums[channel] += raw.linearization.empty() ? stored : raw.linearization[stored];
            ++counts[channel];
          }
      double grey = 0;
      for (std::size_t k = 0; k < channels; ++k) {
        sums[k] =
            (sums[k] / std::max(1.0, counts[k]) - raw.black_level) / (raw.white_level - raw.black_level);
        grey += sums[k] / static_cast<double>(channels);
        if (k < raw.as_shot_neutral.size() && raw.as_shot_neutral[k] > 0) sums[k] /= raw.as_shot_neutral[k];
      }
      for (std::size_t k = 0; k < primaries.size(); ++k)
        preview
            .samples[3 * (row * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)) + k] =
            quantised_8(srgb_encoded(coloured ? sums[primaries[k]] : grey));
    }
  });
  return preview;
}

/// libtiff gives the place of a directory a type of its own (IFD); cameras write it as a number (LONG), which
/// is what exiftool's validation asks for. A BigTIFF stays as it is.
std::string with_plain_place(std::string tiff) {
  constexpr char type_ifd = 13, type_long = 4, low_sub_ifd = 0x4a, high_sub_ifd = 0x01;
  constexpr std::size_t entry_bytes = 12, classic_mark = 42;
  const auto number = [&](std::size_t at, std::size_t size) {
    std::size_t value = 0;
    for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(tiff[at + i]);
    return value;
  };
  if (number(2, 2) != classic_mark) return tiff;
  const std::size_t directory = number(4, 4);
  for (std::size_t i = 0; i < number(directory, 2); ++i)
    if (char* const entry = tiff.data() + directory + 2 + entry_bytes * i;
        entry[0] == low_sub_ifd && entry[1] == high_sub_ifd && entry[2] == type_ifd)
      entry[2] = type_long;
  return tiff;
}

/// A file being written, as cameras lay theirs out: EXIF, a preview with what is known of the camera, and
/// below that the raw picture with what is known of its numbers. Each part sets its tags; libtiff sorts them.
class DngWriter {
 public:
  /// \param samples_per_pixel  1, or as many as there are channels, in which case there is no mosaic.
  DngWriter(const std::string& path, const RawImage& raw, int samples_per_pixel)
      : raw_(raw),
        samples_per_pixel_(static_cast<std::uint32_t>(samples_per_pixel)),
        mosaic_(raw.channels.size() > 1 && samples_per_pixel == 1),
        stream_(path, 2 * raw.samples.size()),
        tiff_(stream_.handle()) {}

  std::string bytes() {
    const std::uint64_t exif = written_exif();
    const Preview preview = preview_of(raw_, static_cast<int>(samples_per_pixel_));
    set_picture(FILETYPE_REDUCEDIMAGE, PHOTOMETRIC_RGB, preview.columns, preview.rows, 3, 8);
    set_camera();
    set_colour();
    set(TIFFTAG_EXIFIFD, exif);
    const std::uint64_t below[] = {0};  // libtiff puts the next directory there
    set(TIFFTAG_SUBIFD, 1, below);
    write_strips(preview.samples.data(), std::size_t{preview.columns} * 3, preview.rows);
    stream_.require(TIFFWriteDirectory(tiff_) != 0);

    set_picture(0, mosaic_ ? dng::colour_filter_array : dng::linear_raw,
                static_cast<std::uint32_t>(raw_.columns), static_cast<std::uint32_t>(raw_.rows),
                samples_per_pixel_, 16);
    set_frame();
    if (mosaic_) set_mosaic();
    set_levels();
    set_opcodes(dng::opcode_list_1_tag, dng::opcodes_of_samples(raw_));
    set_opcodes(dng::opcode_list_2_tag, dng::opcodes_of_values(raw_));
    set_opcodes(dng::opcode_list_3_tag, dng::opcodes_of_picture(raw_.lens));
    write_strips(raw_.samples.data(),
                 std::size_t{2} * samples_per_pixel_ * static_cast<std::size_t>(raw_.columns),
                 static_cast<std::uint32_t>(raw_.rows));
    stream_.require(TIFFWriteDirectory(tiff_) != 0);
    return with_plain_place(stream_.finish());
  }

 private:
  template <typename... Values>
  void set(std::uint32_t tag, Values... values) {
    stream_.require(TIFFSetField(tiff_, tag, values...) != 0);
  }
  static std::vector<float> floats(const std::vector<double>& values) {
    return {values.begin(), values.end()};
  }
  void set_rationals(std::uint32_t tag, const std::vector<double>& values) {
    const std::vector<float> narrow = floats(values);
    set(tag, static_cast<int>(narrow.size()), narrow.data());
  }

  void set_picture(int kind, int photometric, std::uint32_t columns, std::uint32_t rows,
                   std::uint32_t samples, std::uint32_t bits) {
    set(TIFFTAG_SUBFILETYPE, kind);
    set(TIFFTAG_IMAGEWIDTH, columns);
    set(TIFFTAG_IMAGELENGTH, rows);
    set(TIFFTAG_BITSPERSAMPLE, bits);
    set(TIFFTAG_SAMPLESPERPIXEL, samples);
    set(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    set(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    set(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    set(TIFFTAG_PHOTOMETRIC, photometric);
    set(TIFFTAG_ROWSPERSTRIP, rows_per_strip(std::size_t{columns} * samples * bits / 8));
  }
  static std::uint32_t rows_per_strip(std::size_t row_bytes) {
    return static_cast<std::uint32_t>(std::max<std::size_t>(1, strip_bytes / row_bytes));
  }

  void set_frame() {
    const std::uint32_t active[] = {0, 0, static_cast<std::uint32_t>(raw_.rows),
                                    static_cast<std::uint32_t>(raw_.columns)};
    set(TIFFTAG_ACTIVEAREA, active);
    const float origin[] = {0, 0}, size[] = {static_cast<float>(raw_.columns), static_cast<float>(raw_.rows)};
    set(TIFFTAG_DEFAULTCROPORIGIN, origin);
    set(TIFFTAG_DEFAULTCROPSIZE, size);
  }

  void set_camera() {
    const std::uint8_t written_for[] = {1, 4, 0, 0}, backward[] = {1, 1, 0, 0};
    set(TIFFTAG_DNGVERSION, written_for);
    set(TIFFTAG_DNGBACKWARDVERSION, backward);
    const std::string model = raw_.sensor_name.empty() ? "sensor" : raw_.sensor_name;
    set(TIFFTAG_MAKE, "Petzval");
    set(TIFFTAG_MODEL, model.c_str());
    set(TIFFTAG_UNIQUECAMERAMODEL, ("Petzval " + model).c_str());
    set(TIFFTAG_SOFTWARE, fmt::format("petzval {}", version()).c_str());
    if (raw_.shot_noise_share != 1) {  // what makes electrons of the slope of the noise
      const std::string own = dng::private_data(raw_.shot_noise_share);
      set(TIFFTAG_DNGPRIVATEDATA, static_cast<int>(own.size()), own.data());
    }
    if (!raw_.provenance.empty()) set(TIFFTAG_IMAGEDESCRIPTION, raw_.provenance.c_str());
    if (raw_.date_time) set(TIFFTAG_DATETIME, exif_date_time(*raw_.date_time).c_str());
    if (raw_.lens.focal_length_mm > 0 && raw_.lens.f_number > 0) {
      const auto focal_mm = static_cast<float>(raw_.lens.focal_length_mm),
                 f_number = static_cast<float>(raw_.lens.f_number);
      const float range[] = {focal_mm, focal_mm, f_number, f_number};  // no zoom
      set(TIFFTAG_LENSINFO, range);
    }
  }

  void set_mosaic() {
    std::vector<std::uint8_t> planes, pattern;
    for (const std::string& channel : raw_.channels) {
      const auto number = dng::colour_number(channel);
      if (!number || std::find(planes.begin(), planes.end(), *number) != planes.end())
        throw InputError(
            stream_.path(),
            fmt::format("DNG has no number for the channel \"{}\" beside the others; .tif, .npy and .exr "
                        "take channels of any name",
                        channel));
      planes.push_back(*number);
    }
    for (const int cell : raw_.mosaic.cells) pattern.push_back(planes[static_cast<std::size_t>(cell)]);
    const std::uint16_t period[] = {static_cast<std::uint16_t>(raw_.mosaic.rows),
                                    static_cast<std::uint16_t>(raw_.mosaic.columns)};
    set(TIFFTAG_CFAREPEATPATTERNDIM, period);
    set(TIFFTAG_CFAPATTERN, static_cast<int>(pattern.size()), pattern.data());
    set(TIFFTAG_CFAPLANECOLOR, static_cast<int>(planes.size()), planes.data());
    set(TIFFTAG_CFALAYOUT, 1);
  }

  void set_levels() {
    const std::uint16_t once[] = {1, 1};
    set(TIFFTAG_BLACKLEVELREPEATDIM, once);
    set_rationals(TIFFTAG_BLACKLEVEL, std::vector<double>(samples_per_pixel_, raw_.black_level));
    const std::vector<std::uint32_t> white(samples_per_pixel_,
                                           static_cast<std::uint32_t>(std::lround(raw_.white_level)));
    set(TIFFTAG_WHITELEVEL, static_cast<int>(white.size()), white.data());
    if (!raw_.linearization.empty()) {
      const std::vector<std::uint16_t> table = linearization_table();
      set(TIFFTAG_LINEARIZATIONTABLE, static_cast<int>(table.size()), table.data());
    }
    if (raw_.dn_per_e > 0) {
      // Variance of x in 0 … 1 is S x + O; the same for every channel.
      const double range = raw_.white_level - raw_.black_level;
      const double profile[] = {raw_.noise_slope() / range, raw_.noise_offset() / (range * range)};
      set(dng::noise_profile_tag, static_cast<std::uint32_t>(std::size(profile)), profile);
    }
  }

  /// Beyond a table its last value goes on, and libtiff counts to 65,535: of a whole one the last two values
  /// share that of the last, so that what is white stays white.
  std::vector<std::uint16_t> linearization_table() const {
    std::vector<std::uint16_t> table = raw_.linearization;
    while (table.size() > 1 && table[table.size() - 2] == table.back()) table.pop_back();
    constexpr std::size_t most = 65535;
    if (table.size() > most) table.erase(table.begin() + most - 1);
    return table;
  }

  void set_colour() {
    const std::uint32_t matrices[] = {TIFFTAG_COLORMATRIX1, TIFFTAG_COLORMATRIX2};
    const std::uint32_t forward[] = {dng::forward_matrix_1_tag, dng::forward_matrix_2_tag};
    const std::uint32_t lights[] = {TIFFTAG_CALIBRATIONILLUMINANT1, TIFFTAG_CALIBRATIONILLUMINANT2};
    for (std::size_t i = 0; i < std::min<std::size_t>(2, raw_.calibrations.size()); ++i) {
      const ColourCalibration& calibration = raw_.calibrations[i];
      set(lights[i], calibration.exif_light_source);
      set_rationals(matrices[i], calibration.camera_from_xyz);
      const std::vector<float> narrow = floats(calibration.pcs_from_balanced);
      if (!narrow.empty()) set(forward[i], static_cast<std::uint32_t>(narrow.size()), narrow.data());
    }
    if (raw_.channels.size() > 1 && !raw_.as_shot_neutral.empty())
      set_rationals(TIFFTAG_ASSHOTNEUTRAL, raw_.as_shot_neutral);
  }

  void set_opcodes(std::uint32_t tag, const std::string& list) {
    if (!list.empty()) set(tag, static_cast<std::uint32_t>(list.size()), list.data());
  }

  void write_strips(const void* picture, std::size_t row_bytes, std::uint32_t rows) {
    const std::uint32_t rows_of_strip = rows_per_strip(row_bytes);
    for (std::uint32_t row = 0, strip = 0; row < rows; row += rows_of_strip, ++strip) {
      // libtiff does not write to it: bytes are not swapped.
      auto* const data =
          const_cast<std::uint8_t*>(static_cast<const std::uint8_t*>(picture) + row * row_bytes);
      const auto size = static_cast<tmsize_t>(std::min(rows_of_strip, rows - row) * row_bytes);
      stream_.require(TIFFWriteRawStrip(tiff_, strip, data, size) >= 0);
    }
  }

  /// Where its directory stands.
  std::uint64_t written_exif() {
    stream_.require(TIFFCreateEXIFDirectory(tiff_) == 0);
    set(EXIFTAG_EXIFVERSION, "0231");
    if (raw_.exposure_s > 0) set(EXIFTAG_EXPOSURETIME, raw_.exposure_s);
    if (raw_.lens.f_number > 0) set(EXIFTAG_FNUMBER, raw_.lens.f_number);
    if (raw_.lens.focal_length_mm > 0) set(EXIFTAG_FOCALLENGTH, raw_.lens.focal_length_mm);
    if (raw_.iso > 0) {
      const auto iso = static_cast<std::uint16_t>(std::clamp(std::lround(raw_.iso), 1L, 65535L));
      set(EXIFTAG_ISOSPEEDRATINGS, 1, &iso);
    }
    if (raw_.pitch_um > 0) {
      constexpr std::uint16_t centimetres = 3;
      constexpr double um_per_cm = 1e4;
      set(EXIFTAG_FOCALPLANEXRESOLUTION, um_per_cm / raw_.pitch_um);
      set(EXIFTAG_FOCALPLANEYRESOLUTION, um_per_cm / raw_.pitch_um);
      set(EXIFTAG_FOCALPLANERESOLUTIONUNIT, centimetres);
    }
    if (!raw_.lens.name.empty()) set(EXIFTAG_LENSMODEL, raw_.lens.name.c_str());
    if (raw_.date_time) {
      set(EXIFTAG_DATETIMEORIGINAL, exif_date_time(*raw_.date_time).c_str());
      if (const std::string rest = exif_subseconds(*raw_.date_time); !rest.empty())
        set(EXIFTAG_SUBSECTIMEORIGINAL, rest.c_str());
    }
    std::uint64_t place = 0;
    stream_.require(TIFFWriteCustomDirectory(tiff_, &place) != 0);
    stream_.require(TIFFCreateDirectory(tiff_) == 0);
    return place;
  }

  const RawImage& raw_;
  std::uint32_t samples_per_pixel_;
  bool mosaic_;
  TiffStream stream_;
  TIFF* tiff_;
};

}  // namespace

bool fits_dng(const RawImage& raw) {
  std::set<std::uint8_t> numbers;
  return raw.channels.size() == 1 ||
         std::all_of(raw.channels.begin(), raw.channels.end(), [&](const std::string& channel) {
           const auto number = dng::colour_number(channel);
           return number && numbers.insert(*number).second;
         });
}

std::string mosaic_note(const RawImage& raw) {
  constexpr int bayer = 2, x_trans = 6;
  const bool rgb = raw.channels == std::vector<std::string>{"red", "green", "blue"};
  const bool square = raw.mosaic.rows == raw.mosaic.columns;
  if (raw.mosaic.is_uniform() || (rgb && square && (raw.mosaic.rows == bayer || raw.mosaic.rows == x_trans)))
    return {};
  return "few other programs develop this mosaic: for them (LibRaw, RawTherapee, darktable) the .dng holds a "
         "picture in linear light, and the mosaic as its original raw file";
}

std::string dng_bytes(const RawImage& raw, const std::string& path) {
  raw.validate();
  dng::register_tags();
  return DngWriter(path, raw, 1).bytes();
}

std::string linear_dng_bytes(const LinearPicture& picture, const std::string& path) {
  constexpr std::size_t primaries = 3;
  if (picture.columns < 1 || picture.rows < 1 ||
      picture.samples.size() !=
          primaries * static_cast<std::size_t>(picture.columns) * static_cast<std::size_t>(picture.rows))
    throw InputError(path, fmt::format("{} samples for a picture of {} x {} x {}", picture.samples.size(),
                                       picture.columns, picture.rows, primaries));
  RawImage raw;
  raw.columns = picture.columns, raw.rows = picture.rows;
  raw.channels = {"red", "green", "blue"};
  raw.samples = picture.samples;
  constexpr int exif_d65 = 21;
  raw.calibrations.push_back({.exif_light_source = exif_d65, .camera_from_xyz = {}, .pcs_from_balanced = {}});
  raw.calibrations[0].camera_from_xyz.assign(picture.rgb_from_xyz.begin(), picture.rgb_from_xyz.end());
  raw.as_shot_neutral.assign(primaries, 1);
  raw.exposure_s = picture.facts.exposure_s, raw.iso = picture.facts.iso;
  raw.pitch_um = picture.facts.pitch_um, raw.lens = picture.facts.lens;
  raw.date_time = picture.facts.date_time;
  raw.sensor_name = picture.facts.camera, raw.provenance = picture.provenance;
  dng::register_tags();
  return DngWriter(path, raw, static_cast<int>(primaries)).bytes();
}

void write_linear_dng(const std::string& path, const LinearPicture& picture) {
  write_whole_file(path, linear_dng_bytes(picture, path));
}

void write_dng(const std::string& path, const RawImage& raw) {
  write_whole_file(path, dng_bytes(raw, path));
}

}  // namespace petzval
