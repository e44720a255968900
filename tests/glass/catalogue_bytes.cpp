// SPDX-License-Identifier: BSD-3-Clause
#include "catalogue_bytes.h"

namespace petzval::testing {

namespace {

constexpr std::size_t checksum_at = 8, checked_from = 12;

/// CRC-32 bit by bit, as ISO 3309 defines it.
std::uint32_t slow_crc32(const std::string& bytes, std::size_t from) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (std::size_t i = from; i < bytes.size(); ++i) {
    crc ^= static_cast<std::uint8_t>(bytes[i]);
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
  }
  return ~crc;
}

std::string signed_bytes(long long value) {
  return varint_bytes(value >= 0 ? 2 * static_cast<std::uint64_t>(value)
                                 : 2 * static_cast<std::uint64_t>(-(value + 1)) + 1);
}

std::string number_bytes(const Decimal& number) {
  return signed_bytes(number.mantissa) + static_cast<char>(number.exponent);
}

std::string column_bytes(const Column& column) {
  std::string bytes(1, static_cast<char>(column.exponent));
  long long before = 0;
  for (const long long mantissa : column.mantissas) {
    bytes += signed_bytes(mantissa - before);
    before = mantissa;
  }
  return bytes;
}

std::string table_bytes(const std::pair<Column, Column>& table) {
  std::string bytes = varint_bytes(table.first.mantissas.size());
  if (!table.first.mantissas.empty()) bytes += column_bytes(table.first) + column_bytes(table.second);
  return bytes;
}

}  // namespace

std::string u32_bytes(std::uint32_t value) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xFF);
  return bytes;
}

std::string varint_bytes(std::uint64_t value) {
  std::string bytes;
  for (; value > 127; value /= 128) bytes += static_cast<char>(128 + value % 128);
  return bytes + static_cast<char>(value);
}

std::string text_bytes(const std::string& text) {
  return varint_bytes(text.size()) + text;
}

std::string record_bytes(const GlassBytes& glass) {
  std::string bytes = varint_bytes(glass.name);
  bytes += static_cast<char>(glass.formula);
  bytes += static_cast<char>(glass.status);
  for (const Decimal& number : {glass.nd, glass.vd, glass.shortest_nm, glass.longest_nm})
    bytes += number_bytes(number);
  bytes += varint_bytes(glass.coefficients.size());
  for (const Decimal& number : glass.coefficients) bytes += number_bytes(number);
  return bytes + table_bytes(glass.n_table) + table_bytes(glass.k_table);
}

std::string with_checksum(std::string bytes) {
  return bytes.replace(checksum_at, 4, u32_bytes(slow_crc32(bytes, checked_from)));
}

std::string framed(std::uint32_t glasses, std::uint32_t names, const std::string& rest) {
  return with_checksum("PZGLASS1" + u32_bytes(0) + u32_bytes(glasses) + u32_bytes(names) + rest);
}

std::string catalogue_bytes(const std::vector<std::pair<std::string, std::uint64_t>>& names,
                            const std::vector<GlassBytes>& glasses) {
  std::string rest;
  for (const auto& [name, glass] : names) rest += text_bytes(name) + varint_bytes(glass);
  for (const GlassBytes& glass : glasses) rest += text_bytes(record_bytes(glass));
  return framed(static_cast<std::uint32_t>(glasses.size()), static_cast<std::uint32_t>(names.size()), rest);
}

std::string small_catalogue() {
  GlassBytes sellmeier;  // n² = 1 + 1.25 λ²/(λ² − 0.01)
  sellmeier.name = 1;
  sellmeier.status = 1;
  sellmeier.nd = {15, -1};
  sellmeier.vd = {64, 0};
  sellmeier.coefficients = {{0, 0}, {125, -2}, {1, -2}};
  sellmeier.k_table = {{1, {40, 50, 70}}, {-8, {3, 1, 2}}};
  GlassBytes table;
  table.name = 3;
  table.formula = 0;
  table.n_table = {{1, {40, 50, 60, 70}}, {-2, {160, 155, 152, 150}}};
  GlassBytes powers;  // n² = 2.25
  powers.name = 5;
  powers.formula = 3;
  powers.coefficients = {{225, -2}};
  GlassBytes cauchy;  // n = 1.5 + 0.005 λ^−2
  cauchy.name = 2;
  cauchy.formula = 5;
  cauchy.coefficients = {{15, -1}, {5, -3}, {-2, 0}};
  GlassBytes twin = sellmeier;
  twin.name = 4;
  twin.k_table = {};
  return catalogue_bytes({{"ONE:Alias", 0},
                          {"ONE:Crown", 0},
                          {"ONE:Flint", 3},
                          {"ONE:Table", 1},
                          {"TWO:crown", 4},
                          {"TWO:Flint", 2}},
                         {sellmeier, table, powers, cauchy, twin});
}

}  // namespace petzval::testing
