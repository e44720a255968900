// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/image/formats/npy_file.h>
#include <petzval/image/formats/npy_header.h>

#include <bit>

namespace petzval {

static_assert(std::endian::native == std::endian::little, "the .npy writers write memory as it is");

std::string npy_header(std::string_view type, std::span<const std::size_t> shape, NpyOrder order) {
  std::string sizes;
  for (const std::size_t size : shape) sizes += fmt::format("{}, ", size);
  if (shape.size() > 1) sizes.resize(sizes.size() - 2);
  std::string dictionary = fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': ({}), }}", type,
                                       order == NpyOrder::fortran ? "True" : "False", sizes);
  constexpr std::size_t before = 10;  // magic, two bytes of version, two of length
  dictionary.append(63 - (before + dictionary.size()) % 64, ' ');
  dictionary += '\n';
  std::string bytes(npy_magic);
  bytes += '\x01';
  bytes += '\x00';
  bytes += static_cast<char>(dictionary.size() & 0xff);
  bytes += static_cast<char>(dictionary.size() >> 8);
  return bytes + dictionary;
}

}  // namespace petzval
