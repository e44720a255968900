// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/helper_process.h>
#include <petzval/base/nameless_file.h>
#include <petzval/scene/formats/mat_hdf5_apart.h>
#include <petzval/scene/formats/mat_hdf5_array.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

namespace petzval {

namespace {

/// The 128 bytes that all MAT files since version 5 begin with.
constexpr std::size_t head_bytes = 128;

double size_of_file(const std::string& path) {
  struct stat about {};
  return stat(path.c_str(), &about) == 0 ? static_cast<double>(about.st_size) : 0;
}

}  // namespace

bool is_mat_hdf5(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, head_bytes> head{};
  file.read(head.data(), head.size());
  if (file.gcount() < static_cast<std::streamsize>(head_bytes)) return false;  // which others will say
  const std::string_view text(head.data(), head.size());
  if (!text.starts_with("MATLAB")) return false;
  const int version = text.substr(126) == "IM" ? text[125] : text[124];
  return version == 2;
}

MappedRecords mat_hdf5_records(const std::string& path, const std::vector<std::string>& variables) {
  const NamelessFile file;
  if (!file) throw Failure("there is no room for files in $TMPDIR or /var/tmp");
  // Much more than any sound file takes: 10 s a megabyte, which may unpack to a gigabyte.
  HelperLimits limits;
  limits.processor_s = 5 + 1e-5 * size_of_file(path);
  std::vector<std::string> words{"mat", path};
  words.insert(words.end(), variables.begin(), variables.end());
  const HelperEnd end = run_helper(helper_program("petzval-read-hdf5"), words, file.descriptor(), limits);
  if (end == HelperEnd::crashed) refuse_damaged_mat(path, "the HDF5 library crashes on it");
  if (end == HelperEnd::endless) refuse_damaged_mat(path, "the HDF5 library finds no end");

  struct stat about {};
  if (fstat(file.descriptor(), &about) != 0) throw Failure(path + ": its variables are lost");
  const auto size = static_cast<std::size_t>(about.st_size);
  if (size == 0) return {};
  void* const memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE, file.descriptor(), 0);
  if (memory == MAP_FAILED) throw Failure(path + ": there is too little memory for its variables");
  return {{memory, [size](void* mapped) { munmap(mapped, size); }}, {static_cast<std::byte*>(memory), size}};
}

}  // namespace petzval
