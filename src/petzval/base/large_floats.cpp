// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <petzval/base/large_floats.h>
#include <petzval/base/nameless_file.h>
#include <sys/mman.h>

#include <algorithm>
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
  const NamelessFile file;
  if (!file) return false;
  const std::size_t bytes = count * sizeof(float);
  // Room is taken at once: a full disk must show here, not when a page is written back.
  void* memory = MAP_FAILED;
  if (posix_fallocate(file.descriptor(), 0, static_cast<off_t>(bytes)) == 0)
    memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file.descriptor(), 0);
  if (memory == MAP_FAILED) return false;
  mapped_ = static_cast<float*>(memory);
  count_ = count;
  return true;
}

void LargeFloats::release_memory() const {
  if (mapped_ != nullptr) madvise(mapped_, count_ * sizeof(float), MADV_DONTNEED);
}

void LargeFloats::swap(LargeFloats& other) noexcept {
  values_.swap(other.values_);
  std::swap(mapped_, other.mapped_);
  std::swap(count_, other.count_);
}

}  // namespace petzval
