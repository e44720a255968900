// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/dataset/tar_file.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <numeric>

namespace petzval {

namespace {

constexpr std::size_t block = 512, most_name = 100, size_at = 124, size_digits = 11, checksum_at = 148;
constexpr std::uint64_t most_size = std::uint64_t{1} << 33;

void put(std::string& header, std::size_t at, std::string_view text) {
  std::copy(text.begin(), text.end(), header.begin() + static_cast<std::ptrdiff_t>(at));
}

std::string header_of(const std::string& name, std::uint64_t size) {
  std::string header(block, '\0');
  put(header, 0, name);
  put(header, 100, "0000644");  // mode
  put(header, 108, "0000000");  // owner
  put(header, 116, "0000000");  // group
  put(header, size_at, fmt::format("{:011o}", size));
  put(header, 136, "00000000000");  // time
  put(header, checksum_at, "        ");
  put(header, 156, "0");  // a plain file
  put(header, 257, std::string_view("ustar\00000", 8));
  const unsigned sum = std::accumulate(header.begin(), header.end(), 0u, [](unsigned total, char each) {
    return total + static_cast<unsigned char>(each);
  });
  put(header, checksum_at, fmt::format("{:06o}", sum));
  header[checksum_at + 6] = '\0', header[checksum_at + 7] = ' ';
  return header;
}

std::uint64_t padding(std::uint64_t size) {
  return (block - size % block) % block;
}

std::uint32_t with_bytes(std::uint32_t sum, std::string_view bytes) {
  while (!bytes.empty()) {
    const std::string_view part = bytes.substr(0, std::size_t{1} << 30);
    sum = static_cast<std::uint32_t>(
        ::crc32(sum, reinterpret_cast<const Bytef*>(part.data()), static_cast<uInt>(part.size())));
    bytes.remove_prefix(part.size());
  }
  return sum;
}

bool all_zero(std::string_view bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](char each) { return each == '\0'; });
}

}  // namespace

TarWriter::TarWriter(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  if (!file_) throw Failure(path + ": cannot be written");
}

void TarWriter::write(std::string_view bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file_) throw Failure(path_ + ": cannot be written; is the disk full?");
  bytes_ += bytes.size();
  crc32_ = with_bytes(crc32_, bytes);
}

std::string TarWriter::crc32() const {
  return fmt::format("{:08x}", crc32_);
}

void TarWriter::add(const std::string& name, std::string_view bytes) {
  if (name.empty() || name.size() > most_name)
    throw InputError(path_, fmt::format("a name of {} bytes does not fit a tar archive", name.size()));
  if (bytes.size() >= most_size) throw InputError(path_, "a file of 8 GiB does not fit a tar archive");
  write(header_of(name, bytes.size()));
  write(bytes);
  write(std::string(padding(bytes.size()), '\0'));
}

void TarWriter::finish() {
  write(std::string(2 * block, '\0'));
  file_.close();
  if (!file_) throw Failure(path_ + ": cannot be written; is the disk full?");
}

TarReader::TarReader(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  std::error_code failed;
  left_ = std::filesystem::file_size(path, failed);
  if (!file_ || failed) throw InputError(path, "cannot be read");
}

void TarReader::fail(const std::string& problem) const {
  throw InputError(path_, problem);
}

std::string TarReader::take(std::uint64_t bytes) {
  if (bytes > left_) fail("ends too early");
  std::string taken(bytes, '\0');
  file_.read(taken.data(), static_cast<std::streamsize>(bytes));
  if (!file_) fail("cannot be read to its end");
  left_ -= bytes;
  crc32_ = with_bytes(crc32_, taken);
  return taken;
}

std::string TarReader::crc32() const {
  return fmt::format("{:08x}", crc32_);
}

bool TarReader::next(std::string& name, std::string& bytes) {
  const std::string header = take(block);
  if (all_zero(header)) {
    if (!all_zero(take(block)) || left_ != 0) fail("has something behind its end");
    return false;
  }
  name = header.substr(0, std::min(header.find('\0'), most_name));
  std::uint64_t size = 0;
  const char* digits = header.data() + size_at;
  std::from_chars(digits, digits + size_digits, size, 8);
  if (header != header_of(name, size)) fail("has a damaged header");
  bytes = take(size);
  if (!all_zero(take(padding(size)))) fail(fmt::format("has something between {} and the next file", name));
  return true;
}

std::string crc32_text(std::string_view bytes) {
  return fmt::format("{:08x}", with_bytes(0, bytes));
}

}  // namespace petzval
