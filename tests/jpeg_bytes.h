// SPDX-License-Identifier: BSD-3-Clause
// JPEG files by libjpeg itself.
#pragma once

// libjpeg's header wants this one before it.
#include <cstdio>

#include <jpeglib.h>

#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

namespace petzval::test {

/// Samples as a JPEG file of quality 100. \param more  sets what is to be different.
inline std::string jpeg_bytes(int columns, int rows, int channels, std::vector<std::uint8_t> samples,
                              const std::function<void(jpeg_compress_struct&)>& more = {},
                              const std::string& app1 = {}) {
  jpeg_error_mgr error;
  jpeg_compress_struct jpeg{};
  jpeg.err = jpeg_std_error(&error);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = static_cast<JDIMENSION>(columns), jpeg.image_height = static_cast<JDIMENSION>(rows);
  jpeg.input_components = channels;
  jpeg.in_color_space = channels == 1 ? JCS_GRAYSCALE : channels == 3 ? JCS_RGB : JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  if (more) more(jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  if (!app1.empty())
    jpeg_write_marker(&jpeg, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(app1.data()),
                      static_cast<unsigned>(app1.size()));
  for (int row = 0; row < rows; ++row) {
    JSAMPROW line = samples.data() + row * columns * channels;
    jpeg_write_scanlines(&jpeg, &line, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::string result(reinterpret_cast<const char*>(bytes), size);
  jpeg_destroy_compress(&jpeg);
  std::free(bytes);
  return result;
}

}  // namespace petzval::test
