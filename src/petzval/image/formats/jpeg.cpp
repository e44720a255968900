// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/jpeg.h>
// libjpeg's header wants these two before it.
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>
#include <iterator>
#include <string_view>

namespace petzval {

namespace {

constexpr std::uint64_t max_pixels = std::uint64_t{1} << 29;
/// Huffman coding spends at least a bit on a block of 8 × 8 samples.
constexpr std::uint64_t most_pixels_a_byte = 512;

/// What libjpeg says, and where it goes when it gives up.
struct JpegError {
  jpeg_error_mgr manager;  // first: libjpeg holds a pointer to it, from which ours follows
  std::jmp_buf escape;
  char message[JMSG_LENGTH_MAX] = "";
};

JpegError& error_of(j_common_ptr jpeg) {
  return *reinterpret_cast<JpegError*>(jpeg->err);
}

[[noreturn]] void on_error(j_common_ptr jpeg) {
  JpegError& error = error_of(jpeg);
  error.manager.format_message(jpeg, error.message);
  std::longjmp(error.escape, 1);
}

/// libjpeg goes on with grey where data are missing or broken, and only warns of it.
void on_message(j_common_ptr jpeg, int level) {
  const int code = jpeg->err->msg_code;
  if (level < 0 && code != JWRN_EXTRANEOUS_DATA && code != JWRN_ADOBE_XFORM) on_error(jpeg);
}

void no_output(j_common_ptr) {}

/// A decompressor, and every step that may jump out of libjpeg in a function without objects to destroy.
class JpegReader {
 public:
  JpegReader(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {
    jpeg_.err = jpeg_std_error(&error_.manager);
    error_.manager.error_exit = on_error;
    error_.manager.emit_message = on_message;
    error_.manager.output_message = no_output;
    jpeg_create_decompress(&jpeg_);
  }
  ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  void read_header() {
    if (setjmp(error_.escape)) fail();
    constexpr unsigned longest_marker = 0xFFFF;
    jpeg_save_markers(&jpeg_, JPEG_APP0 + 1, longest_marker);
    jpeg_save_markers(&jpeg_, JPEG_APP0 + 2, longest_marker);
    jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size());
    jpeg_read_header(&jpeg_, TRUE);
    jpeg_.dct_method = JDCT_ISLOW;
    jpeg_.out_color_space = jpeg_.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
  }

  void check() const {
    if (jpeg_.num_components != 1 && jpeg_.num_components != 3)
      throw InputError(path_, fmt::format("has {} colour components (CMYK?); save it as RGB or grey",
                                          jpeg_.num_components));
    const std::uint64_t pixels = std::uint64_t{jpeg_.image_width} * jpeg_.image_height;
    if (pixels > most_pixels_a_byte * bytes_.size())
      throw InputError(path_, fmt::format("promises {} x {} pixels, but the file is too short for them",
                                          jpeg_.image_width, jpeg_.image_height));
    if (pixels > max_pixels)
      throw InputError(
          path_, fmt::format("has {} x {} pixels, more than 2^29", jpeg_.image_width, jpeg_.image_height));
  }

  JpegImage layout() const {
    JpegImage image;
    image.columns = static_cast<int>(jpeg_.image_width);
    image.rows = static_cast<int>(jpeg_.image_height);
    image.channels = jpeg_.num_components;
    image.steps = coefficient_steps();
    for (const jpeg_marker_struct* m = jpeg_.marker_list; m != nullptr; m = m->next) {
      const int orientation = m->marker == JPEG_APP0 + 1
                                  ? exif_orientation({reinterpret_cast<const char*>(m->data), m->data_length})
                                  : upright_orientation;
      if (orientation != upright_orientation) image.orientation = orientation;
    }
    return image;
  }

  std::string icc_profile() {
    JOCTET* data = nullptr;
    unsigned length = 0;
    if (setjmp(error_.escape)) fail();
    if (!jpeg_read_icc_profile(&jpeg_, &data, &length)) return {};
    std::string profile(reinterpret_cast<const char*>(data), length);
    std::free(data);
    return profile;
  }

  void read_rows(std::uint8_t* samples, std::size_t row_size) {
    start();
    while (jpeg_.output_scanline < jpeg_.output_height) {
      check_stop();
      read_row(samples + jpeg_.output_scanline * row_size);
    }
    finish();
  }

 private:
  /// libjpeg does not check the number of the table before it decodes, and never whether steps are 0, which
  /// T.81 excludes.
  std::vector<int> coefficient_steps() const {
    const int number = jpeg_.comp_info[0].quant_tbl_no;
    if (number < 0 || number >= NUM_QUANT_TBLS) return {};
    const JQUANT_TBL* table = jpeg_.quant_tbl_ptrs[number];
    if (table == nullptr || (jpeg_.jpeg_color_space != JCS_GRAYSCALE && jpeg_.jpeg_color_space != JCS_YCbCr))
      return {};
    if (std::ranges::count(table->quantval, 0) > 0) return {};
    return {std::begin(table->quantval), std::end(table->quantval)};
  }

  void start() {
    if (setjmp(error_.escape)) fail();
    jpeg_start_decompress(&jpeg_);
  }

  void read_row(JSAMPROW row) {
    if (setjmp(error_.escape)) fail();
    jpeg_read_scanlines(&jpeg_, &row, 1);
  }

  void finish() {
    if (setjmp(error_.escape)) fail();
    jpeg_finish_decompress(&jpeg_);
  }

  [[noreturn]] void fail() const {
    throw InputError(path_, fmt::format("is no sound JPEG: {}", error_.message));
  }

  const std::string& path_;
  std::string_view bytes_;
  JpegError error_;
  jpeg_decompress_struct jpeg_{};
};

}  // namespace

JpegImage read_jpeg(const std::string& path) {
  return parse_jpeg(read_whole_file(path), path);
}

JpegImage parse_jpeg(const std::string& bytes, const std::string& path) {
  JpegReader reader(path, bytes);
  reader.read_header();
  reader.check();
  JpegImage image = reader.layout();
  image.icc_profile = reader.icc_profile();
  const std::size_t row_size =
      static_cast<std::size_t>(image.columns) * static_cast<std::size_t>(image.channels);
  image.samples.resize(row_size * static_cast<std::size_t>(image.rows));
  reader.read_rows(image.samples.data(), row_size);
  return image;
}

}  // namespace petzval
