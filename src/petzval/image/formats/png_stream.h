// SPDX-License-Identifier: BSD-3-Clause
// The pixels of a PNG picture, filtered and compressed on all threads.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace petzval {

/// Fills one row of bytes, as PNG orders them.
using PngByteRow = std::function<void(int row, std::span<unsigned char> bytes)>;
/// Takes a piece of the stream, in order.
using PngPiece = std::function<void(std::span<const unsigned char> bytes)>;

/// Makes the zlib stream of `rows` rows (PNG specification, 3rd edition, chapters 9 and 10): each row with
/// the filter whose differences have the least sum of magnitudes. Blocks of rows are compressed at once, each
/// without knowing those before it, and follow each other in one stream (as pigz does, Adler 2007). The bytes
/// do not depend on the number of threads. \param pixel_bytes  bytes of a pixel. \throws Failure; what
/// `source` and `take` throw, which are called for one row or piece after the other.
void compress_png_rows(int rows, std::size_t row_bytes, std::size_t pixel_bytes, const PngByteRow& source,
                       const PngPiece& take);

}  // namespace petzval
