// SPDX-License-Identifier: BSD-3-Clause
// What readers of OpenEXR files share: planes of floats, and errors in our own words.
#pragma once

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/image/formats/exr_header.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <cstddef>
#include <exception>
#include <new>
#include <string>

namespace petzval {

/// Checks the header of the file and calls read(path). \throws InputError, Failure for whatever OpenEXR
/// throws.
template <typename Read>
auto reading_exr(const std::string& path, const Read& read) {
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

/// The window of pixels that a file has.
struct ExrWindow {
  Imath::Box2i box;
  int columns, rows;

  explicit ExrWindow(const Imf::Header& header)
      : box(header.dataWindow()), columns(box.max.x - box.min.x + 1), rows(box.max.y - box.min.y + 1) {}
  std::size_t pixels() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  /// Where a channel of these pixels goes: a plane of floats, rows from the top.
  Imf::Slice plane(float* values) const {
    return Imf::Slice::Make(Imf::FLOAT, values, box, sizeof(float),
                            sizeof(float) * static_cast<std::size_t>(columns));
  }
};

/// Whether every pixel has a value of this channel.
inline bool is_whole(const Imf::Channel& channel) {
  return channel.xSampling == 1 && channel.ySampling == 1;
}

}  // namespace petzval
