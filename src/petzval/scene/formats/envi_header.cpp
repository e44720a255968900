// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/wavelength.h>
#include <petzval/scene/formats/envi_header.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

namespace petzval {

namespace {

struct Entry {
  std::string value;
  int line = 0;
};
using Entries = std::map<std::string, Entry>;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Lower case, one blank between words: "Wavelength  Units" is "wavelength units".
std::string plain_key(std::string_view text) {
  std::string key;
  for (const char c : trimmed(text)) {
    const bool blank = c == ' ' || c == '\t' || c == '_';
    if (blank && key.ends_with(' ')) continue;
    key += blank ? ' ' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return key;
}

/// Takes the text apart, line by line.
Entries entries_of(std::string_view text, const std::string& file) {
  Entries entries;
  int line_number = 0;
  const auto next_line = [&] {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++line_number;
    std::string plain(line);  // control characters would get into messages
    std::replace_if(
        plain.begin(), plain.end(), [](char c) { return c >= 0 && c < ' '; }, ' ');
    return plain;
  };
  if (!trimmed(next_line()).starts_with("ENVI"))
    throw InputError(file, "is no ENVI header: it does not begin with ENVI");
  while (!text.empty()) {
    const std::string whole_line = next_line();
    const std::string_view line = trimmed(whole_line);
    if (line.empty() || line.front() == ';') continue;
    const std::size_t equals = line.find('=');
    if (equals == line.npos)
      throw InputError(file, line_number, "has no '='; \"key = value\" would be right");
    Entry entry{std::string(trimmed(line.substr(equals + 1))), line_number};
    if (entry.value.starts_with('{')) {
      while (entry.value.find('}') == std::string::npos) {
        if (text.empty()) throw InputError(file, entry.line, "opens a brace that is never closed");
        entry.value += ' ';
        entry.value += trimmed(next_line());
      }
      entry.value = trimmed(std::string_view(entry.value).substr(1, entry.value.find('}') - 1));
    }
    const std::string key = plain_key(line.substr(0, equals));
    if (const auto before = entries.find(key); before != entries.end())
      throw InputError(file, line_number,
                       fmt::format("has '{}' again, after line {}; once would be right", quotable(key),
                                   before->second.line));
    entries[key] = std::move(entry);
  }
  return entries;
}

/// Looks entries up and complains with their lines.
class EntryReader {
 public:
  EntryReader(const Entries& entries, const std::string& file) : entries_(entries), file_(file) {}

  const Entry* find(const std::string& key) const {
    const auto found = entries_.find(key);
    return found == entries_.end() || found->second.value.empty() ? nullptr : &found->second;
  }

  std::string text(const std::string& key) const {
    const Entry* const entry = find(key);
    return entry ? entry->value : std::string();
  }

  std::optional<std::int64_t> whole(const std::string& key, std::int64_t least, std::int64_t most) const {
    const Entry* const entry = find(key);
    if (!entry) return std::nullopt;
    std::int64_t value = 0;
    const char* const end = entry->value.data() + entry->value.size();
    const auto [rest, error] = std::from_chars(entry->value.data(), end, value);
    if (error != std::errc{} || rest != end || value < least || value > most)
      fail(*entry, fmt::format("{} = {}; a whole number from {} to {} would be right", key,
                               quotable(entry->value), least, most));
    return value;
  }

  std::int64_t required(const std::string& key, std::int64_t least, std::int64_t most) const {
    if (const std::optional<std::int64_t> value = whole(key, least, most)) return *value;
    throw InputError(file_, fmt::format("has no '{}'", key));
  }

  /// \param finite  whether NaN and infinities are refused.
  std::vector<double> numbers(const std::string& key, bool finite = true) const {
    std::vector<double> values;
    const Entry* const entry = find(key);
    std::string_view rest = entry ? std::string_view(entry->value) : std::string_view();
    while (!rest.empty()) {
      const std::size_t comma = std::min(rest.find(','), rest.size());
      const std::string_view word = trimmed(rest.substr(0, comma));
      rest.remove_prefix(std::min(comma + 1, rest.size()));
      if (word.empty() && rest.empty()) break;  // a comma after the last
      double value = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc{} || end != word.data() + word.size() || (finite && !std::isfinite(value)))
        fail(*entry, fmt::format("{}: '{}' is no number", key, quotable(word)));
      values.push_back(value);
    }
    return values;
  }

  /// One number a band, or none.
  std::vector<double> per_band(const std::string& key, int bands) const {
    std::vector<double> values = numbers(key);
    if (!values.empty() && values.size() != static_cast<std::size_t>(bands))
      fail(*find(key), fmt::format("{} has {} numbers for {} bands", key, values.size(), bands));
    return values;
  }

  std::optional<double> number(const std::string& key, bool finite = true) const {
    const std::vector<double> values = numbers(key, finite);
    if (values.empty()) return std::nullopt;
    if (values.size() != 1) fail(*find(key), fmt::format("{} must be one number", key));
    return values[0];
  }

  [[noreturn]] void fail(const Entry& entry, const std::string& message) const {
    throw InputError(file_, entry.line, message);
  }

 private:
  const Entries& entries_;
  const std::string& file_;
};

std::size_t bytes_of_type(int data_type) {
  switch (data_type) {
    case 1:
      return 1;
    case 2:
    case 12:
      return 2;
    case 3:
    case 4:
    case 13:
      return 4;
    case 5:
    case 14:
    case 15:
      return 8;
    default:
      return 0;
  }
}

void take_layout(const EntryReader& entries, const std::string& file, EnviHeader& header) {
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  header.columns = static_cast<int>(entries.required("samples", 1, most));
  header.rows = static_cast<int>(entries.required("lines", 1, most));
  header.bands = static_cast<int>(entries.required("bands", 1, most));
  header.data_type = static_cast<int>(entries.required("data type", 1, 15));
  if (header.value_bytes() == 0)
    throw InputError(file,
                     fmt::format("has data type {}; 1, 2, 3, 4, 5, 12, 13, 14 and 15 (real numbers) can be "
                                 "read",
                                 header.data_type));
  const std::string interleave = plain_key(entries.text("interleave"));
  if (interleave.empty() && header.bands > 1)
    throw InputError(file, "has no interleave; bsq, bil or bip would be right");
  if (interleave != "bsq" && interleave != "bil" && interleave != "bip" && !interleave.empty())
    throw InputError(
        file, fmt::format("has interleave '{}'; bsq, bil or bip would be right", quotable(interleave)));
  header.interleave = interleave == "bil"   ? EnviInterleave::bil
                      : interleave == "bip" ? EnviInterleave::bip
                                            : EnviInterleave::bsq;
  header.big_endian = entries.whole("byte order", 0, 1).value_or(0) == 1;
  header.offset =
      static_cast<std::uint64_t>(entries.whole("header offset", 0, std::int64_t{1} << 40).value_or(0));
  if (entries.whole("file compression", 0, 1).value_or(0) != 0)
    throw InputError(file, "says that the data are compressed; uncompressed ones can be read");
  for (const char* key : {"major frame offsets", "minor frame offsets"})
    for (const double frame : entries.numbers(key))
      if (frame != 0) throw InputError(file, fmt::format("has {}; data without frames can be read", key));
}

/// Nanometres in a unit of wavelengths.
double nanometres_in(const EntryReader& entries, const Entry& entry, const std::string& unit) {
  static const std::map<std::string, double> units = {{"nanometers", 1},
                                                      {"nanometres", 1},
                                                      {"nanometer", 1},
                                                      {"nanometre", 1},
                                                      {"nm", 1},
                                                      {"micrometers", 1e3},
                                                      {"micrometres", 1e3},
                                                      {"micrometer", 1e3},
                                                      {"micrometre", 1e3},
                                                      {"microns", 1e3},
                                                      {"micron", 1e3},
                                                      {"um", 1e3},
                                                      {"µm", 1e3},
                                                      {"μm", 1e3},
                                                      {"millimeters", 1e6},
                                                      {"mm", 1e6},
                                                      {"centimeters", 1e7},
                                                      {"cm", 1e7},
                                                      {"meters", 1e9},
                                                      {"m", 1e9},
                                                      {"angstroms", 0.1}};
  const auto found = units.find(unit);
  if (found == units.end())
    entries.fail(entry, fmt::format("wavelength units = {}; nanometers or micrometers would be right",
                                    quotable(unit)));
  return found->second;
}

void take_wavelengths(const EntryReader& entries, EnviHeader& header) {
  std::vector<double>& wavelengths = header.wavelengths_nm;
  wavelengths = entries.per_band("wavelength", header.bands);
  if (wavelengths.empty()) return;
  const Entry* const entry = entries.find("wavelength units");
  const std::string unit = entry ? plain_key(entry->value) : "unknown";
  const double longest = *std::max_element(wavelengths.begin(), wavelengths.end());
  header.wavelengths_seem_um = unit == "unknown" && longest < shortest_wavelength_nm;
  const double unit_nm = header.wavelengths_seem_um ? 1e3
                         : unit == "unknown"        ? 1
                                                    : nanometres_in(entries, *entry, unit);
  for (double& wavelength : wavelengths) wavelength *= unit_nm;
}

void take_values(const EntryReader& entries, EnviHeader& header) {
  take_wavelengths(entries, header);
  header.gains = entries.per_band("data gain values", header.bands);
  header.offsets = entries.per_band("data offset values", header.bands);
  header.reflectance_gains = entries.per_band("data reflectance gain values", header.bands);
  header.reflectance_offsets = entries.per_band("data reflectance offset values", header.bands);
  header.reflectance_scale = entries.number("reflectance scale factor");
  if (header.reflectance_scale && !(*header.reflectance_scale > 0))
    entries.fail(*entries.find("reflectance scale factor"), "a reflectance scale factor must be positive");
  header.ignored = entries.number("data ignore value", false);
  constexpr int single_precision = 4;  // the header may have the number with other digits
  if (header.ignored && header.data_type == single_precision)
    header.ignored = double{static_cast<float>(*header.ignored)};
  for (const double good : entries.per_band("bbl", header.bands)) header.good.push_back(good != 0);
  header.units = entries.text("data units");
  header.name = entries.text("description");
}

}  // namespace

std::size_t EnviHeader::value_bytes() const {
  return bytes_of_type(data_type);
}

std::uint64_t EnviHeader::data_bytes() const {
  // Three sides below 2^31 and eight bytes: held against the largest scene in two steps, so that nothing
  // wraps.
  const std::uint64_t plane = static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows);
  const std::uint64_t pixel = static_cast<std::uint64_t>(bands) * value_bytes();
  return plane > std::numeric_limits<std::uint64_t>::max() / pixel ? std::numeric_limits<std::uint64_t>::max()
                                                                   : plane * pixel;
}

EnviHeader parse_envi_header(std::string_view text, const std::string& file) {
  const Entries lines = entries_of(text, file);
  const EntryReader entries(lines, file);
  EnviHeader header;
  take_layout(entries, file, header);
  take_values(entries, header);
  return header;
}

}  // namespace petzval
