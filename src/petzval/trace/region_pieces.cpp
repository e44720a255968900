// SPDX-License-Identifier: BSD-3-Clause
// Whether a pupil hangs together: flood fill on the grid of PassingRegion.
#include <petzval/trace/passing_region.h>

#include <cstddef>

namespace petzval {

namespace {

/// Pieces and holes of fewer cells than this are the raggedness of the grid.
constexpr int fewest_cells = 4;

/// Cells that hang together and are all lit or all dark.
struct Piece {
  int cells = 0;
  bool on_axis = false;  ///< touches its own mirror image
  bool on_edge = false;  ///< reaches the edge of the grid
};

class PieceFinder {
 public:
  PieceFinder(const PassingRegion& region, bool lit)
      : region_(region), lit_(lit), seen_(region.passes.size(), 0) {}

  std::vector<Piece> all() {
    std::vector<Piece> found;
    for (int r = 0; r < region_.rows; ++r)
      for (int c = 0; c < region_.columns; ++c)
        if (claim(c, r)) found.push_back(fill());
    return found;
  }

 private:
  /// Takes a cell that has the asked light and was not seen before as the next to look at.
  bool claim(int c, int r) {
    if (c < 0 || c >= region_.columns || r < 0 || r >= region_.rows) return false;
    const auto cell = static_cast<std::size_t>(r * region_.columns + c);
    if (seen_[cell] || (region_.passes[cell] != 0) != lit_) return false;
    seen_[cell] = 1;
    open_.emplace_back(c, r);
    return true;
  }

  Piece fill() {
    Piece piece;
    while (!open_.empty()) {
      const auto [c, r] = open_.back();
      open_.pop_back();
      ++piece.cells;
      piece.on_axis |= c == 0;
      piece.on_edge |= c == region_.columns - 1 || r == 0 || r == region_.rows - 1;
      for (int dr = -1; dr <= 1; ++dr)
        for (int dc = -1; dc <= 1; ++dc)
          // Lit cells touch at corners too, so dark ones do not.
          if (lit_ || dr == 0 || dc == 0) claim(c + dc, r + dr);
    }
    return piece;
  }

  const PassingRegion& region_;
  bool lit_;
  std::vector<std::uint8_t> seen_;
  std::vector<std::pair<int, int>> open_;
};

}  // namespace

int PassingRegion::parts() const {
  int count = 0;
  for (const Piece& piece : PieceFinder(*this, true).all())
    if (piece.cells >= fewest_cells) count += piece.on_axis ? 1 : 2;
  return std::max(count, 1);
}

bool PassingRegion::has_hole() const {
  for (const Piece& piece : PieceFinder(*this, false).all())
    if (!piece.on_edge && piece.cells >= fewest_cells) return true;
  return false;
}

}  // namespace petzval
