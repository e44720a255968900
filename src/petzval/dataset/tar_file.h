// SPDX-License-Identifier: BSD-3-Clause
// Tar archives (POSIX.1-1988, "ustar") of plain files: what WebDataset and every other loader reads in one
// go.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace petzval {

/// Writes an archive whose bytes depend on the files alone: no times, no owners.
class TarWriter {
 public:
  /// \throws Failure where the file cannot be written.
  explicit TarWriter(const std::string& path);

  /// \throws InputError for a name that is empty or has more than 100 bytes, or a file of 8 GiB; Failure.
  void add(const std::string& name, std::string_view bytes);
  /// Ends the archive. \throws Failure.
  void finish();
  std::uint64_t bytes() const { return bytes_; }
  /// Of all that has been written, as crc32_text() has it.
  std::string crc32() const;

 private:
  void write(std::string_view bytes);

  std::string path_;
  std::ofstream file_;
  std::uint64_t bytes_ = 0;
  std::uint32_t crc32_ = 0;
};

/// Reads what TarWriter writes, file by file, and nothing else: every byte that is not a file's is what it
/// has to be.
class TarReader {
 public:
  /// \throws InputError where the file cannot be read.
  explicit TarReader(const std::string& path);

  /// The next file. \returns false at the end. \throws InputError for a damaged archive.
  bool next(std::string& name, std::string& bytes);
  /// Of all that has been read, as crc32_text() has it.
  std::string crc32() const;

 private:
  [[noreturn]] void fail(const std::string& problem) const;
  std::string take(std::uint64_t bytes);

  std::string path_;
  std::ifstream file_;
  std::uint64_t left_;
  std::uint32_t crc32_ = 0;
};

/// CRC-32 (ISO 3309, as in gzip and PNG) as eight hexadecimal digits: a changed bit alters it for certain.
std::string crc32_text(std::string_view bytes);

}  // namespace petzval
