// SPDX-License-Identifier: BSD-3-Clause
// Reads the elements of a packed catalogue, never beyond its end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// Walks over bytes that nobody vouches for. Every read is checked; each throws InputError naming the file
/// when the bytes end early or say something that cannot be.
class ByteReader {
 public:
  ByteReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  std::size_t remaining() const { return bytes_.size() - at_; }
  std::size_t position() const { return at_; }

  std::string_view take(std::size_t count);
  std::uint8_t byte();
  std::uint32_t u32();           ///< little-endian
  std::uint64_t varint();        ///< unsigned LEB128
  std::int64_t signed_varint();  ///< zigzag
  std::string_view text();       ///< length, then printable ASCII
  /// A number of things that take at least one byte each, and so no more than there are bytes left.
  std::size_t count();
  /// Mantissa and power of ten: the double nearest to the decimal.
  double number();
  /// `size` decimals under one power of ten, each after the first as a difference from the one before.
  std::vector<double> column(std::size_t size);

  /// Always throws InputError: "<file>: the glass catalogue is damaged: <why>".
  [[noreturn]] void damaged(const std::string& why) const;

 private:
  int exponent();

  std::string_view bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
};

/// CRC-32 as in zlib and PNG (ISO 3309).
std::uint32_t crc32(std::string_view bytes);

}  // namespace petzval
