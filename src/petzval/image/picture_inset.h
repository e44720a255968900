// SPDX-License-Identifier: BSD-3-Clause
// Parts of a picture enlarged beside it: a star, a corner.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// A square about a place of a picture.
struct PictureInset {
  double column = 0, row = 0;  ///< its middle, in pixels from the left and upper edge
  int factor = 4;              ///< a pixel becomes a square of so many
  /// If set, `column` and `row` are shares of the picture's width and height.
  bool of_frame = false;

  /// "310,20", pixels; "centre", "top", "bottom-right" and the like; each with ",FACTOR" behind it if it is
  /// not
  /// 4. \throws InputError for another text.
  static PictureInset parse(const std::string& text);
};

/// A picture and its insets, one beside the other: where each pixel of the sheet comes from. Insets stand to
/// the right of the picture, two to four a column, in the order in which they were given; each shows whole
/// pixels, framed there and framed in the picture. A square that would reach beyond the picture is moved
/// inwards.
class InsetSheet {
 public:
  /// \throws InputError for a middle beyond the picture, a factor beyond 2 to 64, and more than 16 insets.
  InsetSheet(int picture_columns, int picture_rows, std::span<const PictureInset> insets);

  int columns() const { return columns_; }
  int rows() const { return rows_; }

  struct Source {
    enum class Kind { picture, frame, paper };
    Kind kind = Kind::paper;
    int column = 0, row = 0;  ///< of the picture
  };
  Source at(int column, int row) const;

  /// What an inset shows of the picture: columns [left, left + side), rows [top, top + side).
  struct Square {
    int left = 0, top = 0, side = 0;
  };
  Square square(std::size_t inset) const { return tiles_[inset].square; }

 private:
  struct Tile {
    Square square;
    int left = 0, top = 0, factor = 1;  ///< where it is drawn, without its frame
  };
  int picture_columns_, picture_rows_, columns_, rows_;
  std::vector<Tile> tiles_;
};

}  // namespace petzval
