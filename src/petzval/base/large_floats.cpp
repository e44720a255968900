// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/large_floats.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

namespace petzval {

LargeFloats::LargeFloats(std::size_t count, std::size_t limit) {
  if (count <= limit || !map_file(count)) values_.assign(count, 0.0F);
}

LargeFloats::LargeFloats(const LargeFloats& other) {
  if (!other.in_file() || !map_file(other.count_)) {
    values_.assign(other.all().begin(), other.all().end());
    return;
  }
  std::copy(other.all().begin(), other.all().end(), mapped_);
}

LargeFloats::~LargeFloats() {
  if (mapped_ != nullptr) munmap(mapped_, count_ * sizeof(float));
}

bool LargeFloats::map_file(std::size_t count) {
  NamelessFile file;
  if (!file) return false;
  const std::size_t bytes = count * sizeof(float);
  // Room is taken at once: a full disk must show here, not when a page is written back.
  void* memory = MAP_FAILED;
  if (posix_fallocate(file.descriptor(), 0, static_cast<off_t>(bytes)) == 0)
    memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file.descriptor(), 0);
  if (memory == MAP_FAILED) return false;
  mapped_ = static_cast<float*>(memory);
  count_ = count;
  file_ = std::move(file);
  return true;
}

void LargeFloats::store(std::size_t first, std::span<const float> values) {
  if (mapped_ == nullptr) {
    std::copy(values.begin(), values.end(), values_.begin() + static_cast<std::ptrdiff_t>(first));
    return;
  }
  const std::span<const std::byte> bytes = std::as_bytes(values);
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = pwrite(file_->descriptor(), bytes.data() + done, bytes.size() - done,
                                   static_cast<off_t>(first * sizeof(float) + done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0)
      throw Failure(fmt::format("a nameless file cannot be written: {}", std::strerror(errno)));
    done += static_cast<std::size_t>(written);
  }
}

void LargeFloats::give_up(std::size_t first, std::size_t count) {
  if (mapped_ == nullptr || count == 0) return;
  // Where the file system cannot, they stay: nobody looks at them again.
  static_cast<void>(fallocate(file_->descriptor(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
                              static_cast<off_t>(first * sizeof(float)),
                              static_cast<off_t>(count * sizeof(float))));
}

void LargeFloats::release_memory() const {
  if (mapped_ != nullptr) madvise(mapped_, count_ * sizeof(float), MADV_DONTNEED);
}

void LargeFloats::swap(LargeFloats& other) noexcept {
  values_.swap(other.values_);
  std::swap(mapped_, other.mapped_);
  std::swap(count_, other.count_);
  file_.swap(other.file_);
}

}  // namespace petzval
