// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/large_floats.h>
#include <petzval/base/parallel.h>
#include <petzval/base/transpose.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/npy_bands.h>
#include <petzval/image/formats/npy_header.h>
#include <petzval/image/formats/output_file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace petzval {

namespace {

std::string header_of(const NpyImageShape& shape) {
  return npy_header("<f4", std::array{shape.rows, shape.columns, shape.bands}, NpyOrder::fortran);
}

/// A full disk must show before the work.
void take_room(int descriptor, const std::string& path, const NpyImageShape& shape) {
  const std::size_t bytes =
      header_of(shape).size() + shape.rows * shape.columns * shape.bands * sizeof(float);
  if (fallocate(descriptor, 0, 0, static_cast<off_t>(bytes)) != 0 && (errno == ENOSPC || errno == EFBIG))
    throw Failure(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
}

/// Where a file cannot be named, its bytes go into one that has a name.
void copy_to(const std::string& path, int descriptor) {
  OutputFile file(path);
  std::vector<char> block(std::size_t{4} << 20);
  off_t at = 0;
  for (ssize_t count; (count = pread(descriptor, block.data(), block.size(), at)) != 0; at += count) {
    if (count < 0) throw Failure(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
    file.write(block.data(), static_cast<std::size_t>(count));
  }
  file.commit();
}

}  // namespace

bool is_large_npy(const NpyImageShape& shape) {
  return shape.rows * shape.columns * shape.bands > LargeFloats::most_in_memory;
}

NpyBands::NpyBands(int descriptor, const std::string& path, const NpyImageShape& shape)
    : path_(path),
      shape_(shape),
      turned_(static_cast<std::size_t>(thread_count()) + 1),
      stream_(descriptor, path) {
  const std::string header = header_of(shape);
  stream_.write(header.data(), header.size());
}

void NpyBands::add(std::span<const float> plane) {
  if (plane.size() != shape_.rows * shape_.columns || added_ == shape_.bands)
    throw InputError(path_, fmt::format("{} values for band {} of an image of {} bands of {}", plane.size(),
                                        added_, shape_.bands, shape_.rows * shape_.columns));
  // Some columns at a time: what is turned stays in the cache until it is written.
  constexpr std::size_t columns_at_once = 128;
  const std::size_t blocks = (shape_.columns + columns_at_once - 1) / columns_at_once;
  parallel_stages(blocks, turned_.size(),
                  {[](std::size_t, std::size_t) {},
                   [&](std::size_t block, std::size_t slot) {
                     const std::size_t first = block * columns_at_once,
                                       count = std::min(columns_at_once, shape_.columns - first);
                     turned_[slot].resize(count * shape_.rows);
                     transpose<float>({plane.data() + first, shape_.columns}, shape_.rows, count,
                                      {turned_[slot].data(), shape_.rows});
                   },
                   [&](std::size_t, std::size_t slot) {
                     stream_.write(turned_[slot].data(), turned_[slot].size() * sizeof(float));
                   }});
  ++added_;
}

void NpyBands::finish() {
  if (added_ != shape_.bands)
    throw InputError(path_, fmt::format("{} bands of {} were given", added_, shape_.bands));
  stream_.finish();
}

NpyBandFile::NpyBandFile(const std::string& path, const NpyImageShape& shape)
    : file_(std::filesystem::path(WholeFile(path).path()).parent_path().string()) {
  if (!file_) return;
  take_room(file_.descriptor(), path, shape);
  bands_ = std::make_unique<NpyBands>(file_.descriptor(), path, shape);
}

void NpyBandFile::put_at(const std::string& path) {
  bands_->finish();
  WholeFile whole(path);
  if (!file_.link(whole.temporary_path())) return copy_to(path, file_.descriptor());
  whole.commit();
}

}  // namespace petzval
