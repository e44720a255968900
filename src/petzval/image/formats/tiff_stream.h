// SPDX-License-Identifier: BSD-3-Clause
// A TIFF file in memory, between libtiff and the formats that are made of TIFF.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct tiff;  // libtiff's TIFF

namespace petzval {

/// An open TIFF file whose bytes are in memory: a reader never touches more than was read, a writer puts
/// nothing on the disk before all is well. What libtiff complains about is kept for the message of the error.
///
///     TiffStream tiff("picture.tif", 0);
///     tiff.require(TIFFSetField(tiff.handle(), TIFFTAG_IMAGEWIDTH, 640));
///     …
///     write_whole_file("picture.tif", tiff.finish());
class TiffStream {
 public:
  /// For writing. \param expected_bytes  above 4 GB the file is a BigTIFF.
  TiffStream(std::string path, std::uint64_t expected_bytes);
  /// For reading. \param path  for messages. \throws InputError if the bytes are no TIFF file.
  static TiffStream reader(std::string path, std::string bytes);

  ~TiffStream();
  TiffStream(TiffStream&&) noexcept;
  TiffStream& operator=(TiffStream&&) = delete;

  tiff* handle() const;
  const std::string& path() const;
  std::size_t size() const;  ///< bytes so far
  /// \throws InputError (reading) or Failure (writing) with libtiff's complaint, unless `success`.
  void require(bool success) const;
  /// \throws InputError if a tag that has been read had its value beyond the end of the file.
  void require_whole() const;
  /// libtiff's names of tags that are there and that it ignored: values of another type than they may be, or
  /// too many.
  const std::vector<std::string>& ignored_tags() const;
  /// Throws what require(false) would, about `what` if libtiff has said nothing.
  [[noreturn]] void fail(const std::string& what) const;
  /// Closes a written file and gives its bytes.
  std::string finish();

 private:
  struct State;
  explicit TiffStream(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace petzval
