// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/optics/formats/psf_listing.h>

#include <array>
#include <charconv>
#include <cmath>

namespace petzval {

namespace {

constexpr int largest_side = 16384;
constexpr double listing_bytes_per_gib = 1 << 30;

/// The numbers in a line of prose: "Data area is 32.00 by 32.00 µm." has two.
std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  for (std::string word : split_words(text)) {
    while (!word.empty() && (word.back() == ',' || word.back() == '.' || word.back() == ';')) word.pop_back();
    if (const std::optional<double> number = parse_number(word)) numbers.push_back(*number);
  }
  return numbers;
}

/// What stands behind `label` in a line; nothing if it does not begin so.
std::optional<std::string_view> after(std::string_view line, std::string_view label) {
  const std::size_t at = line.find_first_not_of(" \t");
  if (at == std::string_view::npos || line.substr(at, label.size()) != label) return {};
  return line.substr(at + label.size());
}

/// Micrometres in a unit that a line ends with.
double unit_um(std::string_view line) {
  for (const auto& [name, um] : {std::pair<std::string_view, double>{"mm", 1e3}, {"nm", 1e-3}, {"cm", 1e4}})
    if (line.find(name) != std::string_view::npos) return um;
  return 1;
}

struct Header {
  std::string file;
  int rows = 0, columns = 0;
  double spacing_um = 0, area_um = 0;
  std::optional<std::pair<int, int>> centre;  ///< from 1
  std::optional<std::pair<double, double>> image_point_mm;

  [[noreturn]] void fail(const TextLine& line, const std::string& what) const {
    throw InputError(file, line.number, what);
  }

  std::vector<double> numbers(const TextLine& line, std::string_view text, std::size_t count) const {
    std::vector<double> found = numbers_in(text);
    if (found.size() < count)
      fail(line, fmt::format("\"{}\" has no {}", quotable(line.text), count == 1 ? "number" : "two numbers"));
    return found;
  }

  void take_grid(const TextLine& line, std::string_view text) {
    const std::vector<double> sizes = numbers(line, text, 2);
    for (const double size : {sizes[0], sizes[1]})
      if (!(size >= 1 && size <= largest_side) || size != std::floor(size))
        fail(line,
             fmt::format("a grid of {:g} by {:g} samples would take {:.3g} GiB of memory; up to {} a side "
                         "are read",
                         sizes[0], sizes[1], 8 * sizes[0] * sizes[1] / listing_bytes_per_gib, largest_side));
    columns = static_cast<int>(sizes[0]);
    rows = static_cast<int>(sizes[1]);
  }

  void take_centre(const TextLine& line, std::string_view text) {
    const std::vector<double> point = numbers(line, text, 2);
    const bool column_first = text.find("column") < text.find("row");
    for (const double number : {point[0], point[1]})
      if (!(number >= 1 && number <= largest_side)) fail(line, "the centre point is outside the grid");
    const int first = static_cast<int>(point[0]), second = static_cast<int>(point[1]);
    centre = column_first ? std::pair(second, first) : std::pair(first, second);
  }

  void take(const TextLine& line) {
    if (const auto text = after(line.text, "Data spacing is"))
      spacing_um = numbers(line, *text, 1)[0] * unit_um(*text);
    if (const auto text = after(line.text, "Data area is"))
      area_um = numbers(line, *text, 1)[0] * unit_um(*text);
    if (const auto text = after(line.text, "Image grid size:")) take_grid(line, *text);
    if (const auto text = after(line.text, "Center point is:")) take_centre(line, *text);
    if (const auto text = after(line.text, "Center coordinates:")) {
      const std::vector<double> point = numbers(line, *text, 2);
      image_point_mm = std::pair(point[0], point[1]);
    }
  }

