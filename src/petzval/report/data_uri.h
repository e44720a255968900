// SPDX-License-Identifier: BSD-3-Clause
// Pictures inside text: base64, data URIs, PNG in memory.
#pragma once

#include <petzval/report/colours.h>

#include <span>
#include <string>
#include <string_view>

namespace petzval {

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// "data:<mime>;base64,…"
std::string data_uri(std::string_view mime, std::string_view bytes);

/// A PNG of rows × columns pixels, first row on top. Same pixels, same bytes.
/// \throws InputError unless there are exactly rows·columns pixels, at least one and at most 2²⁸; Failure if
/// the memory does not suffice.
std::string encode_png(std::span<const Rgb8> pixels, int columns, int rows);

/// Columns and rows of a PNG, read from its header. \throws InputError if the bytes do not begin as a PNG
/// does.
struct PixelSize {
  int columns = 0, rows = 0;
};
PixelSize png_size(std::string_view png);

}  // namespace petzval
