// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/wavelength.h>
#include <petzval/base/whole_file.h>
#include <petzval/colour/spectra_files.h>

#include <charconv>
#include <set>

namespace petzval {

namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t comma; (comma = line.find(',')) != std::string_view::npos; line.remove_prefix(comma + 1))
    fields.push_back(trimmed(line.substr(0, comma)));
  fields.push_back(trimmed(line));
  return fields;
}

/// Reads line by line; what is known so far are the members.
class SpectrumSetParser {
 public:
  explicit SpectrumSetParser(const std::string& file) : file_(file) {}

  void take(std::string_view raw_line) {
    ++line_;
    const std::string_view line = trimmed(raw_line);
    if (line.empty()) return;
    if (line.front() == '#')
      take_comment(trimmed(line.substr(1)));
    else if (names_.empty())
      take_names(line);
    else
      take_numbers(line);
  }

  SpectrumSet finish() {
    if (wavelengths_nm_.empty())
      throw InputError(file_, "holds no spectrum; see the files in data/spectra for the form");
    // Tables of metals may begin in the far ultraviolet; one that ends there is in µm.
    if (wavelengths_nm_.back() < shortest_wavelength_nm) fail(wavelength_fault(wavelengths_nm_.back()));
    for (std::size_t i = 0; i < names_.size(); ++i)
      set_.spectra.push_back({names_[i], Spectrum(wavelengths_nm_, std::move(values_[i]))});
    return std::move(set_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(file_, line_, message); }

  void take_comment(std::string_view comment) {
    const std::size_t colon = comment.find(':');
    if (colon == std::string_view::npos) return;
    const std::string_view key = comment.substr(0, colon), value = trimmed(comment.substr(colon + 1));
    if (key == "name") set_.name = value;
    if (key == "source") set_.source = value;
    if (key == "unit") set_.unit = value;
  }

  void take_names(std::string_view line) {
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.front() != "wavelength_nm" || fields.size() < 2)
      fail("the first line must name the columns: wavelength_nm, then one name a spectrum");
    names_.assign(fields.begin() + 1, fields.end());
    values_.resize(names_.size());
    std::set<std::string> seen;
    for (const std::string& name : names_)
      if (name.empty() || !seen.insert(name).second)
        fail("column names must be there and differ: '" + name + "'");
  }

  double number(std::string_view field) const {
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc{} || end != field.data() + field.size() || !(value - value == 0))
      fail(fmt::format("'{}' is not a number", field));
    return value;
  }

  void take_numbers(std::string_view line) {
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.size() != names_.size() + 1)
      fail(fmt::format("{} fields; the columns are {}", fields.size(), names_.size() + 1));
    const double wavelength = number(fields[0]);
    if (wavelength <= 0) fail(fmt::format("a wavelength of {} nm; it must be positive", wavelength));
    if (!wavelengths_nm_.empty() && wavelength <= wavelengths_nm_.back())
      fail(fmt::format("wavelengths must increase, but {} nm comes after {} nm", wavelength,
                       wavelengths_nm_.back()));
    wavelengths_nm_.push_back(wavelength);
    for (std::size_t i = 0; i < names_.size(); ++i) values_[i].push_back(number(fields[i + 1]));
  }

  std::string file_;
  int line_ = 0;
  SpectrumSet set_;
  std::vector<std::string> names_;
  std::vector<double> wavelengths_nm_;
  std::vector<std::vector<double>> values_;
};

}  // namespace

const Spectrum& SpectrumSet::find(const std::string& spectrum_name) const {
  std::vector<std::string> names;
  for (const NamedSpectrum& candidate : spectra) {
    if (candidate.name == spectrum_name) return candidate.spectrum;
    names.push_back(candidate.name);
  }
  std::string near;
  for (const std::string& candidate : nearest_names(spectrum_name, names))
    near += (near.empty() ? "" : ", ") + candidate;
  throw InputError(fmt::format("no spectrum '{}' in '{}'; the nearest are {}", spectrum_name, name, near));
}

SpectrumSet parse_spectrum_set(std::string_view text, const std::string& file) {
  SpectrumSetParser parser(file);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    parser.take(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parser.finish();
}

SpectrumSet read_spectrum_set(const std::string& path_or_name) {
  constexpr std::size_t max_bytes = std::size_t{1} << 28;  // a million lines of 24 columns
  const std::string path = find_data_file("spectra", ".csv", path_or_name, "spectrum set");
  return parse_spectrum_set(read_whole_file(path, max_bytes), path);
}

}  // namespace petzval
