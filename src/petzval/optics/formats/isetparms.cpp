// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/optics/formats/isetparms.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace petzval {

namespace {

/// More heights or wavelengths than any lens is traced at.
constexpr double longest_list = 100'000;
/// Beyond all lengths, f-numbers and angles of lenses.
constexpr double largest_number = 1e12;

/// The right-hand side of an assignment.
struct Assigned {
  std::string text;  ///< as it stands, without quotes
  bool quoted = false;
  int line = 0;
};

/// Name and value of every statement. MATLAB ends them at the end of the line, ';' or ','.
class Assignments {
 public:
  Assignments(std::string_view text, std::string file) : file_(std::move(file)) {
    for (const TextLine& line : text_lines(text)) take_line(line);
  }

  [[noreturn]] void fail(int line, const std::string& what) const { throw InputError(file_, line, what); }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(file_, what); }

  const Assigned* find(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? nullptr : &found->second;
  }

  std::string text(const std::string& name) const {
    const Assigned* value = find(name);
    return value ? value->text : "";
  }

  double number(const std::string& name, double if_absent) const {
    const Assigned* value = find(name);
    if (!value) return if_absent;
    if (value->quoted) fail(value->line, name + " is a text; a number would be right");
    const double number = number_in(*value, name, value->text);
    if (std::abs(number) > largest_number && name != "objDist")
      fail(value->line, fmt::format("{} is {}, which no lens has", name, number));
    return number;
  }

  /// [a b c], a:step:b or a single number.
  std::vector<double> list(const std::string& name) const {
    const Assigned* value = find(name);
    if (!value) return {};
    std::string text = value->text;
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '[' || c == ']' || c == ',' || c == ';'; }, ' ');
    std::vector<double> all;
    for (const std::string& word : split_words(without_blanks_about_colons(text))) {
      const std::vector<double> some = range_in(*value, name, word);
      all.insert(all.end(), some.begin(), some.end());
      if (double(all.size()) > longest_list)
        fail(value->line, fmt::format("{} has more than {:g} values", name, longest_list));
    }
    if (all.empty()) fail(value->line, name + " is an empty list");
    for (const double number : all)
      if (!(std::abs(number) <= largest_number))
        fail(value->line, fmt::format("{} has {} in it", name, number));
    return all;
  }

 private:
  void take_line(const TextLine& line) {
    std::string statement;
    bool quoted = false;
    int depth = 0;
    for (const char c : line.text) {
      if (c == '\'') quoted = !quoted;
      if (!quoted && c == '%') break;
      if (!quoted && c == '[') ++depth;
      if (!quoted && c == ']') --depth;
      if (!quoted && depth == 0 && (c == ';' || c == ',')) {
        take_statement(statement, line.number);
        statement.clear();
      } else {
        statement += c;
      }
    }
    if (quoted) fail(line.number, "a text does not end: a ' is missing");
    take_statement(statement, line.number);
  }

  void take_statement(const std::string& statement, int line) {
    const std::size_t equals = statement.find('=');
    if (trimmed(statement).empty()) return;
    if (equals == std::string::npos)
      fail(line, fmt::format("\"{}\" is no assignment; name=value would be right", quotable(statement)));
    std::string value = trimmed(std::string_view(statement).substr(equals + 1));
    const bool quoted = value.size() >= 2 && value.front() == '\'' && value.back() == '\'';
    if (quoted) value = value.substr(1, value.size() - 2);
    values_[trimmed(std::string_view(statement).substr(0, equals))] = {std::move(value), quoted, line};
  }

  double number_in(const Assigned& value, const std::string& name, const std::string& word) const {
    if (word == "Inf" || word == "inf" || word == "INF") return std::numeric_limits<double>::infinity();
    if (word == "NaN" || word == "nan") return RayTraceData::unknown;
    const std::optional<double> number = parse_number(word);
    if (!number) fail(value.line, fmt::format("{} is \"{}\", which is no number", name, quotable(word)));
    return *number;
  }

  static std::string without_blanks_about_colons(const std::string& text) {
    std::string result;
    for (const char c : text) {
      const bool blank = c == ' ' || c == '\t';
      if (blank && !result.empty() && result.back() == ':') continue;
      if (c == ':')
        while (!result.empty() && result.back() == ' ') result.pop_back();
      result += c;
    }
    return result;
  }

  std::vector<double> range_in(const Assigned& value, const std::string& name,
                               const std::string& word) const {
    std::vector<double> parts;
    std::size_t from = 0;
    for (std::size_t at = 0; at != std::string::npos; from = at + 1) {
      at = word.find(':', from);
      parts.push_back(number_in(value, name, word.substr(from, at == std::string::npos ? at : at - from)));
    }
    if (parts.size() == 1) return parts;
    if (parts.size() == 2) parts.insert(parts.begin() + 1, 1.0);
    const double count = parts.size() == 3
                             ? std::floor((parts[2] - parts[0]) / parts[1] * (1 + 1e-12) + 1e-9) + 1
                             : RayTraceData::unknown;
    if (!(count >= 1 && count <= longest_list))
      fail(value.line, fmt::format("{}={} is no range of 1 to {:g} values; from:step:to would be right", name,
                                   quotable(word), longest_list));
    std::vector<double> all;
    for (int i = 0; i < static_cast<int>(count); ++i) all.push_back(parts[0] + i * parts[1]);
    return all;
  }

  std::string file_;
  std::map<std::string, Assigned> values_;
};

