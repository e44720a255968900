// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/glass_lookup.h>
#include <petzval/lens/formats/lens_table.h>
#include <petzval/lens/formats/row_lens.h>
#include <petzval/lens/lens_fault.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string_view>

namespace petzval {

namespace {

using Cells = std::vector<std::string>;

constexpr int most_rows = 1000;

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\"");
  if (first == text.npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1));
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Letters alone: "Semi-Diameter [mm]" and "semi_diameter" are the same heading.
std::string letters_of(const std::string& text) {
  std::string result;
  for (const char c : lower(text.substr(0, text.find_first_of("[("))))
    if (std::isalpha(static_cast<unsigned char>(c))) result += c;
  if (result.ends_with("mm") && result.size() > 2) result.resize(result.size() - 2);
  return result;
}

Cells cells_of(const std::string& line) {
  Cells cells;
  const std::size_t separator = line.find_first_of(",;\t");
  if (separator == line.npos) {
    for (std::size_t at = 0; (at = line.find_first_not_of(" \r", at)) != line.npos;) {
      const std::size_t end = std::min(line.find_first_of(" \r", at), line.size());
      cells.push_back(trimmed(std::string_view(line).substr(at, end - at)));
      at = end;
    }
    return cells;
  }
  const char mark = line.find('\t') != line.npos ? '\t' : line.find(';') != line.npos ? ';' : ',';
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(mark, at), line.size());
    cells.push_back(trimmed(std::string_view(line).substr(at, end - at)));
    at = end + 1;
  }
  return cells;
}

enum class Column { surface, radius, thickness, glass, nd, vd, semi_diameter, diameter, conic, stop };

struct Heading {
  const char* letters;
  Column column;
};
constexpr Heading headings[] = {{"surface", Column::surface},
                                {"surf", Column::surface},
                                {"no", Column::surface},
                                {"radius", Column::radius},
                                {"r", Column::radius},
                                {"thickness", Column::thickness},
                                {"distance", Column::thickness},
                                {"t", Column::thickness},
                                {"d", Column::thickness},
                                {"glass", Column::glass},
                                {"material", Column::glass},
                                {"medium", Column::glass},
                                {"nd", Column::nd},
                                {"n", Column::nd},
                                {"index", Column::nd},
                                {"vd", Column::vd},
                                {"v", Column::vd},
                                {"abbe", Column::vd},
                                {"semidiameter", Column::semi_diameter},
                                {"semi", Column::semi_diameter},
                                {"diameter", Column::diameter},
                                {"dia", Column::diameter},
                                {"conic", Column::conic},
                                {"k", Column::conic},
                                {"stop", Column::stop}};

std::optional<Column> column_of(const std::string& heading) {
  const std::string letters = letters_of(heading);
  for (const Heading& each : headings)
    if (letters == each.letters) return each.column;
  return {};
}

class TableReader {
 public:
  TableReader(std::string file, const LensReadOptions& options) : file_(std::move(file)), glasses_(options) {}

