// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/optics/table_layout.h>
#include <petzval/optics/table_seal.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace petzval {

namespace {

constexpr std::size_t block_bytes = 1 << 16;

/// FNV-1a, 64 bits (Fowler, Noll & Vo): every step is invertible, so any single altered byte is noticed.
class Checksum {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

/// HDF5 files begin with this, or have it behind a user block of 512 bytes times a power of two.
constexpr std::string_view hdf5_signature("\x89HDF\r\n\x1a\n", 8);

[[noreturn]] void refuse_unsealed(const std::string& path, std::ifstream& file, const std::string& start) {
  std::string behind(hdf5_signature.size(), '\0');
  file.read(behind.data(), static_cast<std::streamsize>(behind.size()));
  if (!start.starts_with(hdf5_signature) && behind != hdf5_signature)
    throw InputError(path, "is not an HDF5 file, as lens data tables are");
  throw InputError(path,
                   "is damaged, or a table of another program: it does not begin with Petzval's checksum; "
                   "importing it (from hdf5) would be right for a table made elsewhere");
}

std::string seal_text(std::uint64_t size, const Checksum& checksum) {
  return fmt::format("{}\nsize {}\nfnv1a64 {:016x}\n", table_layout::format, size, checksum.value());
}

}  // namespace

std::string table_seal(std::string_view contents) {
  Checksum checksum;
  checksum.add(contents);
  std::string block = seal_text(contents.size(), checksum);
  block.resize(table_seal_bytes, '\0');
  return block;
}

void check_table_seal(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw InputError(path, "is a folder, not a lens data table");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path, "cannot be read; is it there?");
  std::string seal(table_seal_bytes, '\0');
  file.read(seal.data(), static_cast<std::streamsize>(seal.size()));
  seal.resize(static_cast<std::size_t>(file.gcount()));
  if (!seal.starts_with(std::string(table_layout::format) + "\n")) refuse_unsealed(path, file, seal);

  Checksum checksum;
  std::uint64_t size = 0;
  for (std::array<char, block_bytes> block; file;) {
    file.read(block.data(), block.size());
    const auto got = static_cast<std::size_t>(file.gcount());
    checksum.add({block.data(), got});
    size += got;
  }
  if (!seal.starts_with(seal_text(size, checksum)))
    throw InputError(path,
                     "is damaged: size or checksum do not agree with its first lines; building it anew would "
                     "be right, or importing it (from hdf5) if "
                     "it was edited on purpose");
}

}  // namespace petzval
