// SPDX-License-Identifier: BSD-3-Clause
// A stream of bytes into a file that appears whole or not at all.
#pragma once

#include <petzval/base/whole_file.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

namespace petzval {

/// What the writers of formats write to. Every failed write is a Failure: none is lost in a destructor.
class OutputFile {
 public:
  /// \throws InputError as WholeFile, Failure if the file cannot be made.
  explicit OutputFile(const std::string& path);

  void write(const void* bytes, std::size_t count);
  std::uint64_t position() const;
  void seek(std::uint64_t position);
  /// Closes and puts the file in its place. \throws Failure when the disk is full.
  void commit();
  /// To be written to in other ways than write(), not both.
  int descriptor() const { return fileno(file_.get()); }
  const std::string& path() const { return whole_.path(); }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail() const;

  WholeFile whole_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace petzval
