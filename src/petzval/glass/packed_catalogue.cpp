// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/glass/byte_reader.h>
#include <petzval/glass/packed_catalogue.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

constexpr std::string_view magic = "PZGLASS1";
constexpr std::array statuses = {"", "preferred", "standard", "special"};

using Table = std::vector<std::pair<double, double>>;

/// Wavelengths must increase from above zero, values must lie within [smallest, largest].
Table read_table(ByteReader& reader, double smallest, double largest) {
  Table table;
  const std::size_t rows = reader.count();
  if (rows == 0) return table;
  const std::vector<double> wavelengths_nm = reader.column(rows), values = reader.column(rows);
  table.reserve(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    if (wavelengths_nm[i] <= (i == 0 ? 0 : wavelengths_nm[i - 1])) reader.damaged("a table out of order");
    if (values[i] < smallest || values[i] > largest) reader.damaged("a table with a value that cannot be");
    table.emplace_back(wavelengths_nm[i], values[i]);
  }
  return table;
}

std::optional<double> stated(double value) {
  return value > 0 ? std::optional(value) : std::nullopt;
}

void check_formula(const ByteReader& reader, const Glass& glass) {
  if (glass.formula > 9) reader.damaged("an unknown formula");
  try {
    if (glass.formula != 0) check_dispersion_formula(glass.formula, glass.coefficients);
  } catch (const InputError&) {
    reader.damaged(fmt::format("formula {} without its numbers", glass.formula));
  }
  if (glass.formula == 0 && glass.n_table.empty()) reader.damaged("formula 0 without its numbers");
  if (!(0 < glass.shortest_nm && glass.shortest_nm < glass.longest_nm))
    reader.damaged("a valid range that is none");
}

}  // namespace

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return upper;
}

PackedCatalogue::PackedCatalogue(std::string bytes, std::string file)
    : bytes_(std::move(bytes)), file_(std::move(file)) {
  if (!bytes_.starts_with(magic))
    throw InputError(
        file_, fmt::format("not a packed glass catalogue of this version (it would begin with {})", magic));
  ByteReader reader(bytes_, file_);
  reader.take(magic.size());
  const std::uint32_t checksum = reader.u32();
  if (crc32(std::string_view(bytes_).substr(reader.position())) != checksum)
    reader.damaged("its checksum is wrong");
  const std::size_t glasses = reader.u32(), names = reader.u32();
  if (glasses > reader.remaining() || names > reader.remaining()) reader.damaged("it ends early");
  read_names(reader, names, glasses);
  read_records(reader, glasses);
  if (reader.remaining() != 0) reader.damaged("it goes on after its end");
}

void PackedCatalogue::read_names(ByteReader& reader, std::size_t count, std::size_t glass_count) {
  names_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view full = reader.text();
    const std::uint64_t glass = reader.varint();
    const std::size_t colon = full.find(':');
    if (colon == 0 || colon == full.npos || colon + 1 == full.size())
      reader.damaged("a name without its catalogue");
    if (glass >= glass_count) reader.damaged("a name for a glass that is not there");
    names_.push_back({std::string(full), upper_case(full), static_cast<std::size_t>(glass)});
    if (i > 0 && names_[i].folded <= names_[i - 1].folded) reader.damaged("names out of order");
  }
}

void PackedCatalogue::read_records(ByteReader& reader, std::size_t count) {
  records_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t size = reader.count(), offset = reader.position();
    ByteReader record(reader.take(size), file_);
    const std::uint64_t name = record.varint();
    if (name >= names_.size() || names_[name].glass != i) reader.damaged("a glass without a name");
    names_[name].proper = true;
    records_.push_back({offset, size, static_cast<std::size_t>(name)});
  }
}

Glass PackedCatalogue::glass(std::size_t number) const {
  const Record& where = records_.at(number);
  ByteReader reader(std::string_view(bytes_).substr(where.offset, where.size), file_);
  reader.varint();  // its name, known since opening
  const std::string& full = names_[where.name].full;
  const std::size_t colon = full.find(':');
  Glass glass;
  glass.catalogue = full.substr(0, colon);
  glass.name = full.substr(colon + 1);
  glass.formula = reader.byte();
  const std::size_t status = reader.byte();
  if (status >= statuses.size()) reader.damaged("an unknown status");
  glass.status = statuses[status];
  glass.stated_nd = stated(reader.number());
  glass.stated_vd = stated(reader.number());
  glass.shortest_nm = reader.number();
  glass.longest_nm = reader.number();
  const std::size_t coefficients = reader.count();
  for (std::size_t i = 0; i < coefficients; ++i) glass.coefficients.push_back(reader.number());
  constexpr double smallest_index = 1e-3, largest_index = 100, largest_extinction = 100;
  glass.n_table = read_table(reader, smallest_index, largest_index);
  glass.k_table = read_table(reader, 0, largest_extinction);
  check_formula(reader, glass);
  if (reader.remaining() != 0) reader.damaged("a glass that goes on after its end");
  return glass;
}

}  // namespace petzval
