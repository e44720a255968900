// SPDX-License-Identifier: BSD-3-Clause
#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/base/whole_file.h>
#include <petzval/colour/display.h>
#include <petzval/image/formats/jpeg.h>
#include <petzval/image/formats/png.h>
#include <petzval/render/textures/picture_file.h>
#include <petzval/render/textures/radiance_picture.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval::render {

namespace {

constexpr std::size_t pixels_between_questions = 1 << 16;

/// A gigapixel is more than any texture has.
constexpr std::int64_t most_pixels = std::int64_t{1} << 30;

PictureFile read_png_picture(const std::string& path, PictureEncoding encoding) {
  const PngImage png = read_standard_png(path);
  const int used = png.channels <= 2 ? 1 : 3;  // transparency is not light
  const bool srgb =
      encoding == PictureEncoding::srgb || (encoding == PictureEncoding::by_format && png.bits == 8);
  const std::size_t levels = std::size_t{1} << png.bits;
  std::vector<float> linear(levels);
  for (std::size_t i = 0; i < levels; ++i) {
    const double value = static_cast<double>(i) / static_cast<double>(levels - 1);
    linear[i] = static_cast<float>(srgb ? srgb_decoded(value) : value);
  }
  PictureFile picture{png.columns, png.rows, used, {}};
  const std::size_t pixels = static_cast<std::size_t>(png.columns) * static_cast<std::size_t>(png.rows);
  picture.values.reserve(pixels * static_cast<std::size_t>(used));
  for (std::size_t i = 0; i < pixels; ++i) {
    if (i % pixels_between_questions == 0) check_stop();
    for (int c = 0; c < used; ++c)
      picture.values.push_back(
          linear[png.samples[i * static_cast<std::size_t>(png.channels) + static_cast<std::size_t>(c)]]);
  }
  return picture;
}

PictureFile read_jpeg_picture(const std::string& path, PictureEncoding encoding) {
  const JpegImage jpeg = read_jpeg(path);
  std::array<float, 256> linear;
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double value = static_cast<double>(i) / 255;
    linear[i] = static_cast<float>(encoding == PictureEncoding::linear ? value : srgb_decoded(value));
  }
  PictureFile picture{jpeg.columns, jpeg.rows, jpeg.channels, {}};
  picture.values.reserve(jpeg.samples.size());
  for (const std::uint8_t sample : jpeg.samples) picture.values.push_back(linear[sample]);
  return picture;
}

PictureFile read_exr_picture(const std::string& path) try {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width < 1 || height < 1 || width * height > most_pixels)
    throw InputError(
        path, fmt::format("has {} x {} pixels; at most {} would be right", width, height, most_pixels));
  const Imf::ChannelList& channels = file.header().channels();
  const bool colour = channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
  if (!colour && !channels.findChannel("Y"))
    throw InputError(path, "has neither the channels R, G and B nor Y");
  PictureFile picture{static_cast<int>(width), static_cast<int>(height), colour ? 3 : 1, {}};
  picture.values.resize(static_cast<std::size_t>(width * height) *
                        static_cast<std::size_t>(picture.channels));
  const std::array<const char*, 3> names{colour ? "R" : "Y", "G", "B"};
  const std::size_t pixel = sizeof(float) * static_cast<std::size_t>(picture.channels);
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < static_cast<std::size_t>(picture.channels); ++c)
    buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, picture.values.data() + c, window, pixel,
                                             pixel * static_cast<std::size_t>(width)));
  file.setFrameBuffer(buffer);
  constexpr int rows_between_questions = 64;
  for (int y = window.min.y; y <= window.max.y; y += rows_between_questions) {
    check_stop();
    file.readPixels(y, std::min(y + rows_between_questions - 1, window.max.y));
  }
  for (const float value : picture.values)
    if (!std::isfinite(value)) throw InputError(path, "holds a value that is not finite");
  return picture;
} catch (const Error&) {
  throw;
} catch (const std::exception& error) {
  throw InputError(path, fmt::format("is no sound OpenEXR picture: {}", error.what()));
}

}  // namespace

PictureFile read_picture_file(const std::string& path, PictureEncoding encoding) {
  std::string extension = path.size() > 4 ? path.substr(path.size() - 4) : "";
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".jpg" || extension == "jpeg") return read_jpeg_picture(path, encoding);
  if (extension == ".hdr") return parse_radiance_picture(read_whole_file(path), path);
  if (extension == ".png") return read_png_picture(path, encoding);
  if (extension == ".exr") return read_exr_picture(path);
  throw InputError(path, "is a picture of a kind that is not read; .png, .jpg, .exr or .hdr would be right");
}

}  // namespace petzval::render
