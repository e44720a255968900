// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/glass/byte_reader.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace petzval {

namespace {

constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    table[i] = i;
    for (int bit = 0; bit < 8; ++bit) table[i] = (table[i] >> 1) ^ (table[i] & 1 ? 0xEDB88320u : 0u);
  }
  return table;
}

/// Powers of ten that a double holds exactly: with a mantissa below 2⁵³ one multiplication or division then
/// gives the double nearest to the decimal.
constexpr std::array<double, 23> powers_of_ten = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                  1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr std::int64_t largest_mantissa = (std::int64_t{1} << 53) - 1;

double decimal(std::int64_t mantissa, int exponent) {
  const double power = powers_of_ten[static_cast<std::size_t>(std::abs(exponent))];
  return exponent < 0 ? static_cast<double>(mantissa) / power : static_cast<double>(mantissa) * power;
}

}  // namespace

void ByteReader::damaged(const std::string& why) const {
  throw InputError(file_, "the glass catalogue is damaged: " + why + "; tools/pack_glass.py makes a new one");
}

std::string_view ByteReader::take(std::size_t count) {
  if (count > remaining()) damaged("it ends early");
  at_ += count;
  return bytes_.substr(at_ - count, count);
}

std::uint8_t ByteReader::byte() {
  return static_cast<std::uint8_t>(take(1)[0]);
}

std::uint32_t ByteReader::u32() {
  std::uint32_t value = 0;
  for (int shift = 0; shift < 32; shift += 8) value |= std::uint32_t{byte()} << shift;
  return value;
}

std::uint64_t ByteReader::varint() {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 63; shift += 7) {
    const std::uint8_t next = byte();
    value |= std::uint64_t{next & 0x7Fu} << shift;
    if (next < 0x80) return value;
  }
  damaged("a number without an end");
}

std::int64_t ByteReader::signed_varint() {
  const std::uint64_t zigzag = varint();
  const auto half = static_cast<std::int64_t>(zigzag >> 1);
  return zigzag & 1 ? -half - 1 : half;
}

std::string_view ByteReader::text() {
  const std::string_view text = take(count());
  if (text.empty() || !std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < '\x7f'; }))
    damaged("a name that cannot be one");
  return text;
}

std::size_t ByteReader::count() {
  const std::uint64_t count = varint();
  if (count > remaining()) damaged("it ends early");
  return static_cast<std::size_t>(count);
}

int ByteReader::exponent() {
  const int exponent = static_cast<std::int8_t>(byte());
  if (static_cast<std::size_t>(std::abs(exponent)) >= powers_of_ten.size())
    damaged("a power of ten out of range");
  return exponent;
}

double ByteReader::number() {
  const std::int64_t mantissa = signed_varint();
  if (std::abs(mantissa) > largest_mantissa) damaged("a mantissa out of range");
  return decimal(mantissa, exponent());
}

std::vector<double> ByteReader::column(std::size_t size) {
  const int power = exponent();
  std::vector<double> values;
  values.reserve(std::min(size, remaining()));
  std::int64_t mantissa = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::int64_t difference = signed_varint();
    // Checked before the sum, so that the sum cannot overflow.
    if (std::abs(difference) > 2 * largest_mantissa) damaged("a mantissa out of range");
    mantissa += difference;
    if (std::abs(mantissa) > largest_mantissa) damaged("a mantissa out of range");
    values.push_back(decimal(mantissa, power));
  }
  return values;
}

std::uint32_t crc32(std::string_view bytes) {
  static constexpr std::array<std::uint32_t, 256> table = crc_table();
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const char c : bytes) crc = (crc >> 8) ^ table[(crc ^ static_cast<std::uint8_t>(c)) & 0xFFu];
  return ~crc;
}

}  // namespace petzval
