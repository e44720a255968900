// SPDX-License-Identifier: BSD-3-Clause
// Sums on disk: of a picture on its way, and of the pieces of one.
#pragma once

#include <petzval/base/progress.h>
#include <petzval/render/film/film.h>

#include <string>
#include <vector>

namespace petzval::render {

/// Saves a film, whole or not at all, and reads it back. `fingerprint` says what is being rendered.
/// \returns whether there is such a file. \throws InputError if it is damaged, or belongs to another picture
/// or another piece of it; Failure.
void write_checkpoint(const std::string& path, const Film& film, const std::string& fingerprint);
bool read_checkpoint(const std::string& path, Film& film, const std::string& fingerprint);

struct MergeReport {
  PixelWindow whole;
  int passes = 0;
  std::uint64_t rays = 0;
};
/// Puts the pieces of a picture together: the file is the checkpoint that one process would have left. The
/// order of the pieces does not matter.
/// \throws InputError for a damaged piece, one of another picture or another version, and for pixels and
/// samples that two pieces have, or none; Failure; Cancelled.
MergeReport merge_checkpoints(const std::vector<std::string>& pieces, const std::string& path,
                              const ProgressCallback& progress = {});

}  // namespace petzval::render
