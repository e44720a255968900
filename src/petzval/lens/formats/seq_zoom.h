// SPDX-License-Identifier: BSD-3-Clause
// Zoom positions of a CODE V file: ZOO 3, ZOO THI S5 1.0 2.0 3.0.
#pragma once

#include <petzval/lens/formats/seq_system.h>

#include <cstddef>
#include <vector>

namespace petzval {

/// The commands of a file, those of its zoom positions apart.
struct SeqZoom {
  std::size_t positions = 1;
  std::vector<SeqCommand> commands;  ///< of all positions
  std::vector<SeqCommand> zoomed;    ///< THI S5 1.0 2.0 3.0: a value a position behind what they are for
};

/// \throws InputError for a number of positions that is none.
SeqZoom seq_zoom(const std::vector<SeqCommand>& commands, const SeqContext& context);

/// The commands of one position, counted from 0. \throws InputError for one that misses its value, and for
/// what cannot differ from position to position here.
std::vector<SeqCommand> seq_at_position(const SeqZoom& zoom, std::size_t position, const SeqContext& context);

}  // namespace petzval
