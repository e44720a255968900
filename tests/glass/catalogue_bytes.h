// SPDX-License-Identifier: BSD-3-Clause
// Writes packed catalogues for tests, after data/glass/README.md and not after the packer or the reader.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace petzval::testing {

/// A decimal, mantissa·10^exponent.
struct Decimal {
  long long mantissa;
  int exponent;
};

/// One exponent for a column of mantissas.
struct Column {
  int exponent;
  std::vector<long long> mantissas;
};

struct GlassBytes {
  std::uint64_t name = 0;
  int formula = 2, status = 0;
  Decimal nd{0, 0}, vd{0, 0}, shortest_nm{4, 2}, longest_nm{7, 2};
  std::vector<Decimal> coefficients;
  std::pair<Column, Column> n_table, k_table;
};

std::string u32_bytes(std::uint32_t value);
std::string varint_bytes(std::uint64_t value);
std::string text_bytes(const std::string& text);
std::string record_bytes(const GlassBytes& glass);

/// The bytes of a whole catalogue. `names` are (full name, number of the glass) and must come sorted.
std::string catalogue_bytes(const std::vector<std::pair<std::string, std::uint64_t>>& names,
                            const std::vector<GlassBytes>& glasses);
/// With magic, counts and checksum around names and records, whatever they are.
std::string framed(std::uint32_t glasses, std::uint32_t names, const std::string& rest);
/// The same bytes with the checksum that makes them pass for whole.
std::string with_checksum(std::string bytes);

/// A catalogue that has one glass of every kind: a Sellmeier glass with absorption and an alias, a table, a
/// power series, a Cauchy glass, and a second catalogue with two of the same bare names.
std::string small_catalogue();

}  // namespace petzval::testing
