// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/optics/formats/number_columns.h>

#include <algorithm>

namespace petzval {

namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t from = 0;
  while (true) {
    const std::size_t at = std::min(line.find_first_of(",;\t", from), line.size());
    cells.push_back(trimmed(std::string_view(line).substr(from, at - from)));
    if (at == line.size()) return cells;
    from = at + 1;
  }
}

}  // namespace

NumberColumns::NumberColumns(std::string_view text, std::string file) : file_(std::move(file)) {
  constexpr std::size_t most_columns = 64;
  for (const TextLine& line : text_lines(decoded_text(text))) {
    const std::string content = trimmed(line.text);
    if (content.empty()) continue;
    if (content.front() == '#') {
      const std::size_t colon = content.find(':');
      if (colon != std::string::npos)
        keys_[trimmed(std::string_view(content).substr(1, colon - 1))] =
            trimmed(std::string_view(content).substr(colon + 1));
      continue;
    }
    const std::vector<std::string> cells = cells_of(content);
    if (names_.empty()) {
      if (cells.size() > most_columns)
        throw InputError(file_, line.number, fmt::format("names more than {} columns", most_columns));
      names_ = cells;
      columns_.resize(names_.size());
      continue;
    }
    if (cells.size() != names_.size())
      throw InputError(
          file_, line.number,
          fmt::format("has {} values; the columns are {}", cells.size(), fmt::join(names_, ", ")));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::optional<double> value = parse_number(cells[i]);
      if (!value)
        throw InputError(
            file_, line.number,
            fmt::format("{} is \"{}\", which is no finite number", quotable(names_[i]), quotable(cells[i])));
      columns_[i].push_back(*value);
    }
    lines_.push_back(line.number);
  }
  if (names_.empty()) fail("has no line of column names");
  if (lines_.empty()) fail("has no numbers below the column names");
}

bool NumberColumns::has(const std::string& column) const {
  return std::find(names_.begin(), names_.end(), column) != names_.end();
}

const std::vector<double>& NumberColumns::column(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end())
    fail(fmt::format("has no column {}; it has {}", name,
                     quotable(fmt::format("{}", fmt::join(names_, ", ")))));
  return columns_[static_cast<std::size_t>(found - names_.begin())];
}

std::string NumberColumns::text(const std::string& key) const {
  const auto found = keys_.find(key);
  return found == keys_.end() ? "" : found->second;
}

std::optional<double> NumberColumns::number(const std::string& key) const {
  const std::string value = text(key);
  if (value.empty()) return {};
  const std::optional<double> number = parse_number(value);
  if (!number) fail(fmt::format("says \"# {}: {}\", which is no number", key, quotable(value)));
  return number;
}

void NumberColumns::fail(const std::string& what) const {
  throw InputError(file_, what);
}

void NumberColumns::fail(std::size_t row, const std::string& what) const {
  throw InputError(file_, lines_[row], what);
}

}  // namespace petzval