  LensFile read(const std::string& text) {
    std::size_t at = 0;
    while (at < text.size()) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      ++line_;
      take(trimmed(std::string_view(text).substr(at, end - at)));
      at = end + 1;
    }
    return finished();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(file_, line_, what); }

  void take(const std::string& line) {
    if (line.empty()) return;
    if (line[0] == '#' && line.find(':') != line.npos) return take_setting(line.substr(1));
    if (line[0] == '#') return;
    const Cells cells = cells_of(line);
    if (columns_.empty() && take_headings(cells)) return;
    take_surface(cells);
  }

  bool take_headings(const Cells& cells) {
    std::vector<Column> found;
    for (const std::string& cell : cells)
      if (const std::optional<Column> column = column_of(cell)) found.push_back(*column);
    const bool radius = std::ranges::find(found, Column::radius) != found.end();
    if (!radius) {
      columns_ = {Column::radius, Column::thickness, Column::glass, Column::semi_diameter};
      return false;
    }
    if (found.size() != cells.size())
      fail(
          fmt::format("has headings that are not known; radius, thickness, glass, nd, vd, semi-diameter, "
                      "diameter, conic, stop and surface are"));
    columns_ = found;
    return true;
  }

  double number(const std::string& cell, const char* what) const {
    const std::optional<double> value = parse_number(cell);
    if (!value || !std::isfinite(*value)) fail(fmt::format("'{}' is no {}", quotable(cell), what));
    return *value;
  }

  std::vector<double> numbers(std::string text, const char* what) const {
    std::ranges::replace(text, ',', ' ');
    std::vector<double> values;
    for (const std::string& cell : cells_of(text)) values.push_back(number(cell, what));
    if (values.empty()) fail(fmt::format("names no {}", what));
    return values;
  }

  void take_setting(const std::string& line) {
    const std::size_t colon = line.find(':');
    const std::string key = letters_of(trimmed(line.substr(0, colon))),
                      value = trimmed(line.substr(colon + 1));
    Lens& lens = lens_;
    if (key == "name") {
      lens.name = value;
    } else if (key == "source") {
      lens.source = value;
    } else if (key == "fnumber") {
      lens.aperture = {Aperture::Kind::f_number, number(value, "f-number")}, aperture_ = true;
    } else if (key == "aperture") {
      lens.aperture = {Aperture::Kind::entrance_pupil_diameter_mm, number(value, "diameter in mm")};
      aperture_ = true;
    } else if (key == "fields") {
      lens.fields = {Fields::Kind::angle_deg, numbers(value, "angle in degrees")}, fields_ = true;
    } else if (key == "wavelengths") {
      lens.wavelengths_nm = numbers(value, "wavelength in nm");
      lens.reference_wavelength_nm = lens.wavelengths_nm[lens.wavelengths_nm.size() / 2];
      wavelengths_ = true;
    } else if (key == "object") {
      lens.object_distance_mm = number(value, "distance in mm");
    }
  }

  Material glass(const std::string& cell) {
    const std::string word = lower(cell);
    if (word.empty() || word == "air" || word == "-" || word == "1") return Material();
    const std::size_t slash = cell.find('/');
    const std::optional<double> n = parse_number(cell.substr(0, slash));
    try {
      if (!n) return glasses_.find(cell);
      if (slash == cell.npos) return Material(Material::Constant{*n});
      return Material(Material::Model{*n, number(cell.substr(slash + 1), "Abbe number"), 0});
    } catch (const InputError& error) {
      fail(fmt::format("glass {} cannot be used: {}", quotable(cell), error.what()));
    }
  }

  /// What a column says of a surface.
  void take_cell(Column column, const std::string& cell, Surface& surface) {
    const std::string word = lower(cell);
    const bool none = word.empty() || word == "-";
    switch (column) {
      case Column::surface:
        break;
      case Column::radius:
        surface.stop = surface.stop || word == "stop" || word == "sto";
        if (none || surface.stop || word.starts_with("inf") || word == "flat" || word == "plano") break;
        if (const double radius = number(cell, "radius in mm, flat or stop"); radius != 0)
          surface.curvature_per_mm = 1 / radius;
        break;
      case Column::thickness:
        gap_known_ = !none;
        if (!none) surface.thickness_mm = number(cell, "thickness in mm");
        break;
      case Column::glass:
        surface.mirror = word == "mirror";
        if (!surface.mirror) surface.material = glass(cell);
        break;
      case Column::nd:
        if (!none) nd_ = number(cell, "refractive index");
        break;
      case Column::vd:
        if (!none) vd_ = number(cell, "Abbe number");
        break;
      case Column::semi_diameter:
        if (!none) surface.semi_diameter_mm = number(cell, "semi-diameter in mm");
        break;
      case Column::diameter:
        if (!none) surface.semi_diameter_mm = number(cell, "diameter in mm") / 2;
        break;
      case Column::conic:
        if (!none) surface.conic = number(cell, "conic constant");
        break;
      case Column::stop:
        surface.stop = surface.stop || !(none || word == "no" || word == "0" || word == "false");
        break;
    }
  }

  void take_surface(const Cells& cells) {
    if (cells.size() > columns_.size())
      fail(fmt::format("has {} columns; {} are wanted, or a line of headings that names them", cells.size(),
                       columns_.size()));
    if (lens_.surfaces.size() >= most_rows)
      fail(fmt::format("is surface {}; a lens has {} at most", most_rows + 1, most_rows));
    if (!lens_.surfaces.empty() && !gap_known_)
      fail("follows a surface without a thickness; only the last one, before the sensor, can do without");
    Surface surface;
    gap_known_ = false, nd_.reset(), vd_.reset();
    for (std::size_t i = 0; i < cells.size(); ++i) take_cell(columns_[i], cells[i], surface);
    if (nd_ && *nd_ != 1)
      surface.material = glass(vd_ && *vd_ > 0 ? fmt::format("{}/{}", *nd_, *vd_) : fmt::format("{}", *nd_));
    lens_.surfaces.push_back(std::move(surface));
  }

  void complete_stop_and_aperture(std::vector<std::string>& usual) {
    Lens& lens = lens_;
    if (std::ranges::none_of(lens.surfaces, &Surface::stop)) {
      lens.surfaces.front().stop = true;
      usual.emplace_back("surface 0 as the stop");
    }
    if (aperture_) return;
    const Surface& stop = *std::ranges::find_if(lens.surfaces, &Surface::stop);
    if (!stop.semi_diameter_mm)
      throw InputError(
          file_,
          "does not say how wide the lens is open; a line \"# f-number: 4\" or \"# aperture: 12\" "
          "(entrance pupil in mm), or a semi-diameter of the stop would be right");
    lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, *stop.semi_diameter_mm};
    usual.emplace_back("open to the semi-diameter of the stop");
  }

  LensFile finished() {
    Lens& lens = lens_;
    if (lens.surfaces.empty()) throw InputError(file_, "has no surfaces; a row each would be right");
    std::vector<std::string> usual;
    complete_stop_and_aperture(usual);
    if (!wavelengths_) usual_wavelengths(usual);
    if (!fields_) {
      lens.fields = {Fields::Kind::angle_deg, {0, 5, 10}};
      usual.emplace_back("fields of 0, 5 and 10 degrees");
    }
    if (!gap_known_) focus(usual);
    if (const auto fault = find_fault(lens)) throw InputError(file_, fault->path + " " + fault->message);
    try {
      glasses_.require_all_used();
    } catch (const InputError& error) {
      throw InputError(file_, error.what());
    }
    if (!usual.empty())
      notes_.push_back(fmt::format("{}: taken as usual: {}", file_, fmt::join(usual, ", ")));
    LensFile made;
    made.lens = std::move(lens);
    made.notes = std::move(notes_);
    return made;
  }

  void usual_wavelengths(std::vector<std::string>& usual) {
    lens_.wavelengths_nm = default_wavelengths_nm;
    lens_.reference_wavelength_nm = default_reference_wavelength_nm;
    usual.emplace_back("the wavelengths F', d and C'");
  }

  void focus(std::vector<std::string>& usual) {
    Lens& lens = lens_;
    lens.surfaces.back().thickness_mm = 1;  // any
    if (const auto fault = find_fault(lens)) throw InputError(file_, fault->path + " " + fault->message);
    const double image_mm = first_order(lens).paraxial_image_mm;
    if (!(image_mm > 0 && std::isfinite(image_mm)))
      throw InputError(
          file_, "forms no real image; a thickness of the last surface, up to the sensor, would be right");
    lens.set_image_distance_mm(image_mm);
    usual.push_back(
        fmt::format("the sensor in the paraxial focus, {:.6g} mm behind the last surface", image_mm));
  }

  std::string file_;
  GlassLookup glasses_;
  Lens lens_;
  std::vector<std::string> notes_;
  std::vector<Column> columns_;
  int line_ = 0;
  bool aperture_ = false, fields_ = false, wavelengths_ = false, gap_known_ = true;
  std::optional<double> nd_, vd_;
};

}  // namespace

LensFile read_lens_table(const std::string& text, const std::string& file, const LensReadOptions& options) {
  return TableReader(file, options).read(text);
}

std::string lens_table_to_start_from() {
  return "# name: plano-convex lens, 50 mm\n"
         "# f-number: 8\n"
         "# fields: 0, 5, 10\n"
         "# wavelengths: 486.13, 587.56, 656.27\n"
         "radius, thickness, glass, semi-diameter\n"
         "stop, 2, , \n"
         "25.84, 5, SCHOTT:N-BK7, 10\n"
         "flat, , , 10\n";
}

}  // namespace petzval
