// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/formats/zmx_records.h>
#include <petzval/lens/lens_fault.h>

#include <algorithm>

namespace petzval {

namespace {

ZmxRecord record_of(TextLine&& line) {
  const std::string text = trimmed(line.text);
  ZmxRecord record;
  record.line = line.number;
  record.keyword = line.words.front();
  record.rest = trimmed(std::string_view(text).substr(std::min(record.keyword.size(), text.size())));
  record.values.assign(std::make_move_iterator(line.words.begin() + 1),
                       std::make_move_iterator(line.words.end()));
  return record;
}

ZmxBlock surface_block(const ZmxRecord& record, const ZmxFile& file) {
  const auto number = record.has(0) ? parse_integer(record.values[0]) : std::nullopt;
  if (!number || *number != static_cast<int>(file.surfaces.size()))
    throw InputError(file.name, record.line,
                     fmt::format("SURF \"{}\": surfaces must be numbered 0, 1, 2 …; this should be SURF {}",
                                 quotable(record.rest), file.surfaces.size()));
  if (file.surfaces.size() > most_surfaces)
    throw InputError(file.name, record.line, fmt::format("has more than {} surfaces", most_surfaces));
  return {*number, record.line, {}};
}

}  // namespace

const ZmxRecord* ZmxBlock::find(const char* keyword) const {
  const auto found = std::find_if(records.rbegin(), records.rend(),
                                  [&](const ZmxRecord& record) { return record.keyword == keyword; });
  return found == records.rend() ? nullptr : &*found;
}

void ZmxFile::fail(const ZmxBlock& block, int line, const std::string& message) const {
  const std::string where = block.number < 0 ? "" : fmt::format("SURF {}: ", block.number);
  throw InputError(name, line, where + message);
}

double ZmxFile::number(const ZmxBlock& block, const ZmxRecord& record, std::size_t i) const {
  const auto value = record.has(i) ? parse_number(record.values[i]) : std::nullopt;
  if (!value)
    fail(block, record.line,
         fmt::format("value {} of {} must be a number, not \"{}\"", i + 1, record.keyword,
                     quotable(record.has(i) ? record.values[i] : "")));
  return *value;
}

double ZmxFile::number_or(const ZmxBlock& block, const ZmxRecord& record, std::size_t i,
                          double otherwise) const {
  return record.has(i) ? number(block, record, i) : otherwise;
}

ZmxFile zmx_records(const std::string& text, const std::string& file) {
  ZmxFile result;
  result.name = file;
  bool surface_is_indented = false, is_tail = false, has_operands = false;
  for (TextLine& line : text_lines(text)) {
    if (line.words.empty()) continue;
    if (is_tail) {
      if (line.words.front() == "MNUM") {
        result.header.records.push_back(record_of(std::move(line)));
        has_operands = true;
      } else if (line.words.front() == "TOL") {  // tolerances
        has_operands = false;
      } else if (has_operands) {
        result.operands.push_back(record_of(std::move(line)));
      }
      continue;
    }
    const bool indented = line.text.front() == ' ' || line.text.front() == '\t';
    ZmxRecord record = record_of(std::move(line));
    if (record.keyword == "SURF") {
      result.surfaces.push_back(surface_block(record, result));
      surface_is_indented = false;
      continue;
    }
    if (result.surfaces.empty()) {
      result.header.records.push_back(std::move(record));
      continue;
    }
    if (surface_is_indented && !indented) {
      is_tail = true;
      has_operands = record.keyword == "MNUM";
      if (has_operands) result.header.records.push_back(std::move(record));
      continue;
    }
    surface_is_indented = surface_is_indented || indented;
    result.surfaces.back().records.push_back(std::move(record));
  }
  constexpr std::size_t fewest_surfaces = 3;
  if (result.surfaces.size() < fewest_surfaces)
    throw InputError(
        file,
        fmt::format("has {} surfaces (SURF); a .zmx lens has at least an object, one surface and an image",
                    result.surfaces.size()));
  return result;
}

}  // namespace petzval
