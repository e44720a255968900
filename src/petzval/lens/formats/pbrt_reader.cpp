// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/formats/pbrt.h>
#include <petzval/lens/formats/row_lens.h>

#include <cmath>

namespace petzval {

namespace {

constexpr const char* row_form = "radius, thickness, index behind, aperture diameter";

/// What a .dat file holds, before it is a lens.
struct PbrtTable {
  std::vector<LensRow> rows;
  std::vector<std::string> comments;
  std::optional<double> stated_focal_length_mm;
  int stop_line = 0;
};

LensRow row_of(const std::vector<double>& numbers, const std::string& radius, const std::string& file,
               int line) {
  const bool stop = numbers[0] == 0;
  const LensRow row{stop ? 0 : curvature_from_radius(radius), numbers[1], numbers[2], numbers[3] / 2, stop};
  if (!(row.index_after >= 1) && !(stop && row.index_after == 0))
    throw InputError(
        file, line,
        fmt::format("the index {} is below 1; 1 is air, 0 stands at the stop only", row.index_after));
  if (!(row.semi_diameter_mm > 0))
    throw InputError(file, line, fmt::format("the aperture diameter {} must be positive", numbers[3]));
  return row;
}

void read_row(const TextLine& line, const std::string& file, PbrtTable& table) {
  std::vector<double> numbers;
  for (const std::string& word : line.words) {
    const auto number = parse_number(word);
    if (!number)
      throw InputError(file, line.number,
                       fmt::format("\"{}\" is not a number; a row has {}", quotable(word), row_form));
    numbers.push_back(*number);
  }
  if (numbers.size() == 1 && table.rows.empty() && !table.stated_focal_length_mm) {
    table.stated_focal_length_mm = numbers[0];
    return;
  }
  if (numbers.size() != 4)
    throw InputError(file, line.number,
                     fmt::format("a row has 4 numbers ({}), not {}", row_form, numbers.size()));
  const LensRow row = row_of(numbers, line.words[0], file, line.number);
  if (row.stop) {
    if (table.stop_line != 0)
      throw InputError(
          file, line.number,
          fmt::format("a second stop (radius 0) beside line {}; give a flat surface a large radius",
                      table.stop_line));
    table.stop_line = line.number;
  }
  table.rows.push_back(row);
}

PbrtTable read_table(const std::string& text, const std::string& file) {
  PbrtTable table;
  for (TextLine& line : text_lines(text)) {
    const std::size_t hash = line.text.find('#');
    if (hash != std::string::npos) {
      table.comments.push_back(trimmed(line.text.substr(hash + 1)));
      line.words = split_words(line.text.substr(0, hash));
    }
    if (!line.words.empty()) read_row(line, file, table);
  }
  if (table.rows.empty())
    throw InputError(file, fmt::format("holds no lens; a .dat file has rows of {}", row_form));
  if (table.stop_line == 0) throw InputError(file, "has no stop; the stop is the row with radius 0");
  return table;
}

}  // namespace

LensFile read_pbrt(const std::string& text, const std::string& file) {
  const PbrtTable table = read_table(text, file);
  LensFile result;
  try {
    result = lens_from_rows(table.rows);
  } catch (const InputError& error) {
    throw InputError(file, error.what());
  }
  for (const std::string& comment : table.comments)
    if (!comment.empty()) result.lens.source += (result.lens.source.empty() ? "" : "; ") + comment;
  if (table.stated_focal_length_mm)
    result.notes.push_back(
        fmt::format("{}: the stated focal length of {} mm is not used", file, *table.stated_focal_length_mm));
  return result;
}

}  // namespace petzval
