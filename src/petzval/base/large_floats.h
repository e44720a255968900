// SPDX-License-Identifier: BSD-3-Clause
// Many floats: in memory, or beyond half a gigabyte in a nameless file that the system pages in as needed.
#pragma once

#include <petzval/base/nameless_file.h>

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace petzval {

/// An array of floats of fixed size. From `most_in_memory` floats on they are kept in a file without a name
/// in $TMPDIR (else /var/tmp), mapped into memory, so that an image larger than memory works, and
/// release_memory() bounds what a process takes; where that folder has no room, in memory after all.
class LargeFloats {
 public:
  static constexpr std::size_t most_in_memory = std::size_t{1} << 27;

  LargeFloats() = default;
  /// All zero. \param limit  to keep in memory.
  explicit LargeFloats(std::size_t count, std::size_t limit = most_in_memory);
  /// These, in memory however many.
  explicit LargeFloats(std::vector<float> values) : values_(std::move(values)) {}
  LargeFloats(const LargeFloats& other);
  LargeFloats(LargeFloats&& other) noexcept { swap(other); }
  LargeFloats& operator=(LargeFloats other) noexcept {
    swap(other);
    return *this;
  }
  ~LargeFloats();

  std::size_t size() const { return mapped_ != nullptr ? count_ : values_.size(); }
  bool in_file() const { return mapped_ != nullptr; }
  std::span<float> all() { return {mapped_ != nullptr ? mapped_ : values_.data(), size()}; }
  std::span<const float> all() const { return {mapped_ != nullptr ? mapped_ : values_.data(), size()}; }

  /// Puts values in their place, those from `first` on. Into a file without touching its memory: cheaper than
  /// through all(). \throws Failure if they cannot be written.
  void store(std::size_t first, std::span<const float> values);

  /// Gives up values that are kept in a file, and the room that they take there: from now on they are 0. In
  /// memory they stay.
  void give_up(std::size_t first, std::size_t count);

  /// Gives back the memory of what is kept in a file; the next look fetches it again. Values stay, spans
  /// too, and other threads may read meanwhile.
  void release_memory() const;

 private:
  void swap(LargeFloats& other) noexcept;
  bool map_file(std::size_t count);

  std::vector<float> values_;
  float* mapped_ = nullptr;
  std::size_t count_ = 0;
  std::optional<NamelessFile> file_;  ///< that is mapped
};

}  // namespace petzval
