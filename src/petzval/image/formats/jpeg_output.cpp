// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/jpeg_output.h>

#include <csetjmp>
#include <cstdio>  // before jpeglib.h, which needs it
#include <cstdlib>

#include <jpeglib.h>

namespace petzval {

namespace {

struct JpegOutputError {
  jpeg_error_mgr manager;  // first: libjpeg holds a pointer to it, from which ours follows
  std::jmp_buf escape;
  char message[JMSG_LENGTH_MAX];
};

[[noreturn]] void on_output_error(j_common_ptr jpeg) {
  auto* error = reinterpret_cast<JpegOutputError*>(jpeg->err);
  jpeg->err->format_message(jpeg, error->message);
  std::longjmp(error->escape, 1);
}

/// The one function between setjmp and longjmp: it holds nothing that would have to be destroyed.
bool compress(const JpegImage& image, int quality, const std::string& exif, JpegOutputError& error,
              unsigned char** bytes, unsigned long* size) {
  jpeg_compress_struct jpeg;
  jpeg.err = jpeg_std_error(&error.manager);
  error.manager.error_exit = on_output_error;
  if (setjmp(error.escape)) {
    jpeg_destroy_compress(&jpeg);
    return false;
  }
  jpeg_create_compress(&jpeg);
  jpeg_mem_dest(&jpeg, bytes, size);
  jpeg.image_width = static_cast<JDIMENSION>(image.columns);
  jpeg.image_height = static_cast<JDIMENSION>(image.rows);
  jpeg.input_components = image.channels;
  jpeg.in_color_space = image.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, quality, TRUE);
  jpeg.dct_method = JDCT_ISLOW;
  jpeg.optimize_coding = TRUE;
  for (int i = 0; i < jpeg.num_components; ++i)
    jpeg.comp_info[i].h_samp_factor = jpeg.comp_info[i].v_samp_factor = 1;
  jpeg.write_JFIF_header = FALSE;  // EXIF stands in its place
  jpeg_start_compress(&jpeg, TRUE);
  jpeg_write_marker(&jpeg, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(exif.data()),
                    static_cast<unsigned>(exif.size()));
  if (!image.icc_profile.empty())
    jpeg_write_icc_profile(&jpeg, reinterpret_cast<const JOCTET*>(image.icc_profile.data()),
                           static_cast<unsigned>(image.icc_profile.size()));
  const std::size_t row_size =
      static_cast<std::size_t>(image.columns) * static_cast<std::size_t>(image.channels);
  while (jpeg.next_scanline < jpeg.image_height) {
    JSAMPROW row = const_cast<JSAMPROW>(image.samples.data() + jpeg.next_scanline * row_size);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  return true;
}

}  // namespace

void write_jpeg(const std::string& path, const JpegImage& image, const JpegOptions& options) {
  constexpr int longest_side = 65500;  // libjpeg's JPEG_MAX_DIMENSION
  if (image.columns < 1 || image.rows < 1 || image.columns > longest_side || image.rows > longest_side)
    throw InputError(path, fmt::format("a JPEG of {} x {} pixels; 1 to {} on a side would be right",
                                       image.columns, image.rows, longest_side));
  if (image.channels != 1 && image.channels != 3)
    throw InputError(path, fmt::format("a JPEG of {} channels; 1 or 3 would be right", image.channels));
  if (image.samples.size() != static_cast<std::size_t>(image.columns) * static_cast<std::size_t>(image.rows) *
                                  static_cast<std::size_t>(image.channels))
    throw InputError(path, "the samples are not as many as the picture's sizes say");
  if (options.quality < 1 || options.quality > 100)
    throw InputError(fmt::format("a JPEG quality of {}; 1 to 100 would be right", options.quality));
  const std::string exif = std::string("Exif\0\0", 6) + exif_of(image.columns, image.rows, options);
  JpegOutputError error{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const bool done = compress(image, options.quality, exif, error, &bytes, &size);
  const std::string whole = done ? std::string(reinterpret_cast<const char*>(bytes), size) : std::string();
  std::free(bytes);
  if (!done) throw Failure(fmt::format("{}: cannot be written: {}", path, error.message));
  write_whole_file(path, whole);
}

}  // namespace petzval
