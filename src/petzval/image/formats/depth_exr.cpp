// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/image/formats/depth_exr.h>
#include <petzval/image/formats/exr_input.h>
#include <petzval/image/formats/spectral_exr.h>

#include <ImfChannelList.h>
#include <ImfInputFile.h>

namespace petzval {

namespace {

std::optional<DepthPlane> read_depth(const std::string& path) {
  Imf::InputFile file(path.c_str(), 0);
  const Imf::Channel* channel = file.header().channels().findChannel(exr_depth_channel);
  if (channel == nullptr) return std::nullopt;
  if (!is_whole(*channel)) throw InputError(path, "the channel Z is subsampled; every pixel needs a depth");
  const ExrWindow window(file.header());
  DepthPlane plane{window.columns, window.rows, std::vector<float>(window.pixels())};
  Imf::FrameBuffer buffer;
  buffer.insert(exr_depth_channel, window.plane(plane.values.data()));
  file.setFrameBuffer(buffer);
  file.readPixels(window.box.min.y, window.box.max.y);
  return plane;
}

}  // namespace

std::optional<DepthPlane> read_depth_exr(const std::string& path) {
  return reading_exr(path, read_depth);
}

}  // namespace petzval
