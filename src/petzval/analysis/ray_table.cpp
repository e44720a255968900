// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/ray_table.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/transfer_limits.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace petzval {

namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 28;
/// Columns before those of the apertures: the wavelength, the ray in front and the ray behind.
constexpr std::size_t ray_columns = 9;

double number_at(const std::string& cell, const std::string& path, int line) {
  const std::optional<double> value = parse_number(trimmed(cell));
  if (!value || !std::isfinite(*value))
    throw InputError(path, line, fmt::format("\"{}\" is not a number", quotable(cell)));
  return *value;
}

std::string header_of(std::size_t apertures) {
  std::string header = "wavelength_nm,in_x_mm,in_y_mm,in_l,in_m,out_x_mm,out_y_mm,out_l,out_m";
  for (std::size_t i = 1; i <= apertures; ++i)
    header += fmt::format(",aperture_{0}_x_mm,aperture_{0}_y_mm", i);
  return header;
}

/// A line "# key: value" before the columns.
void read_fact(RayTable& table, const TextLine& line, const std::string& path) {
  const std::size_t colon = line.text.find(':');
  if (colon == std::string::npos) return;
  const std::string key = trimmed(line.text.substr(1, colon - 1)),
                    value = trimmed(line.text.substr(colon + 1));
  const auto length = [&] {
    const double mm = number_at(value, path, line.number);
    if (!(mm > 0)) throw InputError(path, line.number, key + " must be positive");
    return mm;
  };
  if (key == "name") table.name = value;
  if (key == "length_mm") table.length_mm = length();
  if (key == "film_mm") table.film_mm = length();
  if (key != "aperture_radii_mm") return;
  for (const std::string& word : split_words(value)) {
    table.aperture_radii_mm.push_back(number_at(word, path, line.number));
    if (!(table.aperture_radii_mm.back() > 0)) throw InputError(path, line.number, key + " must be positive");
  }
}

void require_facts(const RayTable& table, const std::string& path, int line) {
  if (!(table.length_mm > 0 && table.film_mm > 0))
    throw InputError(path, line,
                     "lines \"# length_mm: ...\" and \"# film_mm: ...\" must stand before the columns");
  // The film is one aperture more.
  if (table.aperture_radii_mm.empty() || table.aperture_radii_mm.size() >= most_transfer_apertures)
    throw InputError(
        path, line,
        fmt::format("a line \"# aperture_radii_mm: ...\" with 1 to {} radii, the stop first, must "
                    "stand before the columns",
                    most_transfer_apertures - 1));
}

/// Direction cosines of the light; a RayTransfer's rays run against it.
TransferRay ray_at(const std::vector<double>& numbers, std::size_t first, const std::string& path, int line) {
  const TransferRay ray{numbers[first], numbers[first + 1], -numbers[first + 2], -numbers[first + 3]};
  if (!(ray.l * ray.l + ray.m * ray.m < 1))
    throw InputError(path, line, "direction cosines l and m must have squares that sum to less than 1");
  return ray;
}

RayTable::Row row_of(const TextLine& line, std::size_t apertures, const std::string& path) {
  const std::vector<std::string> cells = split_at(line.text, ',');
  const std::size_t columns = ray_columns + 2 * apertures;
  if (cells.size() != columns)
    throw InputError(path, line.number, fmt::format("has {} numbers for {} columns", cells.size(), columns));
  std::vector<double> numbers;
  for (const std::string& cell : cells) numbers.push_back(number_at(cell, path, line.number));
  if (!(numbers[0] > 0)) throw InputError(path, line.number, "its wavelength must be positive, in nm");
  RayTable::Row row{
      numbers[0], ray_at(numbers, 1, path, line.number), ray_at(numbers, 5, path, line.number), {}};
  for (std::size_t i = 0; i < apertures; ++i)
    row.at_apertures.push_back({numbers[ray_columns + 2 * i], numbers[ray_columns + 2 * i + 1]});
  return row;
}

}  // namespace

RayTable ray_table_of(std::string_view text, const std::string& path) {
  RayTable table;
  bool has_columns = false;
  for (const TextLine& line : text_lines(decoded_text(text))) {
    const std::string content = trimmed(line.text);
    if (content.empty()) continue;
    if (content[0] == '#') {
      if (!has_columns) read_fact(table, {line.number, content, {}}, path);
    } else if (has_columns) {
      table.rows.push_back(row_of(line, table.aperture_radii_mm.size(), path));
    } else {
      require_facts(table, path, line.number);
      const std::string header = header_of(table.aperture_radii_mm.size());
      if (content != header) throw InputError(path, line.number, "its columns must be " + header);
      has_columns = true;
    }
  }
  if (table.rows.empty()) throw InputError(path, "holds no rays");
  return table;
}

RayTable read_ray_table(const std::string& path) {
  return ray_table_of(read_whole_file(path, most_bytes), path);
}

std::string ray_table_text(const RayTable& table) {
  std::string radii;
  for (const double radius : table.aperture_radii_mm) radii.append(1, ' ').append(number_text(radius));
  std::string text =
      fmt::format("# name: {}\n# length_mm: {}\n# film_mm: {}\n# aperture_radii_mm:{}\n{}\n",
                  trimmed(table.name), number_text(table.length_mm), number_text(table.film_mm), radii,
                  header_of(table.aperture_radii_mm.size()));
  for (const RayTable::Row& row : table.rows) {
    text += number_text(row.wavelength_nm);
    const auto add = [&](double number) { text.append(1, ',').append(number_text(number)); };
    for (const TransferRay& ray : {row.front, row.rear})
      for (const double number : {ray.x, ray.y, -ray.l, -ray.m}) add(number);
    for (const auto& place : row.at_apertures) add(place[0]), add(place[1]);
    text += '\n';
  }
  return text;
}

}  // namespace petzval
