// SPDX-License-Identifier: BSD-3-Clause
// Large images as .npy files, written band by band.
#pragma once

#include <petzval/base/direct_stream.h>
#include <petzval/base/nameless_file.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// The pixels of an image.
struct NpyImageShape {
  std::size_t rows = 0, columns = 0, bands = 0;
};

/// Whether an image of that many values is written by NpyBands: those that are not kept in memory.
bool is_large_npy(const NpyImageShape& shape);

/// Writes float32 of shape (rows, columns, bands) in Fortran order: bands lie one after the other, each
/// column by column, so that none of them need be kept.
class NpyBands {
 public:
  /// \param descriptor  of an empty file, which stays the caller's. \param path  for messages.
  NpyBands(int descriptor, const std::string& path, const NpyImageShape& shape);
  /// The next band, row by row. \throws InputError for a plane of another size; Failure.
  void add(std::span<const float> plane);
  /// All bytes are in the file. \throws Failure; InputError if bands are missing.
  void finish();

 private:
  std::string path_;
  NpyImageShape shape_;
  std::size_t added_ = 0;
  std::vector<std::vector<float>> turned_;
  DirectStream stream_;
};

/// Such a file while an image is made, of which nothing is left should the program be killed:
///
///     NpyBandFile file("out.npy", {rows, columns, bands});
///     if (!file) …                      // this file system has no files without a name
///     for (…) file.bands().add(plane);
///     file.put_at("out.npy");           // appears whole
class NpyBandFile {
 public:
  /// \param path  of the output: the file is in its folder. \throws Failure if there is no room for all of
  /// it; InputError as WholeFile.
  NpyBandFile(const std::string& path, const NpyImageShape& shape);
  explicit operator bool() const { return bands_ != nullptr; }
  NpyBands& bands() { return *bands_; }
  /// Ends the file and names it, in place of one that is there. \throws as WholeFile, Failure.
  void put_at(const std::string& path);

 private:
  NamelessFile file_;
  std::unique_ptr<NpyBands> bands_;
};

}  // namespace petzval
