// SPDX-License-Identifier: BSD-3-Clause
// Files that appear whole or not at all.
#pragma once

#include <string>
#include <string_view>

namespace petzval {

/// An output file written aside and renamed into place:
///
///     WholeFile file("out.png");
///     write_somehow(file.temporary_path());
///     file.commit();            // now out.png is there, whole
///
/// Without commit() nothing is left behind and a previous out.png is untouched.
class WholeFile {
 public:
  /// \throws InputError if the folder does not exist, or `path` is a folder, a pipe, a device or too long.
  explicit WholeFile(std::string path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Beside the final path, with the same extension, so that writers that look at extensions agree.
  const std::string& temporary_path() const { return temporary_; }
  const std::string& path() const { return path_; }

  /// Flushes to disk and renames. \throws Failure when the disk is full or refuses.
  void commit();

 private:
  std::string path_, temporary_;
  bool committed_ = false;
};

/// Tries whether `path` can be written, before work whose result is to go there. Leaves nothing behind.
/// \throws InputError as WholeFile's constructor; Failure when the folder takes no file.
void require_writable(const std::string& path);

/// Writes `bytes` to `path`, whole or not at all. \throws InputError, Failure as WholeFile.
void write_whole_file(const std::string& path, std::string_view bytes);

/// No description and no table in text is larger [bytes].
inline constexpr std::size_t largest_text = std::size_t{1} << 26;

/// Reads a whole file. \throws InputError if it cannot be read or is larger than `max_bytes`.
std::string read_whole_file(const std::string& path, std::size_t max_bytes = std::size_t{1} << 32);

}  // namespace petzval
