// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <petzval/base/direct_stream.h>
#include <petzval/base/error.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

namespace petzval {

namespace {

void set_direct(int descriptor, bool direct) {
  const int flags = fcntl(descriptor, F_GETFL);
  if (flags < 0) return;
  // Where it is refused, bytes take the usual way.
  static_cast<void>(fcntl(descriptor, F_SETFL, direct ? flags | O_DIRECT : flags & ~O_DIRECT));
}

}  // namespace

DirectStream::DirectStream(int descriptor, std::string path)
    : descriptor_(descriptor), path_(std::move(path)) {
  for (Block& block : blocks_) {
    block.bytes.reset(static_cast<char*>(std::aligned_alloc(alignment, block_bytes)));
    if (!block.bytes) throw std::bad_alloc();
  }
  set_direct(descriptor_, true);
  writer_ = std::thread([this] { write_blocks(); });
}

DirectStream::~DirectStream() {
  if (!writer_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    written_ = filled_;  // nobody waits for them
  }
  changed_.notify_all();
  writer_.join();
}

void DirectStream::rethrow() const {
  if (fault_ != 0) throw Failure(fmt::format("{}: cannot be written: {}", path_, std::strerror(fault_)));
}

void DirectStream::write(const void* bytes, std::size_t count) {
  const char* from = static_cast<const char*>(bytes);
  while (count > 0) {
    // The block at hand is the caller's alone.
    Block& block = blocks_[filled_ % most_blocks];
    const std::size_t part = std::min(count, block_bytes - block.filled);
    std::memcpy(block.bytes.get() + block.filled, from, part);
    block.filled += part;
    from += part;
    count -= part;
    if (block.filled == block_bytes) hand_over();
  }
}

void DirectStream::hand_over() {
  std::unique_lock lock(mutex_);
  ++filled_;
  changed_.notify_all();
  changed_.wait(lock, [this] { return filled_ - written_ < most_blocks || fault_ != 0; });
  rethrow();
  blocks_[filled_ % most_blocks].filled = 0;
}

void DirectStream::finish() {
  if (blocks_[filled_ % most_blocks].filled > 0) hand_over();
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  writer_.join();
  set_direct(descriptor_, false);
  rethrow();
}

void DirectStream::write_blocks() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return written_ < filled_ || ended_; });
    if (written_ == filled_) return;
    const Block& block = blocks_[written_ % most_blocks];
    const std::size_t at = written_ * block_bytes;
    lock.unlock();
    const int fault = write_out(block, at);
    lock.lock();
    if (fault != 0) fault_ = fault;
    if (written_ < filled_) ++written_;
    changed_.notify_all();
    if (fault_ != 0) return;
  }
}

/// \return errno, or 0.
int DirectStream::write_out(const Block& block, std::size_t at) const {
  // What does not end with a page, the last of all, cannot go directly.
  if (block.filled % alignment != 0) set_direct(descriptor_, false);
  for (std::size_t done = 0; done < block.filled;) {
    const ssize_t count =
        pwrite(descriptor_, block.bytes.get() + done, block.filled - done, static_cast<off_t>(at + done));
    if (count > 0) {
      done += static_cast<std::size_t>(count);
      if (done % alignment != 0) set_direct(descriptor_, false);
    } else if (count < 0 && errno == EINVAL && (fcntl(descriptor_, F_GETFL) & O_DIRECT) != 0) {
      set_direct(descriptor_, false);  // other alignments than this file system's
    } else if (count == 0 || errno != EINTR) {
      return count == 0 ? ENOSPC : errno;
    }
  }
  return 0;
}

}  // namespace petzval
