// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/image/formats/depth_exr.h>
#include <petzval/image/formats/exr_header.h>
#include <petzval/image/formats/spectral_exr.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <new>

namespace petzval {

namespace {

std::optional<DepthPlane> read(const std::string& path) {
  Imf::InputFile file(path.c_str(), 0);
  const Imf::Channel* channel = file.header().channels().findChannel(exr_depth_channel);
  if (channel == nullptr) return std::nullopt;
  if (channel->xSampling != 1 || channel->ySampling != 1)
    throw InputError(path, "the channel Z is subsampled; every pixel needs a depth");
  const Imath::Box2i window = file.header().dataWindow();
  DepthPlane plane;
  plane.columns = window.max.x - window.min.x + 1;
  plane.rows = window.max.y - window.min.y + 1;
  const auto width = static_cast<std::size_t>(plane.columns);
  plane.values.resize(width * static_cast<std::size_t>(plane.rows));
  Imf::FrameBuffer buffer;
  buffer.insert(exr_depth_channel, Imf::Slice::Make(Imf::FLOAT, plane.values.data(), window, sizeof(float),
                                                    sizeof(float) * width));
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return plane;
}

}  // namespace

std::optional<DepthPlane> read_depth_exr(const std::string& path) {
  check_exr_header(path);
  try {
    return read(path);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Failure(path + ": not enough memory to read it");
  } catch (const std::exception& error) {
    throw InputError(path, fmt::format("is damaged: {}", quotable(error.what())));
  }
}

}  // namespace petzval