  /// Data area, spacing and samples say the same thing twice.
  void require_agreement() const {
    constexpr double widest_um = 1e6;
    if (!(spacing_um >= 0 && spacing_um <= widest_um))
      throw InputError(
          file, fmt::format("has a data spacing of {} µm; 0 to {} would be right", spacing_um, widest_um));
    constexpr double printed_digits = 0.01;
    if (area_um > 0 && spacing_um > 0 && columns > 0 &&
        std::abs(area_um / spacing_um / columns - 1) > printed_digits)
      throw InputError(file, fmt::format("is at odds with itself: {} samples of {:g} µm are no {:g} µm",
                                         columns, spacing_um, area_um));
  }
};

/// All numbers of the text; the first word that is none is refused.
std::vector<double> matrix_numbers(const std::vector<TextLine>& lines, std::size_t from,
                                   const std::string& file, std::size_t most) {
  std::vector<double> values;
  for (std::size_t i = from; i < lines.size(); ++i)
    for (const std::string& word : lines[i].words) {
      double value = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
        throw InputError(file, lines[i].number,
                         fmt::format("\"{}\" is no finite number among the values of a PSF", quotable(word)));
      if (values.size() == most)
        throw InputError(file, lines[i].number,
                         fmt::format("has more than the {} values that its grid takes", most));
      values.push_back(value);
    }
  return values;
}

/// The first line of the values: behind "Values are …", or the first line of nothing but numbers.
std::size_t first_of_values(const std::vector<TextLine>& lines, Header& header) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    header.take(lines[i]);
    if (after(lines[i].text, "Values are")) return i + 1;
    if (i == 0 && !lines[0].words.empty() && numbers_in(lines[0].text).size() == lines[0].words.size())
      return 0;
  }
  throw InputError(header.file, "is no PSF listing: there is no line \"Values are …\" above the values");
}

}  // namespace

PsfListing read_psf_listing(std::string_view bytes, const std::string& file, int expected_size) {
  const std::vector<TextLine> lines = text_lines(decoded_text(bytes));
  Header header;
  header.file = file;
  const std::size_t from = first_of_values(lines, header);
  header.require_agreement();
  PsfListing listing;
  listing.grid.rows = header.rows > 0 ? header.rows : expected_size;
  listing.grid.columns = header.rows > 0 ? header.columns : expected_size;
  const auto wanted =
      static_cast<std::size_t>(listing.grid.rows) * static_cast<std::size_t>(listing.grid.columns);
  constexpr auto most_values = static_cast<std::size_t>(largest_side) * largest_side;
  listing.grid.values = matrix_numbers(lines, from, file, wanted > 0 ? wanted : most_values);
  if (wanted == 0) {
    const auto side = static_cast<int>(std::lround(std::sqrt(double(listing.grid.values.size()))));
    listing.grid.rows = listing.grid.columns = side;
  }
  const auto needed =
      static_cast<std::size_t>(listing.grid.rows) * static_cast<std::size_t>(listing.grid.columns);
  if (listing.grid.values.size() != needed || needed == 0)
    throw InputError(file,
                     fmt::format("has {} values; a grid of {} by {} takes {}", listing.grid.values.size(),
                                 listing.grid.columns, listing.grid.rows, needed));
  listing.spacing_um = header.spacing_um;
  listing.image_point_mm = header.image_point_mm;
  listing.centre_row = header.centre ? header.centre->first - 1 : listing.grid.rows / 2;
  listing.centre_column = header.centre ? header.centre->second - 1 : listing.grid.columns / 2;
  return listing;
}

PsfFrame listing_frame(int size) {
  return {PsfAway::down, size / 2, size / 2};
}

std::string psf_listing_text(const Psf& psf, int size, double wavelength_nm, double image_height_mm,
                             const std::string& title) {
  const PsfFrame frame = listing_frame(size);
  const NumberGrid grid = grid_of_psf(psf, frame, size);
  std::string text = fmt::format(
      "Listing of PSF Data\n\nTitle: {}\n\n{} µm\nData spacing is {} µm.\nData area is {:.6g} by {:.6g} µm.\n"
      "Image grid size: {} by {}\nCenter point is: row {}, column {}\nCenter coordinates: 0, {}\n"
      "Values are normalized.\n\n",
      quotable(title), wavelength_nm / 1e3, psf.spacing_um, size * psf.spacing_um, size * psf.spacing_um,
      size, size, frame.centre_row + 1, frame.centre_column + 1, -image_height_mm);
  text.reserve(text.size() + grid.values.size() * 12);
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column)
      fmt::format_to(std::back_inserter(text), "{}{}", static_cast<float>(grid.at(row, column)),
                     column + 1 < size ? '\t' : '\n');
  return text;
}

}  // namespace petzval
