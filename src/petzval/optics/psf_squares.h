// SPDX-License-Identifier: BSD-3-Clause
// The PSFs of a lens data table as they lie in its file (table_file.h).
#pragma once

#include <petzval/scene/formats/hdf5_handle.h>

#include <mutex>
#include <vector>

namespace petzval {

/// Squares of samples in the dataset psf, one a field and wavelength. Where they are stored as Petzval writes
/// them (each a chunk: shuffled, deflated, a checksum behind), reading inflates them itself, so that several
/// threads can at once; HDF5 inflates them on one. The checksums of chunks are not looked at then: the file's
/// own seal (table_seal.h) must have been.
class PsfSquares {
 public:
  /// \param data  the dataset, [field × wavelength × side × side]. \param sealed  whether the file's seal
  /// holds.
  PsfSquares(const Hdf5Handle& data, hsize_t side, bool sealed);

  /// Whether read() has most of its work to itself.
  bool inflates_itself() const { return own_chunks_; }
  /// The middle `own` × `own` samples of a square, row-major, where sample [own/2][own/2] is [side/2][side/2]
  /// of the square. May be called from several threads. \returns false if they cannot be read.
  bool read(hsize_t field, hsize_t wavelength, hsize_t own, std::vector<float>& values) const;

 private:
  bool read_chunk(hsize_t field, hsize_t wavelength, hsize_t own, std::vector<float>& values) const;

  const Hdf5Handle& data_;
  hsize_t side_;
  bool own_chunks_;
  mutable std::mutex mutex_;  ///< HDF5 takes one call at a time
};

}  // namespace petzval
