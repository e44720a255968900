// SPDX-License-Identifier: BSD-3-Clause
// PSFs as grids of other programs: which way is away from the axis, and where the chief ray is.
#pragma once

#include <petzval/wave/psf.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// Rows of numbers as they stand in a file, the first row on top.
struct NumberGrid {
  int rows = 0, columns = 0;
  std::vector<double> values;  ///< row-major

  double at(int row, int column) const {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column)];
  }
};

/// The direction on the page that points away from the optical axis (t of a Psf). s lies a quarter turn
/// clockwise from it: so it is where x' runs to the right and y' upwards, and so it is in an upright picture.
enum class PsfAway { up, down, left, right };

/// "up", "down", "left" or "right". \throws InputError for anything else.
PsfAway parse_away(const std::string& text);
std::string away_text(PsfAway away);

/// How a grid lies in the frame of its PSF. Row and column of the chief ray count from 0.
struct PsfFrame {
  PsfAway away = PsfAway::up;
  int centre_row = 0, centre_column = 0;
};

/// \throws InputError unless the grid has values, all finite and none negative, some light, and the centre in
/// it. The samples keep their values if they already sum to 1 as closely as single precision can, else they
/// are divided by their sum.
Psf psf_of_grid(const NumberGrid& grid, const PsfFrame& frame, double spacing_um);

/// The other way round, on a square grid of `size`. \throws InputError if a sample other than 0 falls
/// outside.
NumberGrid grid_of_psf(const Psf& psf, const PsfFrame& frame, int size);

/// What the mirror symmetry that PSFs of a centred lens have tells of their grid: light is the same on both
/// sides of the line through the chief ray that runs away from the axis.
struct PsfMirror {
  bool upright = false;  ///< the line runs from top to bottom, else from left to right
  int centre = 0;        ///< its column or row, from 0
};

/// Nothing unless the grids, which must be of one size, show it clearly: within 2 % about one line and ten
/// times less about every crosswise one.
std::optional<PsfMirror> find_mirror(std::span<const NumberGrid> grids);

}  // namespace petzval
