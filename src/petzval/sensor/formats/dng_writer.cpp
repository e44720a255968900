// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/version.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/tiff_stream.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/sensor/formats/dng_opcodes.h>
#include <petzval/sensor/formats/dng_tags.h>
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace petzval {

namespace {

constexpr std::size_t strip_bytes = 1 << 18;

/// A file being written. Each part sets its tags; libtiff sorts them.
class DngWriter {
 public:
  DngWriter(const std::string& path, const RawImage& raw)
      : raw_(raw), stream_(path, 2 * raw.samples.size()), tiff_(stream_.handle()) {}

  std::string bytes() {
    set_picture();
    set_camera();
    if (raw_.channels.size() > 1) set_mosaic();
    set_levels();
    set_colour();
    set_opcodes(dng::opcode_list_1_tag, dng::opcodes_of_samples(raw_));
    set_opcodes(dng::opcode_list_3_tag, dng::opcodes_of_picture(raw_.lens));
    write_strips();
    write_exif();
    return stream_.finish();
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

  std::size_t rows_per_strip() const {
    return std::max<std::size_t>(1, strip_bytes / (2 * static_cast<std::size_t>(raw_.columns)));
  }

  void set_picture() {
    set(TIFFTAG_SUBFILETYPE, 0);
    set(TIFFTAG_IMAGEWIDTH, raw_.columns);
    set(TIFFTAG_IMAGELENGTH, raw_.rows);
    set(TIFFTAG_BITSPERSAMPLE, 16);
    set(TIFFTAG_SAMPLESPERPIXEL, 1);
    set(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    set(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    set(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    set(TIFFTAG_PHOTOMETRIC,
        static_cast<int>(raw_.channels.size() > 1 ? dng::colour_filter_array : dng::linear_raw));
    set(TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(rows_per_strip()));
    const std::uint32_t active[] = {0, 0, static_cast<std::uint32_t>(raw_.rows),
                                    static_cast<std::uint32_t>(raw_.columns)};
    set(TIFFTAG_ACTIVEAREA, active);
    const float origin[] = {0, 0}, size[] = {static_cast<float>(raw_.columns), static_cast<float>(raw_.rows)};
    set(TIFFTAG_DEFAULTCROPORIGIN, origin);
    set(TIFFTAG_DEFAULTCROPSIZE, size);
  }

  void set_camera() {
    const std::uint8_t version[] = {1, 4, 0, 0}, backward[] = {1, 1, 0, 0};
    set(TIFFTAG_DNGVERSION, version);
    set(TIFFTAG_DNGBACKWARDVERSION, backward);
    const std::string model = raw_.sensor_name.empty() ? "sensor" : raw_.sensor_name;
    set(TIFFTAG_MAKE, "Petzval");
    set(TIFFTAG_MODEL, model.c_str());
    set(TIFFTAG_UNIQUECAMERAMODEL, ("Petzval " + model).c_str());
    set(TIFFTAG_SOFTWARE, fmt::format("petzval {}", version_text()).c_str());
    if (!raw_.provenance.empty()) set(TIFFTAG_IMAGEDESCRIPTION, raw_.provenance.c_str());
    if (raw_.lens.focal_length_mm > 0 && raw_.lens.f_number > 0) {
      const auto focal_mm = static_cast<float>(raw_.lens.focal_length_mm),
                 f_number = static_cast<float>(raw_.lens.f_number);
      const float range[] = {focal_mm, focal_mm, f_number, f_number};  // no zoom
      set(TIFFTAG_LENSINFO, range);
    }
  }
  static std::string version_text() { return petzval::version(); }

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
    set_rationals(TIFFTAG_BLACKLEVEL, {raw_.black_level});
    const auto white = static_cast<std::uint32_t>(std::lround(raw_.white_level));
    set(TIFFTAG_WHITELEVEL, 1, &white);
    if (!raw_.linearization.empty()) {
      const std::vector<std::uint16_t> table = linearization_table();
      set(TIFFTAG_LINEARIZATIONTABLE, static_cast<int>(table.size()), table.data());
    }
    if (raw_.dn_per_e > 0) {
      // Variance of x in 0 … 1 is S x + O; the same for every channel.
      const double k = raw_.dn_per_e / (raw_.white_level - raw_.black_level);
      const double profile[] = {k, k * k * raw_.read_noise_e * raw_.read_noise_e};
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

  void write_strips() {
    const std::size_t rows = static_cast<std::size_t>(raw_.rows),
                      columns = static_cast<std::size_t>(raw_.columns);
    for (std::size_t row = 0, strip = 0; row < rows; row += rows_per_strip(), ++strip) {
      const std::size_t count = std::min(rows_per_strip(), rows - row) * columns;
      // libtiff does not write to it: bytes are not swapped.
      void* const data = const_cast<std::uint16_t*>(raw_.samples.data() + row * columns);
      stream_.require(TIFFWriteRawStrip(tiff_, static_cast<std::uint32_t>(strip), data,
                                        static_cast<tmsize_t>(2 * count)) >= 0);
    }
  }

  /// The EXIF directory stands behind the picture's, which then gets its address.
  void write_exif() {
    stream_.require(TIFFWriteDirectory(tiff_) != 0);
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
    std::uint64_t place = 0;
    stream_.require(TIFFWriteCustomDirectory(tiff_, &place) != 0);
    stream_.require(TIFFSetDirectory(tiff_, 0) != 0);
    set(TIFFTAG_EXIFIFD, place);
    stream_.require(TIFFRewriteDirectory(tiff_) != 0);
  }

  const RawImage& raw_;
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
  return DngWriter(path, raw).bytes();
}

void write_dng(const std::string& path, const RawImage& raw) {
  write_whole_file(path, dng_bytes(raw, path));
}

}  // namespace petzval