/// The last part of a path of any system.
std::string last_part(const std::string& path) {
  const std::size_t slash = path.find_last_of("/\\");
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

std::vector<double> heights(const Assignments& all) {
  if (all.find("imgHeight")) return all.list("imgHeight");
  const double count = all.number("imgHeightNum", RayTraceData::unknown);
  const double most = all.number("imgHeightMax", RayTraceData::unknown);
  if (std::isnan(count) || std::isnan(most))
    all.fail(
        "has neither imgHeight nor imgHeightNum and imgHeightMax: the heights of the PSFs are not known");
  if (!(count >= 2 && count <= longest_list) || count != std::floor(count))
    all.fail(
        all.find("imgHeightNum")->line,
        fmt::format("imgHeightNum is {}; a whole number from 2 to {:g} would be right", count, longest_list));
  std::vector<double> even;
  for (int i = 0; i < static_cast<int>(count); ++i) even.push_back(i / (count - 1) * most);
  return even;
}

int psf_size(const Assignments& all) {
  constexpr double largest = 16384;
  const double size = all.number("psfSize", 0);
  if (!(size >= 0 && size <= largest) || size != std::floor(size))
    all.fail(all.find("psfSize")->line,
             fmt::format("psfSize is {}; a whole number up to {:g} would be right", size, largest));
  return static_cast<int>(size);
}

bool are_even_steps(const std::vector<double>& heights) {
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (double(i) / double(heights.size() - 1) * heights.back() != heights[i]) return false;
  return heights.size() >= 2;
}

std::string list_text(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{}", text.empty() ? "" : " ", value);
  return fmt::format("[{}]", text);
}

std::string quoted(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\'' || c == '\n' || c == '\r'; }, ' ');
  return fmt::format("'{}'", text);
}

std::string matlab_number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "Inf" : "-Inf";
  return fmt::format("{}", value);
}

}  // namespace

IsetParameters read_isetparms(std::string_view text, const std::string& file) {
  constexpr double unknown = RayTraceData::unknown;
  const Assignments all(text, file);
  IsetParameters parameters;
  RayTraceData& data = parameters.data;
  data.program = all.find("program") ? all.text("program") : "Zemax";
  data.lens_file = last_part(all.text("lensFile"));
  data.reference_wavelength_nm = all.number("refWave", unknown);
  data.object_distance_mm = all.number("objDist", unknown);
  data.magnification = all.number("mag", unknown);
  data.f_number = all.number("fnumber", unknown);
  data.effective_f_number = all.number("fnumber_eff", unknown);
  data.effective_focal_length_mm = all.number("efl", unknown);
  data.field_of_view_deg = 2 * all.number("fov", unknown);
  data.wavelengths_nm = all.list("wave");
  if (data.wavelengths_nm.empty()) all.fail("has no wave: the wavelengths are not known");
  data.field_height_mm = heights(all);
  parameters.base_name = last_part(all.text("baseLensFileName"));
  if (parameters.base_name.empty()) all.fail("has no baseLensFileName: the other files are named by it");
  parameters.psf_size = psf_size(all);
  parameters.psf_spacing_um = all.number("psfSpacing", 0) * um_per_mm;
  if (!(std::isfinite(parameters.psf_spacing_um) && parameters.psf_spacing_um >= 0))
    all.fail(all.find("psfSpacing")->line, "psfSpacing is no distance in mm");
  return parameters;
}

std::string isetparms_text(const RayTraceData& data, const std::string& base_name, int psf_size) {
  std::string text = "%   written by Petzval\n";
  const auto line = [&](const std::string& name, const std::string& value, const char* comment) {
    text += fmt::format("{}={};  % {}\n", name, value, comment);
  };
  line("lensFile", quoted(data.lens_file), "lens");
  line("psfSize", std::to_string(psf_size), "samples a side of a PSF");
  line("psfSpacing", matlab_number(data.psf.front().spacing_um * mm_per_um), "of the samples [mm]");
  line("wave", list_text(data.wavelengths_nm), "wavelengths [nm]");
  line("imgHeightNum", std::to_string(data.field_height_mm.size()), "number of image heights");
  line("imgHeightMax", matlab_number(data.field_height_mm.back()), "largest image height [mm]");
  if (!are_even_steps(data.field_height_mm))
    line("imgHeight", list_text(data.field_height_mm), "paraxial image heights [mm]");
  line("objDist", matlab_number(data.object_distance_mm), "object to the first vertex [mm]");
  line("mag", matlab_number(data.magnification), "magnification");
  line("baseLensFileName", quoted(base_name), "of the other files");
  line("refWave", matlab_number(data.reference_wavelength_nm), "reference wavelength [nm]");
  line("fov", matlab_number(data.field_of_view_deg / 2), "half field of view [degrees]");
  line("efl", matlab_number(data.effective_focal_length_mm), "focal length [mm]");
  line("fnumber_eff", matlab_number(data.effective_f_number), "f-number at the object distance");
  line("fnumber", matlab_number(data.f_number), "f-number at infinity");
  line("program", quoted(data.program), "that computed it");
  return text;
}

}  // namespace petzval
