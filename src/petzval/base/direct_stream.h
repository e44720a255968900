// SPDX-License-Identifier: BSD-3-Clause
// Streams of many bytes that bypass the system's cache of files.
#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace petzval {

/// Writes bytes one after the other to an open file, from its beginning, while the caller makes the next.
///
/// Some megabytes wait in blocks that a thread of its own hands to the disk directly (O_DIRECT, where the
/// file system can): what is larger than that would fill memory with pages that nobody looks at, and touching
/// memory for the first time costs more than the disk does, in virtual machines above all.
class DirectStream {
 public:
  /// \param descriptor  open for writing; it stays the caller's. \param path  for messages.
  DirectStream(int descriptor, std::string path);
  ~DirectStream();
  DirectStream(const DirectStream&) = delete;
  DirectStream& operator=(const DirectStream&) = delete;

  /// \throws Failure for this or earlier bytes that cannot be written.
  void write(const void* bytes, std::size_t count);
  /// Waits until all bytes are in the file. Nothing is written after it. \throws Failure as write().
  void finish();

 private:
  static constexpr std::size_t block_bytes = std::size_t{4} << 20, alignment = 4096, most_blocks = 8;
  struct Free {
    void operator()(char* block) const { std::free(block); }
  };
  struct Block {
    std::unique_ptr<char, Free> bytes;
    std::size_t filled = 0;
  };

  void hand_over();
  /// What the writing thread does until the stream ends. The mutex guards the counts, `ended_` and `fault_`;
  /// it is not held while a block is written, for a block that waits belongs to this thread alone.
  void write_blocks();
  int write_out(const Block& block, std::size_t at) const;
  void rethrow() const;

  const int descriptor_;
  const std::string path_;
  std::array<Block, most_blocks> blocks_;
  std::size_t filled_ = 0, written_ = 0;  ///< blocks so far; those between wait
  bool ended_ = false;
  int fault_ = 0;  ///< errno of what went wrong
  std::mutex mutex_;
  std::condition_variable changed_;
  std::thread writer_;
};

}  // namespace petzval
